//! Scenario files as plans, and plans as scenario files.

use std::path::{Path, PathBuf};

use anyhow::Context;
use rins_design::{Limits, Planned, Proposal};
use rins_frames::units::DEG;
use rins_io::{ScenarioFile, shown};
use rins_motion::{Profile, Segment};
use rins_simulation::{Scenario, simulate};
use toml::{Table, Value};

use crate::log::table_accuracy;

/// One or several scenarios that are looked at together: runs of one IMU.
#[derive(Debug)]
pub(super) struct Schedule {
    /// What it is called: the file names.
    pub(super) name: String,
    pub(super) paths: Vec<PathBuf>,
    pub(super) runs: Vec<Planned>,
}

impl Schedule {
    /// Of several runs of one IMU.
    pub(super) fn of(paths: &[PathBuf]) -> anyhow::Result<Self> {
        let runs = paths.iter().map(|path| planned(path)).collect::<anyhow::Result<Vec<_>>>()?;
        for run in &runs[1..] {
            anyhow::ensure!(
                run.imu == runs[0].imu,
                "{} and {} are runs of one IMU, and have different figures in [imu]",
                runs[0].name,
                run.name
            );
        }
        let stem = |path: &PathBuf| {
            path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into())
        };
        let name = paths.iter().map(stem).collect::<Vec<String>>().join(" + ");
        Ok(Self { name, paths: paths.to_vec(), runs })
    }

    pub(super) fn duration(&self) -> f64 {
        self.runs.iter().map(Planned::duration).sum()
    }
}

/// The plan of a scenario file: what the data sheets say stands in the rig file of a run that is made from it.
fn planned(path: &Path) -> anyhow::Result<Planned> {
    let file = ScenarioFile::read(path)?;
    let profile = short(&file.scenario)?;
    let scenario = Scenario { profile, ..file.scenario.clone() }.without_errors();
    let run = simulate(&scenario).with_context(|| shown(path))?;
    let rig = rins_io::Rig::parse(&file.rig_toml(&run.recording), path)?;
    let imu = *rig.require_imu().context("what a schedule shows depends on the IMU's noise")?;
    let (noise, wobble) = table_accuracy(&rig);
    let acceleration = rig.table.as_ref().and_then(|table| table.acceleration);
    Ok(Planned::new(shown(path), file.scenario.clone(), imu, (noise, wobble, acceleration)))
}

/// The first ten samples of a scenario, enough to see what its log would hold.
fn short(scenario: &Scenario) -> anyhow::Result<Profile> {
    let duration = 10.0 * scenario.interval;
    Ok(Profile::new(&[Segment { rate: 0.0, duration }], None)?)
}

/// The scenario files of a proposal, made from that of the schedule at `path`.
pub(super) fn scenarios(
    proposal: &Proposal,
    path: &Path,
    limits: &Limits,
) -> anyhow::Result<Vec<String>> {
    let text = std::fs::read_to_string(path).with_context(|| shown(path))?;
    let given: Table = text.parse().with_context(|| shown(path))?;
    let candidate = &proposal.candidate;
    let runs = candidate.runs.iter().enumerate();
    runs.map(|(place, run)| {
        let mut scenario = given.clone();
        let table = section(&mut scenario, "table");
        table.insert("profile".into(), Value::Array(profile(&candidate.segments)));
        let acceleration = format!("{} deg/s^2", limits.acceleration / DEG);
        table.insert("acceleration".into(), Value::String(acceleration));
        if place > 0 {
            let angles = run.nav_from_table().euler_angles();
            let named = [("roll", angles.roll), ("pitch", angles.pitch), ("yaw", angles.yaw)];
            section(&mut scenario, "truth").remove("attitude");
            let attitude = section(&mut scenario, "attitude");
            for (name, angle) in named {
                attitude.insert(name.into(), Value::String(format!("{:.6} deg", angle / DEG)));
            }
        }
        let written = toml::to_string(&scenario)?;
        let (words, of) = (&candidate.words, candidate.runs.len());
        Ok(format!("# {words}: run {} of {of}.\n{written}", place + 1))
    })
    .collect()
}

fn profile(segments: &[Segment]) -> Vec<Value> {
    let part = |segment: &Segment| {
        let mut part = Table::new();
        // Nine digits: a third of a rate is no decimal fraction.
        let rate = format!("{} deg/s", rounded(segment.rate / DEG));
        part.insert("rate".into(), Value::String(rate));
        let duration = format!("{} s", rounded(segment.duration));
        part.insert("duration".into(), Value::String(duration));
        Value::Table(part)
    };
    segments.iter().map(part).collect()
}

fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// The section of a file of keys, made if it is not there.
fn section<'t>(file: &'t mut Table, name: &str) -> &'t mut Table {
    let value = file.entry(name).or_insert_with(|| Value::Table(Table::new()));
    if !value.is_table() {
        *value = Value::Table(Table::new());
    }
    value.as_table_mut().expect("it is a table by now")
}
