//! Section 5's experiment, emulated: what an IMU of its grade makes of Table 5's errors.

use nalgebra::Vector3;
use rayon::prelude::*;
use rins_calibration::{calibrate, navigate_freely};
use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, Seed, Sensor, TriadError};
use rins_motion::{MeanUncertainty, Profile, RestMean, Segment, align};
use rins_simulation::{Scenario, simulate};

use crate::causes::{Cause, Graded};
use crate::error::ReproductionError;
use crate::experiment::{Experiment, spin_axis_part};
use crate::monte_carlo::figures;
use crate::pure_navigation::{Outcome, PureNavigation, Reference};
use crate::statistics::Sample;

/// The seed of the biases; their runs' noise has the scenario's.
const BIAS_SEED: u64 = 0x0007_2075;

/// How much of the turning the filter is run over \[s\]: it has converged long before.
const CALIBRATED: f64 = 100.0;

/// One emulated run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emulated {
    /// `M_xz`, `M_yz` \[rad\] and `S_z` as estimated.
    pub estimate: Vector3<f64>,
    /// What navigation ends with, as errors against the attitude it started with.
    pub before: Outcome,
    /// The same with the estimates compensated.
    pub after: Outcome,
}

/// `n_runs` runs, each with biases drawn from the grade: alignment on the rest, calibration, and
/// navigation before and after.
///
/// # Errors
/// [`ReproductionError`] of the first run that fails.
pub fn emulate(
    experiment: &Experiment,
    n_runs: u64,
    progress: impl Fn() + Sync,
) -> Result<Vec<Emulated>, ReproductionError> {
    let runs = (0..n_runs).into_par_iter().map(|run| {
        let done = emulated(experiment, run)?;
        progress();
        Ok(done)
    });
    runs.collect()
}

/// One of the five figures over some runs, in m/s and degrees.
pub fn spread(runs: &[Emulated], outcome: impl Fn(&Emulated) -> [f64; 5], figure: usize) -> Sample {
    Sample::of(runs.iter().map(|run| outcome(run)[figure]))
}

fn emulated(experiment: &Experiment, run: u64) -> Result<Emulated, ReproductionError> {
    let Experiment { scenario, setup } = experiment;
    let mut stream = Seed { seed: BIAS_SEED, run }.stream(Sensor::Encoder);
    let mut drawn = |sigma: f64| Vector3::from_fn(|_, _| sigma * stream.sample());
    let (gyro, accel) = (drawn(setup.imu.gyro.bias_sigma), drawn(setup.imu.accel.bias_sigma));
    let truth = scenario.imu_error;
    let imu_error = ImuError {
        gyro: TriadError { bias: gyro, ..truth.gyro },
        accel: TriadError { bias: accel, ..truth.accel },
    };
    let seed = Seed { run, ..scenario.seed };
    let simulated = simulate(&Scenario { imu_error, seed, ..scenario.clone() })?;
    let recording = simulated.recording;
    let angles = &simulated.truth.table_angle;
    let rest = angles.iter().take_while(|angle| **angle == 0.0).count();

    let missing = ReproductionError::Missing { name: "the real test", section: "a rest" };
    let mean = RestMean::of(&recording, 0..rest).ok_or(missing)?;
    // Only the attitude is of interest, not what is claimed for it.
    let sigma = MeanUncertainty {
        angular_rate: setup.imu.gyro.bias_sigma,
        specific_force: setup.imu.accel.bias_sigma,
    };
    let aligned = align(&mean.rates, &sigma, &scenario.station)?;
    let axis: Dcm<Nav, Table> = aligned.nav_from_body * Dcm::identity();

    let calibrated = rest + samples_in(CALIBRATED, scenario.interval);
    let calibration = calibrate(&recording.slice(0, calibrated), setup, |_| ())
        .map_err(|source| ReproductionError::Calibration { run, source })?;
    let compensation = calibration.imu_error.compensation()?;

    let spin = recording.slice(rest, recording.len());
    let turned = &angles[rest - 1..];
    let navigate = |compensation| {
        Outcome::from(&navigate_freely(&spin, turned, axis, &scenario.station, compensation))
    };
    Ok(Emulated {
        estimate: figures(&calibration).0,
        before: navigate(None),
        after: navigate(Some(&compensation)),
    })
}

