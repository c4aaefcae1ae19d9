//! A calibration: parameters with their covariance from a recording, a consistency test, and the effect on free inertial
//! navigation.

use std::ops::Range;

use nalgebra::{Matrix3, SVector, Vector3};
use rins_ekf::UpdateError;
use rins_frames::units::{ARCSEC, PPM};
use rins_frames::{Body, Dcm, Nav, Table};
use rins_imu::{ImuCompensationError, ImuError, TriadError, TriadSpec};
use rins_inspection::{SensorFigures, StaticIntervals, StaticOptions};
use rins_motion::{AlignmentError, MeanUncertainty, Recording, RestMean, align};

use crate::consistency::Consistency;
use crate::filter::{AngleSource, MEASUREMENTS, Reference, SpinAxisFilter, Start, TableReading};
use crate::history::Thinning;
use crate::layout::{AXIS, SPIN_AXIS_ERRORS};
use crate::navigation::{FreeNavigation, navigate_freely};
use crate::parameter::{Parameter, ParameterKind};
use crate::separability::SpinRateSums;
use crate::setup::{Setup, TableSpec};
use crate::table_angle::table_angles;

/// The shortest static interval at the start that is excluded and that can be used for the alignment \[s\].
const SHORTEST_REST: f64 = 5.0;

/// The smallest number of samples for the filter.
const FEWEST_SAMPLES: usize = 100;

/// The smallest spin rate, root mean square, of a rotating table \[rad/s\].
const LEAST_SPIN_RATE: f64 = 1e-3;

/// The bias of `M_xz`, `M_yz` \[rad\] and `S_z` due to unmodeled accelerometer errors, through the zero velocity measurement,
/// for biases of about 200 µg. A smaller effect of a gyro bias is not reported.
const SYSTEMATIC: [f64; 3] = [0.03 * ARCSEC, 0.03 * ARCSEC, 0.1 * PPM];

/// The reason why a recording cannot be calibrated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The recording has neither a table angle nor a table rate.
    #[error("the calibration needs the table angle or the commanded rate; the log has neither")]
    NoTable,
    /// The table hardly rotates.
    #[error(
        "the table hardly rotates ({spin_rate:.1e} rad/s rms): gyro errors along the spin axis are unobservable"
    )]
    NoTurn {
        /// The root mean square of the spin rate \[rad/s\].
        spin_rate: f64,
    },
    /// There are too few samples after the static interval.
    #[error(
        "only {samples} samples remain after the static interval at the start; at least {fewest} are needed"
    )]
    TooShort {
        /// The number of samples.
        samples: usize,
        /// The required number.
        fewest: usize,
    },
    /// No attitude is given, and there is no static interval for the alignment.
    #[error(
        "the attitude of the spin axis is not given and the log does not start with a static interval of \
         {shortest} s for the alignment"
    )]
    NoAttitude {
        /// The shortest sufficient static interval \[s\].
        shortest: f64,
    },
    /// The alignment over the static interval at the start failed.
    #[error(
        "the attitude of the spin axis is not given, and the alignment over the static interval at the start failed"
    )]
    Alignment(#[from] AlignmentError),
    /// The filter failed.
    #[error("the filter failed at {time} s")]
    Update {
        /// The end of the sample's interval \[s\].
        time: f64,
        /// The reason.
        source: UpdateError,
    },
    /// The estimates cannot be compensated: their matrix is singular.
    #[error("the estimates cannot be compensated")]
    Compensation(#[from] ImuCompensationError),
}

/// The estimate at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimatePoint {
    /// \[s\]
    pub time: f64,
    /// `M_xz`, `M_yz` \[rad\], `S_z`.
    pub estimate: Vector3<f64>,
    /// Their 1σ.
    pub sigma: Vector3<f64>,
}

/// The source of the initial attitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttitudeSource {
    /// It is given.
    Given,
    /// Alignment over the static interval at the start.
    Aligned,
}

