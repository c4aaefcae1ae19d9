//! Consistency of a filter's covariance: the coverage of its intervals.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use rayon::prelude::*;
use rins_calibration::{AngleSource, Reference, Setup, SpinAxisFilter, Start, TableReading};
use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, Seed, Sensor, TriadError};
use rins_motion::{Profile, Segment};
use rins_simulation::{Scenario, simulate};

use crate::bias_filter::BiasFilter;
use crate::error::ReproductionError;
use crate::experiment::{Experiment, spin_axis_error};
use crate::statistics::Sample;

/// Half the width of a two-sided 95 % interval of the standard normal distribution.
const WITHIN_95: f64 = 1.959963985;

/// The seed of the true errors; the noise of the runs has the seed of the scenario.
const TRUTH_SEED: u64 = 0x0007_2074;

/// The states of the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Model {
    /// The twelve states of the paper.
    Paper,
    /// These and three gyro biases.
    WithGyroBias,
}

/// The rotation of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Schedule {
    /// At 10 °/s throughout.
    ConstantRate,
    /// At 10 °/s for half the time, at 5 °/s for the other half.
    TwoRates,
    /// At 10 °/s for half the time, at -10 °/s for the other half.
    Reversal,
}

impl Schedule {
    fn profile(self, duration: f64) -> Result<Profile, ReproductionError> {
        let rate = 10.0 * rins_frames::units::DEG_PER_SECOND;
        let second = match self {
            Self::ConstantRate => rate,
            Self::TwoRates => 0.5 * rate,
            Self::Reversal => -rate,
        };
        let segments = [rate, second].map(|rate| Segment { rate, duration: 0.5 * duration });
        Ok(Profile::new(&segments, None)?)
    }
}

/// The consistency of a covariance.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Honesty {
    /// The number of runs.
    pub(crate) n_runs: u64,
    /// The coverage of the 95 % intervals of each parameter, from 0 to 1: the three
    /// spin-axis errors, and the biases if they are states.
    pub(crate) coverage: Vec<f64>,
    /// The mean squared error normalized by the covariance (NEES).
    pub(crate) nees: f64,
    /// The number of parameters, the expectation of `nees`.
    pub(crate) dof: usize,
    /// The mean standard uncertainty of `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub(crate) claimed: Vector3<f64>,
    /// The root mean squares of their errors.
    pub(crate) errors: Vector3<f64>,
}

impl Honesty {
    #[cfg(test)]
    /// The maximum ratio of error to standard uncertainty of the three spin-axis parameters.
    pub(crate) fn overconfidence(&self) -> f64 {
        self.errors.component_div(&self.claimed).max()
    }
}

/// The errors of one run's estimates, with their standard uncertainties.
struct Scored {
    error: Vec<f64>,
    sigma: Vec<f64>,
    nees: f64,
}

/// The results of `n_runs` runs of some duration \[s\], whose true errors are drawn from the data sheet in `experiment`.
///
/// The data contain the errors that the filter with biases models: the spin-axis errors, gyro biases, white noise.
///
/// # Errors
/// [`ReproductionError`] of the first failed run.
pub(crate) fn coverage(
    experiment: &Experiment,
    model: Model,
    schedule: Schedule,
    (n_runs, duration): (u64, f64),
    progress: impl Fn() + Sync,
) -> Result<Honesty, ReproductionError> {
    let profile = schedule.profile(duration)?;
    let scored: Vec<Scored> = (0..n_runs)
        .into_par_iter()
        .map(|run| {
            let scored = scored(experiment, model, &profile, run)?;
            progress();
            Ok(scored)
        })
        .collect::<Result<_, ReproductionError>>()?;
    let dof = scored.first().map_or(0, |run| run.error.len());
    let of = |parameter: usize| {
        scored.iter().map(move |run| (run.error[parameter], run.sigma[parameter]))
    };
    Ok(Honesty {
        n_runs,
        coverage: (0..dof)
            .map(|parameter| {
                let held = of(parameter).filter(|(error, sigma)| error.abs() < WITHIN_95 * sigma);
                held.count() as f64 / n_runs as f64
            })
            .collect(),
        nees: Sample::of(scored.iter().map(|run| run.nees)).mean,
        dof,
        claimed: Vector3::from_fn(|row, _| Sample::of(of(row).map(|(_, sigma)| sigma)).mean),
        errors: Vector3::from_fn(|row, _| {
            Sample::of(of(row).map(|(error, _)| error * error)).mean.sqrt()
        }),
    })
}

