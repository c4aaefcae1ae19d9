//! Benchmarks of the hot loops against alternative implementations, and their instruction counts.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use clap::Args;
use serde_json::{Value, json};

use crate::Result;

mod instructions;
mod timing;

use timing::{Timings, per};

/// The options of the benchmark.
#[derive(Args)]
pub(crate) struct Options {
    /// Count instructions with valgrind and compare them with the stored counts, without timing
    #[arg(long)]
    instructions: bool,
    /// Store the instruction counts as the new reference
    #[arg(long, requires = "instructions")]
    keep: bool,
}

/// A package with its bench.
type Bench = (&'static str, &'static str);

/// The benches that are timed, each with its alternative implementation.
const BENCHES: &[Bench] = &[
    ("rins-calibration", "step"),
    ("rins-motion", "strapdown"),
    ("rins-estimation", "online"),
    ("rins-campaign", "campaign"),
];

/// A row of the table: its name, the timed bench, and the alternative.
type Row = (&'static str, &'static str, Option<&'static str>);

/// The rows, by the names of the benches in criterion's folder.
const ROWS: &[Row] = &[
    ("filter_step_12", "filter_step_12/one", Some("filter_step_12/dense")),
    ("filter_step_12_lanes", "filter_step_12/lanes", Some("filter_step_12/dense")),
    ("filter_step_12_avx2", "filter_step_12/avx2", Some("filter_step_12/dense")),
    ("filter_step_24", "filter_step_24/one", Some("filter_step_24/dense")),
    ("filter_step_24_lanes", "filter_step_24/lanes", Some("filter_step_24/dense")),
    ("filter_step_40", "filter_step_40/one", Some("filter_step_40/dense")),
    ("filter_step_48", "filter_step_48/one", Some("filter_step_48/dense")),
    ("filter_step_48_lanes", "filter_step_48/lanes", Some("filter_step_48/dense")),
    ("strapdown_step", "strapdown_step/one", Some("strapdown_step/bare")),
    ("strapdown_step_lanes", "strapdown_step/lanes", Some("strapdown_step/bare")),
    ("online_sample", "online_sample/full", None),
    (CAMPAIGN, "campaign_30/lanes", Some("campaign_30/dense")),
];

/// The row whose times are in seconds.
const CAMPAIGN: &str = "campaign_30";

/// Times the benches and writes `target/bench.json`, or counts instructions.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    if options.instructions {
        return instructions::run(root, options.keep);
    }
    let target = crate::target(root)?;
    for &(package, bench) in BENCHES {
        let status = Command::new("cargo")
            .args(["bench", "--quiet", "--package", package, "--bench", bench])
            .args(["--", "--warm-up-time", "1", "--measurement-time", "3"])
            .current_dir(root)
            .status()?;
        if !status.success() {
            return Err(format!("the bench {bench} of {package} failed ({status})").into());
        }
    }
    let timings = Timings::read(&target.join("criterion"))?;
    let mut all = BTreeMap::new();
    println!("{:24} {:>12} {:>12} {:>8}", "medians, one core", "ns", "rival ns", "ratio");
    for (name, one, rival) in ROWS {
        let own = timings.of(one)?;
        let rival = rival.map(|rival| timings.of(rival)).transpose()?;
        let ratio = rival.map(|rival| rival / own);
        println!("{name:24} {own:>12.1} {:>12} {:>8}", per(rival, 1), per(ratio, 2));
        all.insert(*name, entry(name, own, rival));
    }
    let path = target.join("bench.json");
    fs::write(&path, serde_json::to_string_pretty(&json!(all))?)?;
    println!("Written: {}", path.display());
    Ok(())
}

/// A row for `bench.json`, from times in nanoseconds.
fn entry(name: &str, own: f64, dense: Option<f64>) -> Value {
    let (unit, scale) = if name == CAMPAIGN { ("s", 1e-9) } else { ("ns", 1.0) };
    let mut entry = json!({ unit: own * scale });
    if let Some(dense) = dense {
        entry[format!("dense_{unit}")] = json!(dense * scale);
        entry["ratio"] = json!(dense / own);
    }
    entry
}
