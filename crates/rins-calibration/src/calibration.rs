//! A calibration: from a recording to parameters, their covariance, and what they are worth.

use nalgebra::{Matrix3, SVector, Vector3};
use rins_ekf::UpdateError;
use rins_frames::{Body, Dcm, Increments, Nav, Table};
use rins_imu::{ImuCompensationError, ImuError, TriadError};
use rins_motion::{AlignmentError, MeanUncertainty, Recording, RestMean, align, rest_spans};

use crate::consistency::Consistency;
use crate::filter::{
    AngleSource, MEASUREMENTS, Reference, SpinAxisFilter, Start, TableReading, gyro_error,
};
use crate::history::Thinning;
use crate::layout::{AXIS, SPIN_AXIS_ERRORS};
use crate::navigation::{FreeNavigation, navigate_freely};
use crate::parameter::{Parameter, ParameterKind};
use crate::separability::SpinRateSums;
use crate::setup::Setup;

/// The shortest rest at the start that is left out, and can be aligned on \[s\].
const SHORTEST_REST: f64 = 5.0;

/// The fewest samples a filter is run over.
const FEWEST_SAMPLES: usize = 100;

/// The mean spin rate, root mean square \[rad/s\], below which the table has not turned.
const LEAST_SPIN_RATE: f64 = 1e-3;

/// Why a recording could not be calibrated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// Neither table angle nor table rate.
    #[error("the calibration needs the table angle or the commanded rate; the log has neither")]
    NoTable,
    /// The table hardly turned.
    #[error(
        "the table hardly turns ({spin_rate:.1e} rad/s rms): gyro errors along the spin axis do not show"
    )]
    NoTurn {
        /// The root mean square of the spin rate \[rad/s\].
        spin_rate: f64,
    },
    /// Too few samples after the rest.
    #[error(
        "only {samples} samples are left after the rest at the start; at least {fewest} are needed"
    )]
    TooShort {
        /// How many there are.
        samples: usize,
        /// How many are needed.
        fewest: usize,
    },
    /// No attitude given, and no rest to align on.
    #[error(
        "the attitude of the axis is not given and the log does not start with {shortest} s of rest to align on"
    )]
    NoAttitude {
        /// The shortest rest that would do \[s\].
        shortest: f64,
    },
    /// The rest at the start cannot be aligned on.
    #[error(
        "the attitude of the axis is not given, and cannot be found from the rest at the start"
    )]
    Alignment(#[from] AlignmentError),
    /// The filter broke off.
    #[error("the filter broke off at {time} s")]
    Update {
        /// The end of the sample's interval \[s\].
        time: f64,
        /// Why.
        source: UpdateError,
    },
    /// The estimates cannot be compensated.
    #[error("the estimates cannot be compensated")]
    Compensation(#[from] ImuCompensationError),
}

/// A moment of the filter's run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimatePoint {
    /// \[s\]
    pub time: f64,
    /// `M_xz`, `M_yz` \[rad\], `S_z`.
    pub estimate: Vector3<f64>,
    /// Their 1σ.
    pub sigma: Vector3<f64>,
}

/// Where the start attitude came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttitudeSource {
    /// It was given.
    Given,
    /// The rest at the start was aligned.
    Aligned,
}

/// A finished calibration.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// The samples the filter ran over: those after the rest at the start.
    pub span: std::ops::Range<usize>,
    /// Where the start attitude came from.
    pub attitude_source: AttitudeSource,
    /// The estimates.
    pub parameters: Vec<Parameter>,
    /// Their correlation matrix.
    pub correlation: Matrix3<f64>,
    /// The estimates as a sensor error, to be compensated.
    pub imu_error: ImuError,
    /// Their 1σ, in the same places.
    pub imu_error_sigma: ImuError,
    /// The attitude of the axis frame, from the whole run.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The 1σ of the three components of its error in n \[rad\].
    pub axis_sigma: Vector3<f64>,
    /// What the innovations say of the model.
    pub consistency: Consistency,
    /// The estimates on the way.
    pub history: Vec<EstimatePoint>,
    /// The whitened innovations, one a sample.
    pub innovations: Vec<SVector<f64, MEASUREMENTS>>,
    /// When each came: the ends of the samples' intervals \[s\].
    pub innovation_times: Vec<f64>,
    /// Free inertial navigation over the span with nothing compensated.
    pub before: FreeNavigation,
    /// The same, from the same attitude, with the estimates compensated.
    pub after: FreeNavigation,
}

