//! Section 5's experiment, emulated: what an IMU of its grade makes of Table 5's errors.

use nalgebra::Vector3;
use rayon::prelude::*;
use rins_calibration::{navigate_freely, navigate_online, running_estimate};
use rins_frames::units::{DEG_PER_SECOND, PPM};
use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, Seed, Sensor, TriadError};
use rins_motion::{MeanUncertainty, Profile, RestMean, Segment, align};
use rins_simulation::{Scenario, simulate};

use crate::causes::{Basis, Cause, Graded};
use crate::convergence::spin_rate;
use crate::error::ReproductionError;
use crate::experiment::{Experiment, spin_axis_error, spin_axis_part};
use crate::pure_navigation::{Outcome, PureNavigation, Reference};
use crate::statistics::Sample;

/// The seed of the biases; their runs' noise has the scenario's.
const BIAS_SEED: u64 = 0x0007_2075;

/// How much of the turning the estimates are from \[s\]: they have converged long before.
const CALIBRATED: f64 = 100.0;

/// How accurate the table's rate is \[rad/s\], section 5.1: "rotation rate accuracy is 0.0001 °/s".
pub(crate) const TABLE_RATE_ACCURACY: f64 = 1e-4 * DEG_PER_SECOND;

/// The relative sample clock error that a plain quartz oscillator commonly has \[ppm\].
const CLOCK: f64 = 20.0;

/// The noise that a fibre-optic gyro of 0.1 °/h commonly has, 0.01 °/√h \[°/h/√Hz\].
const COMMON_GYRO_NOISE: f64 = 0.6;

/// One emulated run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Emulated {
    /// `M_xz`, `M_yz` \[rad\] and `S_z` in the data: for these, the filter's estimates are Table 5's.
    pub(crate) truth: Vector3<f64>,
    /// The same three as estimated.
    pub(crate) estimate: Vector3<f64>,
    /// What navigation ends with, as errors against the attitude it started with.
    pub(crate) before: Outcome,
    /// The same with the estimates compensated.
    pub(crate) after: Outcome,
    /// The same compensated while it turns, each sample with the estimate before it.
    pub(crate) online: Outcome,
}

