//! Emulation of the experiment of section 5: the effect of Table 5's errors for an IMU of its grade.

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

/// The seed of the biases; the noise of the runs has the seed of the scenario.
const BIAS_SEED: u64 = 0x0007_2075;

/// The part of the rotation from which the errors are estimated \[s\]: the estimates converge long before its end.
const CALIBRATED: f64 = 100.0;

/// The accuracy of the table rate \[rad/s\], section 5.1: "rotation rate accuracy is 0.0001 °/s".
pub(crate) const TABLE_RATE_ACCURACY: f64 = 1e-4 * DEG_PER_SECOND;

/// The typical relative error of a sample clock with a plain quartz oscillator \[ppm\].
const CLOCK: f64 = 20.0;

/// The typical noise density of a fiber-optic gyro of 0.1 °/h, 0.01 °/√h \[°/h/√Hz\].
const COMMON_GYRO_NOISE: f64 = 0.6;

/// One emulated run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Emulated {
    /// `M_xz`, `M_yz` \[rad\] and `S_z` in the data: with these, the filter's estimates are those of Table 5.
    pub(crate) truth: Vector3<f64>,
    /// The estimates of the three.
    pub(crate) estimate: Vector3<f64>,
    /// The final errors of the navigation, relative to its initial attitude.
    pub(crate) before: Outcome,
    /// The same with the estimates compensated.
    pub(crate) after: Outcome,
    /// The same with online compensation, of each sample with the estimate before it.
    pub(crate) online: Outcome,
}

/// The results of `n_runs` runs, each with biases drawn from the data sheet and a table rate drawn from its accuracy:
/// alignment on the static interval, calibration against the commanded rate, and navigation without compensation, with it and
/// with online compensation.
///
/// Table 5 contains estimates, so the true spin-axis errors of a run are those which together with its biases and its table rate
/// give the figures of Table 5.
///
/// # Errors
/// [`ReproductionError`] of the first failed run.
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
    // A rectangular distribution within the stated accuracy, because only its bounds are known.
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
    // The log contains the commanded rate.
    for rate in recording.table_rate.iter_mut().flatten() {
        *rate /= 1.0 + rate_error;
    }
    let angles = &simulated.truth.table_angle;
    let rest = angles.iter().take_while(|angle| **angle == 0.0).count();

    let missing =
        ReproductionError::Missing { name: "the real test", section: "a static interval" };
    let mean = RestMean::of(&recording, 0..rest).ok_or(missing)?;
    // Only the attitude is used, not its uncertainty.
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

/// The true `M_xz`, `M_yz` and `S_z` whose estimates are those of the scenario if the gyros have a bias \[rad/s\] and the
/// table rotates faster than commanded by a relative `rate_error`.
///
/// The gyros measure `(z + m) w' + B` at the true rate `w'` about the axis, including the Earth rate, and the filter
/// interprets it as `(z + m^) w` at the commanded rate.
fn true_errors(scenario: &Scenario, bias: &Vector3<f64>, rate_error: f64) -> Vector3<f64> {
    let commanded = spin_rate(scenario);
    let table = scenario.profile.rate(scenario.profile.duration());
    let measured = (scenario.imu_error.gyro.matrix.column(2) + Vector3::z()) * commanded;
    (measured - bias) / (commanded + table * rate_error) - Vector3::z()
}

/// The accuracy of the table rate, relative to the rate at the end of the experiment.
pub(crate) fn rate_accuracy(scenario: &Scenario) -> f64 {
    TABLE_RATE_ACCURACY / scenario.profile.rate(scenario.profile.duration())
}

/// Converts a standard normal number to a uniform distribution from -1 to 1.
fn evenly(normal: f64) -> f64 {
    1.0 - libm::erfc(normal * std::f64::consts::FRAC_1_SQRT_2)
}

/// A static interval and a rotation, with the rate of the rotation increased by a relative `error`.
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

/// The number of intervals in a span.
fn samples_in(span: f64, interval: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a span of some seconds in intervals of some milliseconds"
    )]
    let count = (span / interval).round() as usize;
    count
}

/// The rotating part of the experiment without noise, with sensors without bias.
///
/// # Errors
/// [`ReproductionError`] if the scenario's profile does not end with a rotation.
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

/// The model's prediction for Table 6 before compensation: the errors of Table 5 and no others.
///
/// # Errors
/// [`ReproductionError`] if the navigation fails.
pub(crate) fn predicted(experiment: &Experiment) -> Result<Outcome, ReproductionError> {
    turning(experiment)?.outcome()
}

/// The possible causes of Table 6's errors after compensation, each with its permitted size.
///
/// The paper states 0.1 °/h, 100 µg, and a table with an accuracy of 2″ and 0.0001 °/s. Timing may be wrong by
/// half a sample, 5 ms; an estimate of `M` or `S_z` by the effect of a bias of 0.1 °/h on it.
/// The paper states neither the gyros' noise nor the accuracy of the clocks.
///
/// # Errors
/// [`ReproductionError`] if a navigation fails.
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

/// The rotating part with the errors of Table 5 compensated.
fn compensated(experiment: &Experiment) -> Result<PureNavigation, ReproductionError> {
    let gyro = spin_axis_part(&experiment.scenario.imu_error.gyro);
    Ok(turning(experiment)?.compensating(ImuError { gyro, ..ImuError::default() }))
}

/// The possible causes of a difference between Table 6's two navigations other than that of Table 5's
/// errors: differences between two navigations of one log.
///
/// # Errors
/// [`ReproductionError`] if a navigation fails.
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
