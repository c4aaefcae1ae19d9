//! Fuzzing of all readers of files, for seconds or hours.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::thread;

use clap::Args;

use crate::Result;

/// The options of fuzzing.
#[derive(Args)]
pub(crate) struct Options {
    /// Fuzz these targets only
    targets: Vec<String>,
    /// Duration for each target in seconds
    #[arg(long, default_value_t = 5)]
    seconds: u32,
    /// List the targets, and fuzz none
    #[arg(long)]
    list: bool,
}

/// The compiler options of `cargo fuzz build --sanitizer none`: coverage that guides libFuzzer.
/// Without `unsafe` code a sanitizer has nothing to find.
const COVERAGE: &str = "--cfg fuzzing -Cpasses=sancov-module \
    -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
    -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares \
    -Cllvm-args=-simplifycfg-branch-fold-threshold=0";

/// The limits of every target for one input: seconds, megabytes of one allocation and of all.
const BOUNDS: [&str; 3] = ["-timeout=5", "-malloc_limit_mb=512", "-rss_limit_mb=2048"];

/// Builds the targets and runs them, one on each core; a finding ends its core.
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
    let chosen = Mutex::new(all.iter().filter(chosen));
    let next = || chosen.lock().ok()?.next();
    // One target uses one core.
    let worker = || -> std::result::Result<(), String> {
        while let Some(target) = next() {
            fuzz(root, &binaries, target, options.seconds).map_err(|error| error.to_string())?;
        }
        Ok(())
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(worker)).collect();
        for worker in workers {
            worker.join().map_err(|_| "a fuzzing thread panicked")??;
        }
        Ok(())
    })
}

/// The targets, one per file.
fn targets(root: &Path) -> Result<Vec<String>> {
    let mut targets = Vec::new();
    for entry in fs::read_dir(root.join("fuzz/fuzz_targets"))? {
        let path = entry?.path();
        targets.extend(path.file_stem().map(|name| name.to_string_lossy().into_owned()));
    }
    targets.sort();
    Ok(targets)
}

/// Builds all targets; returns their folder.
fn build(root: &Path) -> Result<PathBuf> {
    let host = host()?;
    let folder = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let folder = folder.join("fuzz");
    let status = Command::new("cargo")
        // If a target is named, build scripts and macros are not instrumented.
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

/// Runs one target from its corpus in the repository, if there is one; new inputs are written to one under `target`.
fn fuzz(root: &Path, binaries: &Path, target: &str, seconds: u32) -> Result<()> {
    let found = binaries.join("corpus").join(target);
    let artifacts = root.join("fuzz/artifacts").join(target);
    fs::create_dir_all(&found)?;
    fs::create_dir_all(&artifacts)?;
    // A target that generates its own input structure has no corpus.
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