/// `n_runs` runs, each with biases drawn from the data sheet and a table rate drawn from its accuracy:
/// alignment on the static interval, calibration against the commanded rate, and navigation before, after and
/// compensated online.
///
/// Table 5 gives estimates, so the true spin-axis errors of a run are those which its biases and its table rate
/// turn into Table 5's figures.
///
/// # Errors
/// [`ReproductionError`] of the first run that fails.
pub(crate) fn emulate(
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
pub(crate) fn spread(
    runs: &[Emulated],
    outcome: impl Fn(&Emulated) -> [f64; 5],
    figure: usize,
) -> Sample {
    Sample::of(runs.iter().map(|run| outcome(run)[figure]))
}

fn emulated(experiment: &Experiment, run: u64) -> Result<Emulated, ReproductionError> {
    let Experiment { scenario, setup } = experiment;
    let mut stream = Seed { seed: BIAS_SEED, run }.stream(Sensor::Encoder);
    let mut drawn = |sigma: f64| Vector3::from_fn(|_, _| sigma * stream.sample());
    let (gyro, accel) = (drawn(setup.imu.gyro.bias_sigma), drawn(setup.imu.accel.bias_sigma));
    // Rectangular within the accuracy stated, as nothing but its bounds is known.
    let rate_error = rate_accuracy(scenario) * evenly(stream.sample());
    let estimated = scenario.imu_error;
    let mut matrix = estimated.gyro.matrix;
    let truth = true_errors(scenario, &gyro, rate_error);
    matrix.set_column(2, &truth);
    let imu_error = ImuError {
        gyro: TriadError { bias: gyro, matrix },
        accel: TriadError { bias: accel, ..estimated.accel },
    };
    let seed = Seed { run, ..scenario.seed };
    let profile = faster(&scenario.profile, rate_error)?;
    let simulated = simulate(&Scenario { imu_error, seed, profile, ..scenario.clone() })?;
    let mut recording = simulated.recording;
    // The log holds what was commanded.
    for rate in recording.table_rate.iter_mut().flatten() {
        *rate /= 1.0 + rate_error;
    }
    let angles = &simulated.truth.table_angle;
    let rest = angles.iter().take_while(|angle| **angle == 0.0).count();

    let missing =
        ReproductionError::Missing { name: "the real test", section: "a static interval" };
    let mean = RestMean::of(&recording, 0..rest).ok_or(missing)?;
    // Only the attitude is of interest, not what is claimed for it.
    let sigma = MeanUncertainty {
        angular_rate: setup.imu.gyro.bias_sigma,
        specific_force: setup.imu.accel.bias_sigma,
    };
    let aligned = align(&mean.rates, &sigma, &scenario.station)?;
    let axis: Dcm<Nav, Table> = aligned.nav_from_body * Dcm::identity();

    let running = running_estimate(&recording, setup)
        .map_err(|source| ReproductionError::Calibration { run, source })?;
    let estimate = running.before(rest + samples_in(CALIBRATED, scenario.interval));
    let gyro = spin_axis_error(&estimate);
    let compensation = ImuError { gyro, ..ImuError::default() }.compensation()?;

    let spin = recording.slice(rest, recording.len());
    let turned = &angles[rest - 1..];
    let station = &scenario.station;
    let navigate =
        |compensation| Outcome::from(&navigate_freely(&spin, turned, axis, station, compensation));
    let each = running.compensations(rest..recording.len())?;
    let online = navigate_online(&spin, turned, axis, station, &each);
    Ok(Emulated {
        truth,
        estimate,
        before: navigate(None),
        after: navigate(Some(&compensation)),
        online: Outcome::from(&online),
    })
}

/// The `M_xz`, `M_yz` and `S_z` that are estimated as the scenario's where the gyros have a bias \[rad/s\] and the
/// table turns faster than commanded by a relative `rate_error`.
///
/// The gyros deliver `(z + m) w' + B` at the true rate `w'` about the axis, the Earth's included, and the filter
/// takes it for `(z + m^) w` at the commanded one.
fn true_errors(scenario: &Scenario, bias: &Vector3<f64>, rate_error: f64) -> Vector3<f64> {
    let commanded = spin_rate(scenario);
    let table = scenario.profile.rate(scenario.profile.duration());
    let measured = (scenario.imu_error.gyro.matrix.column(2) + Vector3::z()) * commanded;
    (measured - bias) / (commanded + table * rate_error) - Vector3::z()
}

/// The accuracy of the table's rate, relative to the rate at the experiment's end.
pub(crate) fn rate_accuracy(scenario: &Scenario) -> f64 {
    TABLE_RATE_ACCURACY / scenario.profile.rate(scenario.profile.duration())
}

/// A standard normal number as one that is spread evenly over -1 to 1.
fn evenly(normal: f64) -> f64 {
    1.0 - libm::erfc(normal * std::f64::consts::FRAC_1_SQRT_2)
}

/// A static interval and a turn, the turn faster by a relative `error`.
fn faster(profile: &Profile, error: f64) -> Result<Profile, ReproductionError> {
    let duration = profile.duration();
    let rate = profile.rate(duration);
    let turn = profile.angle(duration) / rate;
    let segments = [
        Segment { rate: 0.0, duration: duration - turn },
        Segment { rate: rate * (1.0 + error), duration: turn },
    ];
    Ok(Profile::new(&segments, None)?)
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
pub(crate) fn turning(experiment: &Experiment) -> Result<PureNavigation, ReproductionError> {
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
pub(crate) fn predicted(experiment: &Experiment) -> Result<Outcome, ReproductionError> {
    turning(experiment)?.outcome()
}

/// The causes that may have left Table 6's errors after compensation, each with the size allowed it.
///
/// The paper states 0.1 °/h, 100 µg, and a table that is accurate to 2″ and to 0.0001 °/s. Timing is allowed
/// half a sample, 5 ms; an estimate of `M` or `S_z` what a bias of 0.1 °/h hides in it.
/// The paper states neither the gyros' noise nor the accuracy of the clocks.
///
/// # Errors
/// [`ReproductionError`] if a navigation cannot be done.
pub(crate) fn causes_after(experiment: &Experiment) -> Result<Vec<Graded>, ReproductionError> {
    use Basis::{Plausible, Stated};
    let base = compensated(experiment)?;
    let rate = rate_accuracy(&experiment.scenario) / PPM;
    graded(
        &base,
        &[
            (Cause::AccelBias(0), 100.0, Stated),
            (Cause::AccelBias(1), 100.0, Stated),
            (Cause::GyroBias(0), 0.1, Stated),
            (Cause::GyroBiasChange(0), 0.1, Stated),
            (Cause::GyroBiasChange(1), 0.1, Stated),
            (Cause::GyroBiasChange(2), 0.1, Stated),
            (Cause::Estimate(0), 0.57, Stated),
            (Cause::Estimate(1), 0.57, Stated),
            (Cause::Estimate(2), 2.8, Stated),
            (Cause::TableRate, rate, Stated),
            (Cause::Tilt(0), 2.0, Stated),
            (Cause::Tilt(1), 2.0, Stated),
            (Cause::Readout, 5.0, Stated),
            (Cause::SampleClock, CLOCK, Plausible),
            (Cause::GyroNoise, COMMON_GYRO_NOISE, Plausible),
        ],
    )
}

/// Causes with their effects about a navigation.
fn graded(
    base: &PureNavigation,
    causes: &[(Cause, f64, Basis)],
) -> Result<Vec<Graded>, ReproductionError> {
    causes
        .par_iter()
        .map(|&(cause, grade, basis)| {
            Ok(Graded { cause, grade, basis, effect: cause.effect(base)? })
        })
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
pub(crate) fn causes_between(experiment: &Experiment) -> Result<Vec<Graded>, ReproductionError> {
    use Basis::{Plausible, Stated};
    graded(
        &turning(experiment)?,
        &[
            (Cause::Start(0), 2.0, Stated),
            (Cause::Start(1), 2.0, Stated),
            (Cause::GyroBiasChange(0), 0.1, Stated),
            (Cause::GyroBiasChange(1), 0.1, Stated),
            (Cause::GyroBiasChange(2), 0.1, Stated),
            (Cause::Duration, 36.0, Plausible),
        ],
    )
}