/// The true errors of a run, drawn from the data sheet.
fn drawn(setup: &Setup, run: u64) -> TriadError {
    let mut stream = Seed { seed: TRUTH_SEED, run }.stream(Sensor::Encoder);
    let mut draw = |sigma: f64| sigma * stream.sample();
    let spec = setup.imu.gyro;
    let [misalignment, scale] = [spec.misalignment_sigma, spec.scale_sigma];
    let column = Vector3::new(draw(misalignment), draw(misalignment), draw(scale));
    TriadError { bias: Vector3::from_fn(|_, _| draw(spec.bias_sigma)), ..spin_axis_error(&column) }
}

fn scored(
    experiment: &Experiment,
    model: Model,
    profile: &Profile,
    run: u64,
) -> Result<Scored, ReproductionError> {
    let Experiment { scenario, setup } = experiment;
    let truth = drawn(setup, run);
    let simulated = simulate(&Scenario {
        profile: profile.clone(),
        imu_error: ImuError { gyro: truth, ..ImuError::default() },
        seed: Seed { run, ..scenario.seed },
        ..scenario.clone()
    })?;
    let recording = &simulated.recording;
    let rates = recording.table_rate.iter().flatten();
    let samples = recording.times.iter().zip(&recording.increments).zip(rates);
    let attitude = scenario.nav_from_table;
    let broke_off = |time: f64| move |source| ReproductionError::Update { run, time, source };
    match model {
        Model::Paper => {
            let mut filter = paper_filter(setup, attitude);
            for ((&time, sample), &rate) in samples {
                let reference = Reference::fixed(TableReading::Rate(rate));
                filter.step(sample, &reference).map_err(broke_off(time))?;
            }
            let start = rins_calibration::layout::SPIN_AXIS_ERRORS.start();
            let covariance = filter.covariance().fixed_view::<3, 3>(start, start).into_owned();
            score(&(filter.estimate() - truth.matrix.column(2)), &covariance, run)
        }
        Model::WithGyroBias => {
            let mut filter = BiasFilter::new(setup, attitude);
            for ((&time, sample), &rate) in samples {
                filter.step(sample, rate).map_err(broke_off(time))?;
            }
            let column = truth.matrix.column(2);
            let true_values =
                SVector::<f64, 6>::from_fn(
                    |row, _| {
                        if row < 3 { column[row] } else { truth.bias[row - 3] }
                    },
                );
            score(&(filter.estimate() - true_values), &filter.covariance(), run)
        }
    }
}

/// The paper's filter at table angle zero, with an exactly known attitude.
pub(crate) fn paper_filter(setup: &Setup, nav_from_table: Dcm<Nav, Table>) -> SpinAxisFilter {
    let start = Start {
        nav_from_table,
        axis_covariance: Matrix3::zeros(),
        angle: 0.0,
        angle_source: AngleSource::Defined,
    };
    SpinAxisFilter::new(*setup, &start)
}

fn score<const N: usize>(
    error: &SVector<f64, N>,
    covariance: &SMatrix<f64, N, N>,
    run: u64,
) -> Result<Scored, ReproductionError> {
    let sigma: Vec<f64> = (0..N).map(|row| covariance[(row, row)].sqrt()).collect();
    // Whitened by an explicit Cholesky factorization, row by row: nalgebra needs bounds on N.
    let mut factor = SMatrix::<f64, N, N>::zeros();
    let mut nees = 0.0;
    let mut white = SVector::<f64, N>::zeros();
    for row in 0..N {
        for column in 0..=row {
            let inner: f64 = (0..column).map(|k| factor[(row, k)] * factor[(column, k)]).sum();
            let rest = covariance[(row, column)] - inner;
            factor[(row, column)] =
                if row == column { rest.sqrt() } else { rest / factor[(column, column)] };
        }
        let inner: f64 = (0..row).map(|k| factor[(row, k)] * white[k]).sum();
        white[row] = (error[row] - inner) / factor[(row, row)];
        nees += white[row] * white[row];
    }
    if nees.is_finite() {
        Ok(Scored { error: error.iter().copied().collect(), sigma, nees })
    } else {
        Err(ReproductionError::Singular { run })
    }
}
