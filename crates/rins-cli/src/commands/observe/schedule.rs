//! Schedules to be looked at: runs of one IMU without noise, as scenario files describe them.

use std::path::{Path, PathBuf};

use anyhow::Context;
use rins_calibration::{Setup, TableSpec};
use rins_estimation::{Joint, Noise, Reference, Rig, Run, Strengths, joint};
use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, ImuSpec};
use rins_io::{ScenarioFile, shown};
use rins_motion::Profile;
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};
use rins_terms::Model;

/// A scenario, of which only what is planned matters: neither errors nor noise.
#[derive(Clone)]
pub(super) struct Planned {
    pub(super) path: PathBuf,
    pub(super) imu: ImuSpec,
    pub(super) acceleration: Option<f64>,
    scenario: Scenario,
    noise: f64,
    wobble: f64,
}

impl Planned {
    /// The plan of a scenario file.
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let file = ScenarioFile::read(path)?;
        let mut scenario = file.scenario.clone();
        scenario.imu_error = ImuError::default();
        scenario.noise = None;
        scenario.effects = Model::default();
        if let TableRecord::Angle(encoder) = &mut scenario.table {
            *encoder = Encoder::default();
        }
        // What the data sheets say stands in the rig file of a run that is made from the scenario.
        let run = simulate(&Scenario { profile: short(&scenario)?, ..scenario.clone() })
            .with_context(|| shown(path))?;
        let rig = rins_io::Rig::parse(&file.rig_toml(&run.recording), path)?;
        let imu = *rig.require_imu().context("what a schedule shows depends on the IMU's noise")?;
        let encoder = rig.log.table_angle();
        let read = encoder.and_then(|angle| angle.noise).unwrap_or(TableSpec::DEFAULT_ANGLE_NOISE);
        // A reading rounded to its last bit is off by that of a uniform deviate.
        let rounding =
            encoder.and_then(|angle| angle.resolution).unwrap_or_default() / 12.0_f64.sqrt();
        let noise = read.hypot(rounding);
        let table = rig.table.as_ref();
        Ok(Self {
            path: path.into(),
            imu,
            acceleration: table.and_then(|table| table.acceleration),
            wobble: table.and_then(|table| table.wobble).unwrap_or(noise),
            scenario,
            noise,
        })
    }

    /// A plan at the place and with the attitude of a run that has been measured, as long and as fast.
    pub(super) fn like(run: &Run, noise: &Noise, imu: ImuSpec) -> anyhow::Result<Self> {
        let times = &run.recording.times;
        let duration = times[times.len() - 1] - times[0];
        let interval = duration / (times.len() - 1) as f64;
        let rates = run.recording.increments.iter().map(|sample| sample.rates().angular_rate);
        let rate = rates.map(|rate| rate.components().z.abs()).fold(0.0, f64::max);
        let segment = rins_motion::Segment { rate, duration };
        Ok(Self {
            path: PathBuf::from("the next run"),
            imu,
            acceleration: None,
            scenario: Scenario::perfect(
                run.rig.station,
                run.rig.nav_from_table,
                Profile::new(&[segment], None)?,
                interval,
            ),
            noise: noise.encoder,
            wobble: noise.wobble,
        })
    }

    /// The same with another motion and attitude of the axis.
    pub(super) fn moved(&self, profile: Profile, nav_from_table: Dcm<Nav, Table>) -> Self {
        let scenario = Scenario { profile, nav_from_table, ..self.scenario.clone() };
        Self { scenario, ..self.clone() }
    }

    pub(super) fn nav_from_table(&self) -> Dcm<Nav, Table> {
        self.scenario.nav_from_table
    }

    pub(super) fn duration(&self) -> f64 {
        self.scenario.profile.duration()
    }

    /// The fastest that the table turns \[rad/s\].
    pub(super) fn fastest(&self) -> f64 {
        let steps = 1000;
        let times = (0..steps).map(|step| self.duration() * f64::from(step) / f64::from(steps));
        times.map(|time| self.scenario.profile.rate(time).abs()).fold(0.0, f64::max)
    }

    /// The run that it makes.
    fn run(&self) -> anyhow::Result<Run> {
        let scenario = &self.scenario;
        let recording = simulate(scenario).with_context(|| shown(&self.path))?.recording;
        let up = scenario.nav_from_table.matrix()[(2, 2)];
        let reference = match scenario.table {
            TableRecord::Angle(_) => Reference::Encoder { noise: self.noise },
            TableRecord::CommandedRate => Reference::Command { noise: 0.0 },
            TableRecord::Nothing if self.fastest() == 0.0 => Reference::Rest,
            TableRecord::Nothing => {
                anyhow::ensure!(
                    up.abs() < 0.9998,
                    "{}: the log holds neither a table angle nor a rate, and the axis is upright: nothing tells the table's angle",
                    shown(&self.path)
                );
                Reference::Gravity
            }
        };
        let rig = Rig {
            station: scenario.station,
            nav_from_table: scenario.nav_from_table,
            reference,
            wobble: self.wobble,
            velocity: Setup::FIXED_TABLE_VELOCITY_NOISE,
        };
        Run::new(rig, recording).with_context(|| shown(&self.path))
    }
}

/// The first second or ten samples of a scenario, enough to see what its log would hold.
fn short(scenario: &Scenario) -> anyhow::Result<Profile> {
    let duration = 10.0 * scenario.interval;
    Ok(Profile::new(&[rins_motion::Segment { rate: 0.0, duration }], None)?)
}

/// What runs of one IMU, to these plans, would say of what `model` estimates.
pub(super) fn evidence(planned: &[Planned], model: &Model) -> anyhow::Result<Joint> {
    let runs = planned.iter().map(Planned::run).collect::<anyhow::Result<Vec<Run>>>()?;
    let imu = &planned[0].imu;
    Ok(joint(&runs, model, imu, &Strengths::of(imu))?)
}

/// One or several scenarios that are looked at together.
pub(super) struct Schedule {
    /// What it is called: the file names.
    pub(super) name: String,
    pub(super) runs: Vec<Planned>,
}

impl Schedule {
    /// Of several runs of one IMU.
    pub(super) fn of(paths: &[PathBuf]) -> anyhow::Result<Self> {
        let runs =
            paths.iter().map(|path| Planned::read(path)).collect::<anyhow::Result<Vec<_>>>()?;
        for run in &runs[1..] {
            anyhow::ensure!(
                run.imu == runs[0].imu,
                "{} and {} are runs of one IMU, and have different figures in [imu]",
                shown(&runs[0].path),
                shown(&run.path)
            );
        }
        let stem = |run: &Planned| {
            run.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into())
        };
        let name = runs.iter().map(stem).collect::<Vec<String>>().join(" + ");
        Ok(Self { name, runs })
    }

    pub(super) fn duration(&self) -> f64 {
        self.runs.iter().map(Planned::duration).sum()
    }
}
