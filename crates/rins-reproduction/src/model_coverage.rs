//! Consistency of the estimator of any list of terms: the coverage of its intervals.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{NoiseKnowledge, NoiseParameters, Reference, Rig, Run, fit};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{Dcm, EulerAngles, InFrame, Site, Table};
use rins_imu::{
    ImuError, ImuNoise, ImuSpec, NoiseModel, NormalStream, Seed, Sensor, TriadError, TriadSpec,
};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};
use rins_terms::{Model, Role, catalogue};

use crate::error::ReproductionError;

/// Half the width of a two-sided 95 % interval of the standard normal distribution.
const WITHIN_95: f64 = 1.959963985;

/// The seed of the true errors; the noise of the runs has another.
const TRUTH_SEED: u64 = 0x7272_6c73;

/// The 1σ of the surveyed attitude \[rad\]; the next constants are those of an encoder reading and of the axis' direction
/// \[rad\].
const ATTITUDE_SIGMA: f64 = 0.05 * DEG;
const ENCODER: f64 = 0.5 * ARCSEC;
const WOBBLE: f64 = 1e-3 * ARCSEC;

/// The rotation of the table, after a static interval of 30 s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Schedule {
    /// At 10 °/s throughout.
    ConstantRate,
    /// At 10 °/s, and reversed.
    Reversal,
    /// At ±10, ±40 and ±20 °/s.
    SeveralRates,
}

impl Schedule {
    /// All schedules.
    pub(crate) const ALL: [Self; 3] = [Self::ConstantRate, Self::Reversal, Self::SeveralRates];

    /// Its name in tables.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::ConstantRate => "constant rate",
            Self::Reversal => "reversal",
            Self::SeveralRates => "several rates",
        }
    }

    fn profile(self) -> Result<Profile, ReproductionError> {
        let rates: &[f64] = match self {
            Self::ConstantRate => &[10.0],
            Self::Reversal => &[10.0, -10.0],
            Self::SeveralRates => &[10.0, -10.0, 40.0, -40.0, 20.0, -20.0],
        };
        let turning = 360.0 / rates.len() as f64;
        let rest = Segment { rate: 0.0, duration: 30.0 };
        let turns =
            rates.iter().map(|rate| Segment { rate: rate * DEG_PER_SECOND, duration: turning });
        let segments: Vec<Segment> = std::iter::once(rest).chain(turns).collect();
        Ok(Profile::new(&segments, Some(5.0 * DEG_PER_SECOND))?)
    }
}

/// The noise in the data, with the estimator's knowledge of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Colour {
    /// The gyros' bias instability \[rad/s\], and the accelerometers' \[m/s²\]; zero is white noise only.
    pub(crate) flicker: (f64, f64),
    /// The estimator's knowledge of the noise parameters of its data sheet.
    pub(crate) knowledge: fn(NoiseParameters) -> NoiseKnowledge,
}

impl Colour {
    /// White noise with known density.
    pub(crate) const WHITE: Self = Self { flicker: (0.0, 0.0), knowledge: NoiseKnowledge::Given };

    /// Bias instability of 0.005 deg/h and 2 µg, estimated from the run together with the noise density.
    pub(crate) const FAINT: Self =
        Self { flicker: (0.005 * DEG_PER_HOUR, 2.0 * MICRO_G), knowledge: NoiseKnowledge::Likely };

    /// The same with 0.05 deg/h and 10 µg.
    pub(crate) const STRONG: Self =
        Self { flicker: (0.05 * DEG_PER_HOUR, 10.0 * MICRO_G), knowledge: NoiseKnowledge::Likely };

    /// Its name in tables.
    pub(crate) fn name(&self) -> String {
        if self.flicker.0 > 0.0 {
            format!(
                "bias instability {:.3} deg/h, {:.0} ug",
                self.flicker.0 / DEG_PER_HOUR,
                self.flicker.1 / MICRO_G
            )
        } else {
            "white".into()
        }
    }
}