/// A finished calibration.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// The samples of the filter: those after the static interval at the start.
    pub span: Range<usize>,
    /// The source of the initial attitude.
    pub attitude_source: AttitudeSource,
    /// The estimates.
    pub parameters: Vec<Parameter>,
    /// Their correlation matrix.
    pub correlation: Matrix3<f64>,
    /// The estimates as a sensor error, for the compensation.
    pub imu_error: ImuError,
    /// The estimated attitude of the axis frame, from the whole run.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The 1σ of the three components of its error in n \[rad\].
    pub axis_sigma: Vector3<f64>,
    /// The consistency of the innovations with the model.
    pub consistency: Consistency,
    /// The estimates during the run.
    pub history: Vec<EstimatePoint>,
    /// The whitened innovations, one for each sample.
    pub innovations: Vec<SVector<f64, MEASUREMENTS>>,
    /// The times of the innovations: the ends of the samples' intervals \[s\].
    pub innovation_times: Vec<f64>,
    /// Free inertial navigation over the span without compensation.
    pub before: FreeNavigation,
    /// The same from the same initial attitude, with the estimates compensated.
    pub after: FreeNavigation,
}

/// Runs the paper's 12-state filter over a recording.
///
/// A static interval at the start is excluded: there the gyro errors are biases, which are not part of the model. `progress`
/// receives the number of processed samples from time to time.
///
/// # Errors
/// [`CalibrationError`]; there are no partial results.
pub fn calibrate(
    recording: &Recording,
    setup: &Setup,
    mut progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    let run = Run::prepare(recording, setup)?;
    let samples = run.span.len();
    let mut history = Vec::new();
    let mut innovations = Vec::with_capacity(samples);
    let thinning = Thinning::of(samples);
    let filter = run.pass(setup, samples, |done, filter, whitened| {
        innovations.push(whitened);
        if thinning.keeps(done) {
            history.push(EstimatePoint {
                time: recording.times[run.span.start + done],
                estimate: filter.estimate(),
                sigma: sigma(filter, SPIN_AXIS_ERRORS.start()),
            });
            progress(done);
        }
    })?;
    let sums = run.spin_rate_sums();

    let imu_error = ImuError { gyro: filter.gyro_error(), accel: TriadError::default() };
    let span = run.span.clone();
    let turned = recording.slice(span.start, span.end);
    let angles = &run.angles[span.start..];
    let axis = filter.nav_from_table();
    let navigate =
        |compensation| navigate_freely(&turned, angles, axis, &setup.station, compensation);
    let before = navigate(None);
    let after = navigate(Some(&imu_error.compensation()?));
    Ok(Calibration {
        parameters: parameters(&filter, &sums, setup),
        correlation: correlation(&filter),
        imu_error,
        nav_from_table: axis,
        axis_sigma: sigma(&filter, AXIS.start()),
        consistency: Consistency::of(&innovations)
            .ok_or(CalibrationError::TooShort { samples, fewest: FEWEST_SAMPLES })?,
        span,
        attitude_source: run.attitude_source,
        history,
        innovation_times: turned.times,
        innovations,
        before,
        after,
    })
}

/// The maximum likelihood estimate of the wobble, 1σ of each component of the spin axis direction \[rad\], for a table
/// without a stated wobble.
///
/// It is accurate to a factor of two, and searched between 1e-4 and 10 times the encoder's noise. The wobble is assumed
/// white; other spectra are not detected.
///
/// # Errors
/// As [`calibrate`].
pub fn likely_wobble(recording: &Recording, setup: &Setup) -> Result<f64, CalibrationError> {
    /// The first minutes are sufficient; more samples only increase the time.
    const MOST_SAMPLES: usize = 10_000;
    let run = Run::prepare(recording, setup)?;
    let samples = run.span.len().min(MOST_SAMPLES);
    let log_likelihood = |wobble: f64| {
        let tried = Setup { table: TableSpec { wobble, ..setup.table }, ..*setup };
        // A wobble that is too small for the numerical resolution of the filter is not a candidate.
        run.pass(&tried, samples, |_, _, _| ()).map_or(f64::NEG_INFINITY, |f| f.log_likelihood())
    };
    let mut best = (setup.table.angle_noise, log_likelihood(setup.table.angle_noise));
    for (factor, powers) in [(10.0, &[-4, -3, -2, -1, 1][..]), (3.0, &[-1, 1])] {
        let centre = best.0;
        for &power in powers {
            let wobble = centre * f64::powi(factor, power);
            let tried = (wobble, log_likelihood(wobble));
            if tried.1 > best.1 {
                best = tried;
            }
        }
    }
    Ok(best.0)
}

