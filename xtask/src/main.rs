//! The workspace's own commands: `cargo xtask`.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command line program prints")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod bench;
mod blind;
mod certificates;
mod ci;
mod coverage;
mod dist;
mod doc;
mod false_alarms;
mod fuzz;
mod histories;
mod injections;
mod manifest;
mod reproduce;
mod tidy;
mod verify;

/// The result of a command.
type Result<T, E = Box<dyn Error>> = std::result::Result<T, E>;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "The workspace's own commands")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Time the hot loops and alternative implementations, or count their instructions
    Bench(bench::Options),
    /// Hide effects in independently simulated runs, and score the diagnosis
    Blind(blind::Options),
    /// Simulate laboratories with wrong references, and check the coverage of the expanded uncertainty
    Certificates(certificates::Options),
    /// Run everything that CI runs after `cargo test --workspace`
    Ci(ci::Options),
    /// Simulate runs with random truth and check the coverage of the estimator's intervals
    Coverage(coverage::Options),
    /// Build the files of a release into target/dist, and try them in empty environments
    Dist(dist::Options),
    /// Build the book into target/book and check its equations and links
    Doc,
    /// Diagnose simulated runs without an unmodeled error, and count the false alarms
    FalseAlarms(false_alarms::Options),
    /// Fuzz all readers of files, each target for some seconds
    Fuzz(fuzz::Options),
    /// Simulate campaigns of runs, and score what is named and predicted between the runs
    Histories(histories::Options),
    /// Add known errors to measured logs, and score the diagnosis
    Injections(injections::Options),
    /// Run the paper's experiments and write the book's page about them
    Reproduce(reproduce::Options),
    /// Check the rules of CONTRIBUTING.md that rustc and clippy cannot
    Tidy,
    /// Check the paper's closed forms against numerical integration
    Verify,
}

fn main() -> ExitCode {
    let root = root();
    let done = match Arguments::parse().command {
        Command::Bench(options) => bench::run(&root, &options),
        Command::Blind(options) => blind::run(&root, &options),
        Command::Certificates(options) => certificates::run(&root, &options),
        Command::Ci(options) => ci::run(&root, &options),
        Command::Coverage(options) => coverage::run(&root, &options),
        Command::Dist(options) => dist::run(&root, &options),
        Command::Doc => doc::run(&root),
        Command::FalseAlarms(options) => false_alarms::run(&root, &options),
        Command::Fuzz(options) => fuzz::run(&root, &options),
        Command::Histories(options) => histories::run(&root, &options),
        Command::Injections(options) => injections::run(&root, &options),
        Command::Reproduce(options) => reproduce::run(&root, &options),
        Command::Tidy => tidy::run(&root),
        Command::Verify => verify::run(&root),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The root of the workspace, for any working folder.
fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.parent().expect("xtask/ lies in the workspace").to_path_buf()
}

/// The target folder of cargo.
fn target(root: &Path) -> Result<PathBuf> {
    let output = std::process::Command::new("cargo")
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root)
        .output()?;
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout)?;
    let folder = metadata["target_directory"].as_str().ok_or("cargo metadata names no target")?;
    Ok(folder.into())
}