/// The consistency of an estimator over many runs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coverage {
    /// The number of runs.
    pub(crate) n_runs: usize,
    /// The parameters' ids.
    pub(crate) ids: Vec<String>,
    /// The coverage of the 95 % intervals of each parameter.
    pub(crate) each: Vec<f64>,
    /// The same over all parameters.
    pub(crate) pooled: f64,
    /// The mean NEES; the number of parameters if the covariance is consistent.
    pub(crate) nees: f64,
    /// The standard deviation of the mean NEES.
    pub(crate) nees_sigma: f64,
    /// The ratio of mean squared error to variance for each parameter; at the true parameters the variance is the
    /// Cramér-Rao bound.
    pub(crate) variance_ratio: Vec<f64>,
    /// The mean estimate of the gyros' bias instability \[rad/s\].
    pub(crate) flicker: f64,
}

impl Coverage {
    /// The deviations from a consistent estimator, in words.
    pub(crate) fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let n = self.n_runs as f64;
        // The required bounds, or three binomial sigmas if the runs are too few for them.
        let pooled = 0.02_f64.max(3.0 * (0.05 * 0.95 / (n * self.ids.len() as f64 / 3.0)).sqrt());
        if (self.pooled - 0.95).abs() > pooled {
            faults.push(format!("pooled coverage {:.4}", self.pooled));
        }
        let low = 0.05_f64.max(3.5 * (0.05 * 0.95 / n).sqrt());
        for (id, each) in self.ids.iter().zip(&self.each) {
            if *each < 0.95 - low || (n >= 200.0 && *each > 0.9951) {
                faults.push(format!("{id}: coverage {each:.3}"));
            }
        }
        if (self.nees - self.ids.len() as f64).abs() > 2.576 * self.nees_sigma {
            let (nees, sigma) = (self.nees, self.nees_sigma);
            faults.push(format!("NEES {nees:.2} ± {sigma:.2} of {}", self.ids.len()));
        }
        for (id, ratio) in self.ids.iter().zip(&self.variance_ratio) {
            if *ratio > 1.1 + 3.0 * (2.0 / n).sqrt() {
                faults.push(format!("{id}: variance {ratio:.2} of the bound"));
            }
        }
        faults
    }
}

/// One run's errors, with their standard uncertainties and the estimated noise.
struct Scored {
    error: DVector<f64>,
    covariance: DMatrix<f64>,
    flicker: f64,
}

/// The results of `n_runs` runs with true errors drawn from a data sheet, with all of `Model::full()` estimated.
///
/// # Errors
/// [`ReproductionError`] of the first failed run.
pub(crate) fn coverage(
    schedule: Schedule,
    colour: &Colour,
    n_runs: usize,
    progress: impl Fn() + Sync,
) -> Result<Coverage, ReproductionError> {
    let (model, imu) = (model(), sheet());
    let ids: Vec<String> = model.free(&imu).into_iter().map(|free| free.id).collect();
    let scored: Vec<Scored> = (0..n_runs as u64)
        .into_par_iter()
        .map(|run| {
            let scored = scored(schedule, colour, &model, &imu, run)?;
            progress();
            Ok(scored)
        })
        .collect::<Result<_, ReproductionError>>()?;
    let n = n_runs as f64;
    let ratio = |run: &Scored, p: usize| run.error[p].powi(2) / run.covariance[(p, p)];
    let held = |p: usize| {
        scored.iter().filter(|run| ratio(run, p) < WITHIN_95 * WITHIN_95).count() as f64 / n
    };
    let each: Vec<f64> = (0..ids.len()).map(held).collect();
    let nees: Vec<f64> = scored
        .iter()
        .map(|run| {
            let factor = run.covariance.clone().cholesky();
            factor.map_or(f64::INFINITY, |factor| run.error.dot(&factor.solve(&run.error)))
        })
        .collect();
    Ok(Coverage {
        n_runs,
        pooled: each.iter().sum::<f64>() / each.len() as f64,
        each,
        nees: nees.iter().sum::<f64>() / n,
        nees_sigma: (2.0 * ids.len() as f64 / n).sqrt(),
        variance_ratio: (0..ids.len())
            .map(|p| {
                let errors: f64 = scored.iter().map(|run| run.error[p].powi(2)).sum();
                let claimed: f64 = scored.iter().map(|run| run.covariance[(p, p)]).sum();
                errors / claimed
            })
            .collect(),
        flicker: scored.iter().map(|run| run.flicker).sum::<f64>() / n,
        ids,
    })
}

/// All of eq. (1) and the attitude of the axis, with the uncertainty of the survey as its prior.
fn model() -> Model {
    ["x", "y", "z"].iter().fold(Model::full(), |model, axis| {
        let id = format!("{}.{axis}", catalogue::AXIS_ATTITUDE.id);
        model.with_role(&id, Role::Within(ATTITUDE_SIGMA))
    })
}