/// Runs the paper's 12-state filter over a recording.
///
/// A rest at the start is left out: what the gyros do there is bias, which the model does not have.
/// `progress` is told how many samples are done, now and then.
///
/// # Errors
/// [`CalibrationError`]; nothing is half done.
pub fn calibrate(
    recording: &Recording,
    setup: &Setup,
    mut progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    let angles = table_angles(recording, setup.table.latency).ok_or(CalibrationError::NoTable)?;
    let rest = rest_spans(recording, SHORTEST_REST)
        .into_iter()
        .next()
        .filter(|span| span.start == 0)
        .map_or(0..0, |span| span);
    let (start, attitude_source) = start(recording, setup, rest.clone(), &angles)?;

    let span = rest.end..recording.len();
    let samples = span.len();
    if samples < FEWEST_SAMPLES {
        return Err(CalibrationError::TooShort { samples, fewest: FEWEST_SAMPLES });
    }
    let mut filter = SpinAxisFilter::new(*setup, &start);
    let mut history = Vec::new();
    let mut innovations = Vec::with_capacity(samples);
    let mut sums = SpinRateSums::default();
    let thinning = Thinning::of(samples);
    for (done, index) in span.clone().enumerate() {
        let sample = &recording.increments[index];
        let time = recording.times[index];
        let reading = match (&recording.table_angle, &recording.table_rate) {
            (None, Some(rate)) => TableReading::Rate(rate[index]),
            _ => TableReading::Angle(angles[index + 1]),
        };
        let whitened = filter
            .step(sample, &Reference::fixed(reading))
            .map_err(|source| CalibrationError::Update { time, source })?;
        innovations.push(whitened);
        sums.add(sample.angle.components().z / sample.interval, sample.interval);
        if thinning.keeps(done) {
            history.push(EstimatePoint {
                time,
                estimate: *filter.estimate(),
                sigma: sigma(&filter, SPIN_AXIS_ERRORS.start()),
            });
            progress(done);
        }
    }
    let spin_rate = sums.root_mean_square();
    if spin_rate < LEAST_SPIN_RATE {
        return Err(CalibrationError::NoTurn { spin_rate });
    }

    let imu_error = ImuError { gyro: filter.gyro_error(), accel: TriadError::default() };
    let run = recording.slice(span.start, span.end);
    let angles = &angles[span.start..];
    let axis = filter.nav_from_table();
    let navigate = |compensation| navigate_freely(&run, angles, axis, &setup.station, compensation);
    let before = navigate(None);
    let after = navigate(Some(&imu_error.compensation()?));
    Ok(Calibration {
        parameters: parameters(&filter, &sums, setup),
        correlation: correlation(&filter),
        imu_error,
        imu_error_sigma: ImuError {
            gyro: gyro_error(&sigma(&filter, SPIN_AXIS_ERRORS.start())),
            accel: TriadError::default(),
        },
        nav_from_table: axis,
        axis_sigma: sigma(&filter, AXIS.start()),
        consistency: Consistency::of(&innovations)
            .ok_or(CalibrationError::TooShort { samples, fewest: FEWEST_SAMPLES })?,
        span,
        attitude_source,
        history,
        innovation_times: run.times.clone(),
        innovations,
        before,
        after,
    })
}

