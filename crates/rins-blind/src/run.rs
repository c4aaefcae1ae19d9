//! Simulation of an experiment to its log.

use std::ops::{Add, Mul};

use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};

use crate::drive::Way;
use crate::effect::Law;
use crate::experiment::Experiment;
use crate::imu::{readings, sums};
use crate::laws::Pose;
use crate::motion::Motion;
use crate::random::random;

/// The recorded signals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Log {
    /// The end of each sample \[s\].
    pub times: Vec<f64>,
    /// The mean rate over each sample \[rad/s\].
    pub gyro: Vec<Vector3<f64>>,
    /// The mean specific force over each sample \[m/s²\].
    pub accel: Vec<Vector3<f64>>,
    /// The encoder reading at the end of each sample \[rad\].
    pub angles: Vec<f64>,
    /// The temperature at the end of each sample \[°C\].
    pub temperature: Vec<f64>,
}

/// The margin of the grid before and after the run, for delays of either sign \[s\].
const MARGIN: f64 = 0.5;

/// Streams of random numbers other than those of the sensors.
const ENCODER: u64 = 6;
const DRIVE: u64 = 7;
const FAULTS: u64 = 8;

/// The grid of short steps of a run.
pub(crate) struct Grid {
    /// The length of a step \[s\].
    pub(crate) step: f64,
    /// The number of steps before the run.
    pub(crate) lead: usize,
    /// The number of steps.
    pub(crate) steps: usize,
    /// The number of samples of the run.
    pub(crate) samples: usize,
}

impl Grid {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "durations are positive, and some thousand seconds at most"
    )]
    fn of(experiment: &Experiment) -> Self {
        let samples = (experiment.drive.duration() / experiment.interval).round() as usize;
        let step = experiment.interval / experiment.substeps as f64;
        let lead = (MARGIN / step).round() as usize;
        Self { step, lead, steps: samples * experiment.substeps + 2 * lead, samples }
    }

    /// The time of a point \[s\].
    pub(crate) fn time(&self, place: usize) -> f64 {
        (place as f64 - self.lead as f64) * self.step
    }

    /// The interpolation at `time` of a list of values at the grid points.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the places of the list"
    )]
    pub(crate) fn between<T>(&self, list: &[T], time: f64) -> T
    where
        T: Copy + Add<Output = T> + Mul<f64, Output = T>,
    {
        let place = (time / self.step + self.lead as f64).clamp(0.0, (list.len() - 2) as f64);
        // A point that is missed by rounding only counts as that point.
        let whole = (place + 1e-6).floor();
        let part = (place - whole).max(0.0);
        list[whole as usize] * (1.0 - part) + list[whole as usize + 1] * part
    }
}

/// The log of an experiment.
///
/// # Panics
/// If an effect has an id without a law, or fewer parameters than its law needs.
pub fn record(experiment: &Experiment) -> Log {
    let mut truth = experiment.clone();
    for effect in &experiment.effects {
        if let Law::Setup(change) = effect.law() {
            change(&effect.parameters, &effect.settings, &mut truth);
        }
    }
    let grid = Grid::of(&truth);
    let mut shaking = random(truth.seed, DRIVE);
    let way = truth.drive.way(grid.step, grid.lead, grid.steps, &mut shaking);
    let motion = Motion::new(&truth, grid.step);
    let attitudes = motion.attitudes(&way, grid.lead);
    let sums = sums(&truth, &grid, &way, &motion, &attitudes);
    let (gyro, accel) = readings(&truth, &grid, &sums);
    let times: Vec<f64> = (1..=grid.samples).map(|sample| sample as f64 * truth.interval).collect();
    let mut log = Log {
        angles: encoder(&truth, &grid, &way, &times),
        temperature: times.iter().map(|time| truth.temperature.at(*time)).collect(),
        times,
        gyro,
        accel,
    };
    let mut faults = random(truth.seed, FAULTS);
    for effect in &truth.effects {
        if let Law::Spoil(spoil) = effect.law() {
            spoil(&effect.parameters, &effect.settings, &mut log, &mut faults);
        }
    }
    log
}

/// The encoder readings.
fn encoder(truth: &Experiment, grid: &Grid, way: &Way, times: &[f64]) -> Vec<f64> {
    let mut random = random(truth.seed, ENCODER);
    let read = |&time: &f64| {
        let mut late = 0.0;
        for effect in &truth.effects {
            if let Law::Late(of) = effect.law() {
                late += of(&effect.parameters, &effect.settings, time);
            }
        }
        let angle = grid.between(&way.angles, time - late);
        let sense = grid.between(&way.senses, time).round();
        let pose = Pose { time, angle, sense };
        let mut sum = angle;
        for effect in &truth.effects {
            if let Law::Read(of) = effect.law() {
                sum += of(&effect.parameters, &effect.settings, &pose);
            }
        }
        let normal: f64 = StandardNormal.sample(&mut random);
        sum += truth.encoder.noise * normal;
        if truth.encoder.resolution > 0.0 {
            sum = (sum / truth.encoder.resolution).round() * truth.encoder.resolution;
        }
        sum
    };
    times.iter().map(read).collect()
}