/// The data sheet of a navigation-grade fiber-optic unit.
fn sheet() -> ImuSpec {
    ImuSpec {
        gyro: TriadSpec::white(
            0.02 * DEG_PER_HOUR,
            0.1 * DEG_PER_HOUR,
            500.0 * PPM,
            120.0 * ARCSEC,
        ),
        accel: TriadSpec::white(30.0 * MICRO_G, 200.0 * MICRO_G, 300.0 * PPM, 60.0 * ARCSEC),
    }
}

fn scored(
    schedule: Schedule,
    colour: &Colour,
    model: &Model,
    imu: &ImuSpec,
    run: u64,
) -> Result<Scored, ReproductionError> {
    let mut truth = Seed { seed: TRUTH_SEED, run }.stream(Sensor::Encoder);
    let (imu_error, tilt) = (drawn(imu, &mut truth), drawn_vector(ATTITUDE_SIGMA, &mut truth));
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 400.0 };
    let station = Station::with_normal_gravity(site);
    let surveyed = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG }.dcm();
    let standing = surveyed * Dcm::<Table, Table>::from_rotation_vector(tilt.components());
    let noise = |density, flicker: f64| NoiseModel {
        flicker: (flicker > 0.0).then_some(flicker),
        ..NoiseModel::white(density)
    };
    let scenario = Scenario {
        imu_error,
        noise: Some(ImuNoise {
            gyro: noise(imu.gyro.noise_density, colour.flicker.0),
            accel: noise(imu.accel.noise_density, colour.flicker.1),
        }),
        table: TableRecord::Angle(Encoder { noise: ENCODER, resolution: None, zero: 0.0 }),
        seed: Seed { seed: TRUTH_SEED + 1, run },
        ..Scenario::perfect(station, standing, schedule.profile()?, 0.04)
    };
    let simulated = simulate(&scenario)?;
    let rig = Rig {
        station,
        nav_from_table: surveyed,
        reference: Reference::Encoder { noise: ENCODER },
        wobble: WOBBLE,
        velocity: 1e-6,
    };
    let runs = [Run::new(rig, simulated.recording)?];
    let fit = fit(&runs, model, imu, (colour.knowledge)(NoiseParameters::of(imu)), |_| ())?;
    Ok(Scored {
        error: DVector::from_iterator(
            fit.parameters.len(),
            fit.parameters.iter().map(|p| p.value - true_value(&p.parameter.id, &imu_error, &tilt)),
        ),
        flicker: fit.noise[0].imu.gyro.flicker,
        covariance: fit.covariance,
    })
}

/// Errors drawn from the data sheet.
fn drawn(imu: &ImuSpec, stream: &mut NormalStream) -> ImuError {
    let mut triad = |spec: &TriadSpec| {
        let mut error = TriadError::default();
        for row in 0..3 {
            error.bias[row] = spec.bias_sigma * stream.sample();
            for column in 0..3 {
                let sigma = if row == column { spec.scale_sigma } else { spec.misalignment_sigma };
                error.matrix[(row, column)] = sigma * stream.sample();
            }
        }
        error
    };
    ImuError { gyro: triad(&imu.gyro), accel: triad(&imu.accel) }
}

fn drawn_vector(sigma: f64, stream: &mut NormalStream) -> InFrame<Table> {
    InFrame::new(sigma * stream.sample(), sigma * stream.sample(), sigma * stream.sample())
}

/// The true value of a parameter.
fn true_value(id: &str, error: &ImuError, tilt: &InFrame<Table>) -> f64 {
    let place =
        |letter: Option<char>| "xyz".chars().position(|axis| Some(axis) == letter).unwrap_or(0);
    let mut parts = id.split('.');
    let (device, kind, name) = (parts.next(), parts.next(), parts.next().unwrap_or_default());
    let mut letters = name.chars();
    let row = place(letters.next());
    let column = letters.next().map_or(row, |letter| place(Some(letter)));
    let triad = match device {
        Some("gyro") => &error.gyro,
        Some("accel") => &error.accel,
        _ => return tilt.components()[row],
    };
    if kind == Some("bias") { triad.bias[row] } else { triad.matrix[(row, column)] }
}