/// How many intervals a span holds.
fn samples_in(span: f64, interval: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a span of some seconds in intervals of some milliseconds"
    )]
    let count = (span / interval).round() as usize;
    count
}

/// The turning part of the experiment without noise, its sensors without bias.
///
/// # Errors
/// [`ReproductionError`] if the scenario's profile does not end with a turn.
pub fn turning(experiment: &Experiment) -> Result<PureNavigation, ReproductionError> {
    let scenario = &experiment.scenario;
    let profile = &scenario.profile;
    let rate = profile.rate(profile.duration());
    let turn = profile.angle(profile.duration()) / rate;
    let segment = Segment { rate, duration: turn };
    let profile = Profile::new(&[segment], None)?;
    let turn = PureNavigation::of(&Scenario { profile, ..scenario.clone() }).noiseless();
    Ok(PureNavigation { reference: Reference::Start, ..turn })
}

/// What the model says of Table 6 before compensation: the errors of Table 5 and no other.
///
/// # Errors
/// [`ReproductionError`] if the navigation cannot be done.
pub fn predicted(experiment: &Experiment) -> Result<Outcome, ReproductionError> {
    turning(experiment)?.outcome()
}

/// The causes that may have left Table 6's errors after compensation, with what is allowed them.
///
/// The paper states 0.1 °/h, 100 µg, and a table that is good to 2″ and turns within 0.0001 °/s. Its
/// timing is allowed half a sample, 5 ms; an estimate of `M` or `S_z` what a bias of 0.1 °/h hides in it.
///
/// # Errors
/// [`ReproductionError`] if a navigation cannot be done.
pub fn causes_after(experiment: &Experiment) -> Result<Vec<Graded>, ReproductionError> {
    let base = compensated(experiment)?;
    [
        (Cause::AccelBias(0), 100.0),
        (Cause::AccelBias(1), 100.0),
        (Cause::GyroBias(0), 0.1),
        (Cause::GyroBiasChange(0), 0.1),
        (Cause::GyroBiasChange(1), 0.1),
        (Cause::GyroBiasChange(2), 0.1),
        (Cause::Estimate(0), 0.57),
        (Cause::Estimate(1), 0.57),
        (Cause::Estimate(2), 2.8),
        (Cause::Tilt(0), 2.0),
        (Cause::Tilt(1), 2.0),
        (Cause::Readout, 5.0),
    ]
    .par_iter()
    .map(|&(cause, grade)| Ok(Graded { cause, grade, effect: cause.effect(&base)? }))
    .collect()
}

/// The turning part with the errors of Table 5 compensated.
fn compensated(experiment: &Experiment) -> Result<PureNavigation, ReproductionError> {
    let gyro = spin_axis_part(&experiment.scenario.imu_error.gyro);
    Ok(turning(experiment)?.compensating(ImuError { gyro, ..ImuError::default() }))
}

/// The causes that may have made the difference of Table 6's two navigations other than Table 5's
/// errors do: what differed between two navigations of one log.
///
/// # Errors
/// [`ReproductionError`] if a navigation cannot be done.
pub fn causes_between(experiment: &Experiment) -> Result<Vec<Graded>, ReproductionError> {
    let base = turning(experiment)?;
    [
        (Cause::Start(0), 2.0),
        (Cause::Start(1), 2.0),
        (Cause::GyroBiasChange(0), 0.1),
        (Cause::GyroBiasChange(1), 0.1),
        (Cause::GyroBiasChange(2), 0.1),
        (Cause::Duration, 36.0),
    ]
    .par_iter()
    .map(|&(cause, grade)| Ok(Graded { cause, grade, effect: cause.effect(&base)? }))
    .collect()
}
