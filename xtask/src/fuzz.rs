//! Fuzzing of everything that reads a file, for some seconds or for hours.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::Result;

/// What to fuzz, and for how long.
#[derive(Args)]
pub(crate) struct Options {
    /// Fuzz these targets only
    targets: Vec<String>,
    /// How many seconds each target is fuzzed
    #[arg(long, default_value_t = 5)]
    seconds: u32,
    /// Name the targets, and fuzz none
    #[arg(long)]
    list: bool,
}

/// What `cargo fuzz build --sanitizer none` asks of the compiler: coverage that libFuzzer is led by.
/// Without `unsafe` code there is nothing for a sanitizer to find.
const COVERAGE: &str = "--cfg fuzzing -Cpasses=sancov-module \
    -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
    -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares \
    -Cllvm-args=-simplifycfg-branch-fold-threshold=0";

/// What no target may exceed for one input: seconds, megabytes of one allocation and of all.
const BOUNDS: [&str; 3] = ["-timeout=5", "-malloc_limit_mb=512", "-rss_limit_mb=2048"];

/// Builds the targets and runs them one after another, up to the first that finds something.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let all = targets(root)?;
    if options.list {
        println!("{}", all.join("\n"));
        return Ok(());
    }
    if let Some(unknown) = options.targets.iter().find(|target| !all.contains(target)) {
        return Err(format!("no target is called {unknown}: see cargo xtask fuzz --list").into());
    }
    let binaries = build(root)?;
    let chosen = |target: &&String| options.targets.is_empty() || options.targets.contains(target);
    for target in all.iter().filter(chosen) {
        fuzz(root, &binaries, target, options.seconds)?;
    }
    Ok(())
}

/// The targets, one a file.
fn targets(root: &Path) -> Result<Vec<String>> {
    let mut targets = Vec::new();
    for entry in fs::read_dir(root.join("fuzz/fuzz_targets"))? {
        let path = entry?.path();
        targets.extend(path.file_stem().map(|name| name.to_string_lossy().into_owned()));
    }
    targets.sort();
    Ok(targets)
}

/// Builds all targets; the folder where they lie.
fn build(root: &Path) -> Result<PathBuf> {
    let host = host()?;
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let folder = folder.join("fuzz");
    let status = Command::new("cargo")
        // With a target named, build scripts and macros are not instrumented.
        .args(["build", "--quiet", "--release", "--bins", "--target", &host])
        .arg("--target-dir")
        .arg(&folder)
        .env("RUSTFLAGS", COVERAGE)
        .current_dir(root.join("fuzz"))
        .status()?;
    if !status.success() {
        return Err(
            format!("the fuzz targets do not build ({status}); a C++ compiler is needed").into()
        );
    }
    Ok(folder.join(host).join("release"))
}

fn host() -> Result<String> {
    let output = Command::new("rustc").arg("-vV").output()?;
    let text = String::from_utf8(output.stdout)?;
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    Ok(host.ok_or("rustc does not say what its host is")?.to_owned())
}

/// Runs one target from the corpus that the repository may keep for it; new inputs go to one below `target`.
fn fuzz(root: &Path, binaries: &Path, target: &str, seconds: u32) -> Result<()> {
    let found = binaries.join("corpus").join(target);
    let artifacts = root.join("fuzz/artifacts").join(target);
    fs::create_dir_all(&found)?;
    fs::create_dir_all(&artifacts)?;
    // A target that makes its own structure begins with nothing.
    let kept = Some(root.join("fuzz/corpus").join(target)).filter(|folder| folder.is_dir());
    let output = Command::new(binaries.join(target))
        .arg(&found)
        .args(kept)
        .args(BOUNDS)
        .arg(format!("-max_total_time={seconds}"))
        .arg(format!("-artifact_prefix={}/", artifacts.display()))
        .args(["-print_final_stats=1", "-verbosity=0"])
        .output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        let folder = artifacts.display();
        return Err(format!("{said}\n{target} has found something: see {folder}").into());
    }
    let executed =
        said.lines().find_map(|line| line.strip_prefix("stat::number_of_executed_units:"));
    println!("{target:14} {:>12} executions", executed.unwrap_or("?").trim());
    Ok(())
}
