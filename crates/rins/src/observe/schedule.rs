//! Scenario files as plans, and plans as scenario files.

use std::path::{Path, PathBuf};

use anyhow::Context;
use rins_design::{Limits, Planned, Proposal, TYPICAL_ACCELERATION, TYPICAL_RATE};
use rins_frames::units::DEG;
use rins_frames::{Dcm, Nav};
use rins_io::{ScenarioFile, shown};
use rins_motion::{Profile, Segment};
use rins_simulation::{Scenario, simulate};
use toml::{Table, Value};

use crate::log::table_accuracy;

/// One or several scenarios that are looked at together: runs of one IMU.
#[derive(Debug)]
pub(crate) struct Schedule {
    /// What it is called: the file names.
    pub(crate) name: String,
    pub(crate) paths: Vec<PathBuf>,
    pub(crate) runs: Vec<Planned>,
}

impl Schedule {
    /// Of several runs of one IMU.
    pub(crate) fn of(paths: &[PathBuf]) -> anyhow::Result<Self> {
        let planned = paths.iter().map(|path| planned(path)).collect::<anyhow::Result<Vec<_>>>()?;
        let of_series = |series: &Option<String>| {
            let first = planned.iter().position(|(_, other)| other.is_some() && other == series);
            first.filter(|_| series.is_some())
        };
        let runs: Vec<Planned> = planned
            .iter()
            .map(|(run, series)| match of_series(series) {
                Some(first) => run.clone().since(first),
                None => run.clone(),
            })
            .collect();
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

    pub(crate) fn duration(&self) -> f64 {
        self.runs.iter().map(Planned::duration).sum()
    }

    /// The largest rate \[rad/s\] and the acceleration \[rad/s²\] of its table: as stated, as in the scenario, or typical ones.
    pub(crate) fn table(&self, rate: Option<f64>, acceleration: Option<f64>) -> (f64, f64) {
        let fastest = self.runs.iter().map(Planned::fastest).fold(0.0, f64::max);
        let usual = if fastest > 0.0 { fastest } else { TYPICAL_RATE };
        let acceleration = acceleration.or(self.runs[0].acceleration);
        (rate.unwrap_or(usual), acceleration.unwrap_or(TYPICAL_ACCELERATION))
    }
}

/// The plan of a scenario file, and the series that it belongs to: what the data sheets say stands in the rig file of a run that is made from it.
fn planned(path: &Path) -> anyhow::Result<(Planned, Option<String>)> {
    let file = ScenarioFile::read(path)?;
    let profile = short(&file.scenario)?;
    let scenario = Scenario { profile, ..file.scenario.clone() }.without_errors();
    let run = simulate(&scenario).with_context(|| shown(path))?;
    let rig = rins_io::Rig::parse(&file.rig_toml(&run.recording), path)?;
    let imu = *rig.require_imu().context("what a schedule shows depends on the IMU's noise")?;
    let (noise, wobble) = table_accuracy(&rig);
    let acceleration = rig.table.as_ref().and_then(|table| table.acceleration);
    let series = rig.run.series.clone();
    let accuracy = (noise, wobble, acceleration);
    let planned = Planned::new(shown(path), file.scenario.clone(), imu, accuracy);
    Ok((planned.with_axes(file.spin.into()), series))
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
    let candidate = &proposal.candidate;
    let base = ScenarioBase::read(path)?;
    let runs = candidate.runs.iter().enumerate();
    runs.map(|(place, run)| {
        let attitude = (place > 0).then(|| run.nav_from_table());
        let title = format!("{}: run {} of {}.", candidate.words, place + 1, candidate.runs.len());
        base.with(&Changes {
            title,
            segments: &candidate.segments,
            acceleration: limits.acceleration,
            attitude,
            spin: None,
            series: None,
        })
    })
    .collect()
}

/// What is different in a scenario that is made from another one.
pub(crate) struct Changes<'a> {
    /// The first line.
    pub(crate) title: String,
    pub(crate) segments: &'a [Segment],
    /// The acceleration of the table \[rad/s²\].
    pub(crate) acceleration: f64,
    pub(crate) attitude: Option<Dcm<Nav, rins_frames::Table>>,
    /// The axis of the IMU along the spin axis.
    pub(crate) spin: Option<String>,
    /// The series of runs in one power-on.
    pub(crate) series: Option<&'a str>,
}

/// A scenario file from which others are made.
pub(crate) struct ScenarioBase(Table);

impl ScenarioBase {
    pub(crate) fn read(path: &Path) -> anyhow::Result<Self> {
        let text = std::fs::read_to_string(path).with_context(|| shown(path))?;
        Ok(Self(text.parse().with_context(|| shown(path))?))
    }

    /// The same scenario with another motion.
    pub(crate) fn with(&self, changes: &Changes<'_>) -> anyhow::Result<String> {
        let Changes { title, segments, acceleration, attitude, spin, series } = changes;
        let mut scenario = self.0.clone();
        let table = section(&mut scenario, "table");
        table.insert("profile".into(), Value::Array(profile(segments)));
        let acceleration = format!("{} deg/s^2", rounded(acceleration / DEG));
        table.insert("acceleration".into(), Value::String(acceleration));
        if let Some(attitude) = attitude {
            let angles = attitude.euler_angles();
            let named = [("roll", angles.roll), ("pitch", angles.pitch), ("yaw", angles.yaw)];
            section(&mut scenario, "truth").remove("attitude");
            let attitude = section(&mut scenario, "attitude");
            for (name, angle) in named {
                attitude.insert(name.into(), Value::String(format!("{:.6} deg", angle / DEG)));
            }
        }
        if let Some(spin) = spin {
            section(&mut scenario, "axis").insert("spin".into(), Value::String(spin.clone()));
        }
        if let Some(series) = series {
            let series = Value::String((*series).into());
            section(&mut scenario, "run").insert("series".into(), series);
        }
        let written = toml::to_string(&scenario)?;
        Ok(format!("# {title}\n{written}"))
    }
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