/// The table angle before the first sample of a recording and after each \[rad\]: as read, brought
/// forward by its `latency` \[s\] at the gyro's rate, or the commanded rate integrated from zero.
pub fn table_angles(recording: &Recording, latency: f64) -> Option<Vec<f64>> {
    if let Some(angle) = &recording.table_angle {
        let turn = |sample: &Increments| sample.angle.components().z;
        let current =
            |(angle, sample): (&f64, &Increments)| angle + latency * turn(sample) / sample.interval;
        let mut angles = vec![0.0];
        angles.extend(angle.iter().zip(&recording.increments).map(current));
        // Nothing was read before the first sample; the gyro says how far the table came since.
        if let (Some(first), Some(sample)) = (angles.get(1), recording.increments.first()) {
            angles[0] = first - turn(sample);
        }
        return Some(angles);
    }
    let rate = recording.table_rate.as_ref()?;
    let mut angle = 0.0;
    let turns = rate.iter().zip(&recording.increments).map(|(rate, sample)| {
        angle += rate * sample.interval;
        angle
    });
    Some(std::iter::once(0.0).chain(turns).collect())
}

/// How the filter starts at the end of a rest.
fn start(
    recording: &Recording,
    setup: &Setup,
    rest: std::ops::Range<usize>,
    angles: &[f64],
) -> Result<(Start, AttitudeSource), CalibrationError> {
    let angle = angles[rest.end];
    let angle_source = match recording.table_angle {
        Some(_) => AngleSource::Read,
        None => AngleSource::Defined,
    };
    if let Some(axis) = setup.axis {
        let axis_covariance = Matrix3::identity() * (axis.sigma * axis.sigma);
        let start =
            Start { nav_from_table: axis.angles.dcm(), axis_covariance, angle, angle_source };
        return Ok((start, AttitudeSource::Given));
    }
    let mean = RestMean::of(recording, rest)
        .ok_or(CalibrationError::NoAttitude { shortest: SHORTEST_REST })?;
    let (gyro, accel) = (&setup.imu.gyro, &setup.imu.accel);
    let noise = |density: f64| density / mean.duration.sqrt();
    let force = setup.station.gravity * accel.scale_sigma.max(accel.misalignment_sigma);
    let sigma = MeanUncertainty {
        angular_rate: noise(gyro.noise_density).hypot(gyro.bias_sigma),
        specific_force: noise(accel.noise_density).hypot(accel.bias_sigma).hypot(force),
    };
    let alignment = align(&mean.rates, &sigma, &setup.station)?;
    let table_from_body = Dcm::<Table, Body>::about_z(angle);
    let nav_from_table = alignment.nav_from_body * table_from_body.inverse();
    let axis_covariance = alignment.covariance;
    let start = Start { nav_from_table, axis_covariance, angle, angle_source };
    Ok((start, AttitudeSource::Aligned))
}

fn parameters(filter: &SpinAxisFilter, sums: &SpinRateSums, setup: &Setup) -> Vec<Parameter> {
    let sigma = sigma(filter, SPIN_AXIS_ERRORS.start());
    [
        ("gyro.misalignment.xz", ParameterKind::Misalignment, "gyro.bias.x"),
        ("gyro.misalignment.yz", ParameterKind::Misalignment, "gyro.bias.y"),
        ("gyro.scale.z", ParameterKind::Scale, "gyro.bias.z"),
    ]
    .into_iter()
    .enumerate()
    .map(|(row, (id, kind, partner))| Parameter {
        id,
        kind,
        value: filter.estimate()[row],
        sigma: sigma[row],
        partners: sums.partner(&setup.imu.gyro, partner).into_iter().collect(),
    })
    .collect()
}

fn sigma(filter: &SpinAxisFilter, first: usize) -> Vector3<f64> {
    Vector3::from_fn(|row, _| filter.covariance()[(first + row, first + row)].sqrt())
}

fn correlation(filter: &SpinAxisFilter) -> Matrix3<f64> {
    let start = SPIN_AXIS_ERRORS.start();
    let covariance = filter.covariance().fixed_view::<3, 3>(start, start);
    Matrix3::from_fn(|row, column| {
        let product = covariance[(row, row)] * covariance[(column, column)];
        if row == column { 1.0 } else { covariance[(row, column)] / product.sqrt() }
    })
}
