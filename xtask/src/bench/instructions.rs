//! Instruction counts of the hot loops, which are reproducible: the check for performance regressions.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::Result;

/// The maximum relative increase of a count over the stored one.
const TOLERANCE: f64 = 0.02;

/// The file of the stored counts.
const KEPT: &str = "xtask/instructions.toml";

/// A function whose instructions are counted.
struct Counted {
    package: &'static str,
    bench: &'static str,
    /// The name of the function, and that of its benchmark.
    name: &'static str,
    filter: &'static str,
    /// The number of steps per call. The function is called twice: for its result, and by criterion.
    steps: f64,
}

const fn counted(
    [package, bench]: [&'static str; 2],
    [name, filter]: [&'static str; 2],
    steps: f64,
) -> Counted {
    Counted { package, bench, name, filter, steps }
}

const ALL: &[Counted] = &[
    counted(["rins-calibration", "step"], ["filter_step_12", "filter_step_12/one"], 200.0),
    counted(["rins-calibration", "step"], ["filter_lanes_12", "filter_step_12/lanes"], 200.0),
    counted(["rins-calibration", "step"], ["filter_step_24", "filter_step_24/one"], 200.0),
    counted(["rins-calibration", "step"], ["filter_step_40", "filter_step_40/one"], 200.0),
    counted(["rins-calibration", "step"], ["filter_step_48", "filter_step_48/one"], 200.0),
    counted(["rins-estimation", "online"], ["online_sample", "online_sample/full"], 1000.0),
    counted(["rins-motion", "strapdown"], ["strapdown_step", "strapdown_step/one"], 1000.0),
    counted(["rins-motion", "strapdown"], ["strapdown_lanes", "strapdown_step/lanes"], 1000.0),
];

/// Counts instructions, and stores the counts or compares them with the stored ones.
pub(super) fn run(root: &Path, keep: bool) -> Result<()> {
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("valgrind is not installed: nothing is counted");
        return Ok(());
    }
    let compiler = compiler()?;
    let mut counts = BTreeMap::new();
    for counted in ALL {
        counts.insert(counted.name, (counted.count(root, &compiler.host)? / counted.steps).round());
    }
    let times = counts["filter_step_48"] / counts["filter_step_12"];
    let power = f64::ln(times) / f64::ln(48.0 / 12.0);
    println!("A filter's step grows with the number of its states to the power {power:.2}");
    if power > 2.0 {
        return Err("a filter's step grows faster than the square of its states".into());
    }
    let path = root.join(KEPT);
    if keep {
        let mut text = String::from("# Instructions a step, by callgrind.\n");
        writeln!(text, "rustc = \"{}\"", compiler.release)?;
        for (name, count) in &counts {
            writeln!(text, "{name} = {count}")?;
        }
        fs::write(&path, text)?;
        return Ok(());
    }
    let kept: toml::Table = fs::read_to_string(&path)?.parse()?;
    println!("{:24} {:>12} {:>12}", "instructions a step", "now", "kept");
    let mut slower = Vec::new();
    for (name, &count) in &counts {
        let before = kept.get(*name).and_then(toml::Value::as_integer);
        let shown = before.map_or_else(|| "-".into(), |count| count.to_string());
        println!("{name:24} {count:>12.0} {shown:>12}");
        if before.is_none_or(|before| count > before as f64 * (1.0 + TOLERANCE)) {
            slower.push(*name);
        }
    }
    let release = kept.get("rustc").and_then(toml::Value::as_str);
    if release != Some(compiler.release.as_str()) {
        println!("kept by another compiler ({}): not compared", release.unwrap_or("none"));
        return Ok(());
    }
    if slower.is_empty() {
        return Ok(());
    }
    let names = slower.join(", ");
    Err(format!("{names}: more instructions than kept; if that is right, add --keep").into())
}

struct Compiler {
    release: String,
    host: String,
}

fn compiler() -> Result<Compiler> {
    let output = Command::new("rustc").arg("-vV").output()?;
    let text = String::from_utf8(output.stdout)?;
    let field = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(name));
        line.map(str::to_owned).ok_or_else(|| format!("rustc -vV has no `{name}`"))
    };
    Ok(Compiler { release: field("release: ")?, host: field("host: ")? })
}

impl Counted {
    /// The number of instructions of one call.
    fn count(&self, root: &Path, host: &str) -> Result<f64> {
        let folder = crate::target(root)?;
        fs::create_dir_all(&folder)?;
        let out = folder.join("callgrind.out");
        let runner = format!(
            "valgrind --tool=callgrind --callgrind-out-file={} --toggle-collect=*counted*{}*",
            out.display(),
            self.name
        );
        let variable = format!("CARGO_TARGET_{}_RUNNER", host.to_uppercase().replace('-', "_"));
        let output = Command::new("cargo")
            .args(["bench", "--quiet", "--package", self.package, "--bench", self.bench])
            .args(["--", "--test", self.filter])
            .env(variable, runner)
            .current_dir(root)
            .output()?;
        let text = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            return Err(format!("{}: {text}", self.name).into());
        }
        let collected = collected(&text).ok_or_else(|| format!("{}: no count", self.name))?;
        Ok(collected / 2.0)
    }
}

/// The total that callgrind reports; it is zero for a child process of the bench.
fn collected(text: &str) -> Option<f64> {
    let counts = text.lines().filter_map(|line| line.split_once("Collected : "));
    let counts = counts.filter_map(|(_, count)| count.trim().parse::<f64>().ok());
    counts.reduce(f64::max).filter(|&count| count > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn callgrinds_count_is_read() {
        let text = "==8== Collected : 0\n==7== Collected : 2296824\n==7== I   refs: 2,296,824\n";
        assert_eq!(collected(text).map(f64::to_bits), Some(2296824_f64.to_bits()));
        assert_eq!(collected("==8== Collected : 0\n==7== Command: step"), None);
    }
}