/// A recording prepared for the filter.
pub(crate) struct Run<'a> {
    recording: &'a Recording,
    /// The table angle before the first sample, and after each sample.
    angles: Vec<f64>,
    /// The samples after the static interval at the start.
    pub(crate) span: Range<usize>,
    pub(crate) start: Start,
    attitude_source: AttitudeSource,
}

impl<'a> Run<'a> {
    pub(crate) fn prepare(
        recording: &'a Recording,
        setup: &Setup,
    ) -> Result<Self, CalibrationError> {
        let angles =
            table_angles(recording, setup.table.latency).ok_or(CalibrationError::NoTable)?;
        let figures = |sheet: &TriadSpec| SensorFigures {
            bias_sigma: Some(sheet.bias_sigma),
            noise_density: Some(sheet.noise_density),
            resolution: sheet.resolution,
        };
        let options = StaticOptions {
            gyro: figures(&setup.imu.gyro),
            accel: figures(&setup.imu.accel),
            ..StaticOptions::default()
        };
        let rest = StaticIntervals::of(recording, &options)
            .spans(SHORTEST_REST)
            .into_iter()
            .next()
            .filter(|span| span.start == 0)
            .unwrap_or(0..0);
        let (start, attitude_source) = start(recording, setup, rest.clone(), &angles)?;
        let run =
            Self { recording, angles, span: rest.end..recording.len(), start, attitude_source };
        let samples = run.span.len();
        if samples < FEWEST_SAMPLES {
            return Err(CalibrationError::TooShort { samples, fewest: FEWEST_SAMPLES });
        }
        let spin_rate = run.spin_rate_sums().root_mean_square();
        if spin_rate < LEAST_SPIN_RATE {
            return Err(CalibrationError::NoTurn { spin_rate });
        }
        Ok(run)
    }

    /// Runs the filter over the first `samples` of the span; `seen` receives each step.
    pub(crate) fn pass(
        &self,
        setup: &Setup,
        samples: usize,
        mut seen: impl FnMut(usize, &SpinAxisFilter, SVector<f64, MEASUREMENTS>),
    ) -> Result<SpinAxisFilter, CalibrationError> {
        let recording = self.recording;
        let mut filter = SpinAxisFilter::new(*setup, &self.start);
        for (done, index) in self.span.clone().take(samples).enumerate() {
            let reading = match (&recording.table_angle, &recording.table_rate) {
                (None, Some(rate)) => TableReading::Rate(rate[index]),
                _ => TableReading::Angle(self.angles[index + 1]),
            };
            let whitened =
                filter.step(&recording.increments[index], &Reference::fixed(reading)).map_err(
                    |source| CalibrationError::Update { time: recording.times[index], source },
                )?;
            seen(done, &filter, whitened);
        }
        Ok(filter)
    }

    fn spin_rate_sums(&self) -> SpinRateSums {
        let mut sums = SpinRateSums::default();
        for sample in &self.recording.increments[self.span.clone()] {
            sums.add(sample.angle.components().z / sample.interval, sample.interval);
        }
        sums
    }
}

/// The initial state of the filter at the end of a static interval.
fn start(
    recording: &Recording,
    setup: &Setup,
    rest: Range<usize>,
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
        id: id.into(),
        kind,
        value: filter.estimate()[row],
        sigma: sigma[row],
        partners: sums
            .partner(&setup.imu.gyro, sigma[row].hypot(SYSTEMATIC[row]), partner)
            .into_iter()
            .collect(),
    })
    .collect()
}

pub(crate) fn sigma(filter: &SpinAxisFilter, first: usize) -> Vector3<f64> {
    Vector3::from_fn(|row, _| filter.covariance()[(first + row, first + row)].sqrt())
}

fn correlation(filter: &SpinAxisFilter) -> Matrix3<f64> {
    let start = SPIN_AXIS_ERRORS.start();
    let covariance = filter.covariance().fixed_view::<3, 3>(start, start).into_owned();
    Matrix3::from_fn(|row, column| {
        let product = covariance[(row, row)] * covariance[(column, column)];
        if row == column {
            1.0
        } else if product > 0.0 {
            covariance[(row, column)] / product.sqrt()
        } else {
            0.0
        }
    })
}
