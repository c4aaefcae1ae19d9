//! A run as the estimator has it, its model standing at the truth: what a log shows beyond it.

use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};
use rins_blind::{Experiment, Known, Log, Place, Sensors};
use rins_estimation::{
    Evidence, Indefinite, Noise, NoiseParameters, Reference, Rig, Run, RunError, TriadStrengths,
    linearise,
};
use rins_frames::{Dcm, EulerAngles, InFrame, Increments, Nav, Site, Table};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::{Recording, Station};
use rins_terms::{FreeParameter, Model, TermInstance, catalogue};

/// The velocity of a table on its base, 1σ \[m/s\].
const VELOCITY: f64 = 1e-6;

/// The wobble of an axis that has none \[rad\].
const NO_WOBBLE: f64 = 5e-9;

/// Why a run cannot be looked at.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StandError {
    /// The run is none.
    #[error("the run cannot be used")]
    Run(#[from] RunError),
    /// Its noise makes no covariance.
    #[error("the run's noise makes no covariance")]
    Noise(#[from] Indefinite),
}

/// A run of which all is known.
#[derive(Clone, Debug)]
pub struct Stand {
    /// Its data sheet.
    pub imu: ImuSpec,
    /// Its noise as it truly is.
    pub noise: Noise,
    /// The baseline with its true values.
    pub model: Model,
    /// The rig with its true attitude.
    rig: Rig,
}

impl Stand {
    /// What is true of an experiment, all effects but its baseline left out.
    pub fn of(experiment: &Experiment, known: &Known) -> Self {
        let sheet = |of: &rins_blind::SensorsKnown| {
            TriadSpec::white(of.noise, of.bias, of.scale, of.misalignment)
        };
        let strengths = |of: &rins_blind::Noise| TriadStrengths {
            white: of.white,
            flicker: of.flicker,
            walk: of.walk,
        };
        let imu = ImuSpec { gyro: sheet(&known.gyro), accel: sheet(&known.accel) };
        let rig = Rig {
            station: station(&known.place),
            nav_from_table: attitude(&experiment.attitude),
            reference: Reference::Encoder { noise: known.encoder_noise },
            wobble: known.wobble.unwrap_or(NO_WOBBLE),
            velocity: VELOCITY,
        };
        let strengths = NoiseParameters {
            gyro: strengths(&experiment.gyro.noise),
            accel: strengths(&experiment.accel.noise),
            jitter: 0.0,
        };
        let noise = Noise::on(&rig, &strengths);
        Self { imu, noise, model: baseline(experiment), rig }
    }

    /// A log as a run of this rig.
    ///
    /// # Errors
    /// [`StandError`] if it is too short.
    pub fn run(&self, log: &Log, interval: f64) -> Result<Run, StandError> {
        Ok(Run::new(self.rig, recording(log, interval))?)
    }

    /// What `run` says of the baseline and of `more` terms beside it.
    ///
    /// # Errors
    /// [`StandError`] if the noise makes no covariance.
    pub fn told(&self, run: &Run, more: &[TermInstance]) -> Result<ExtraInformation, StandError> {
        let mut model = self.model.clone();
        model.terms.extend(more.iter().cloned());
        let free = model.free(&self.imu);
        let places: Vec<(usize, usize)> = free.iter().map(|f| (f.term, f.parameter)).collect();
        let evidence = Evidence::of(&linearise(run, &model, &places), &self.noise)?;
        Ok(ExtraInformation::of(&evidence, &free, self.model.terms.len()))
    }
}

/// What a run says of terms beyond the baseline, in units of their usual sizes.
#[derive(Clone, Debug)]
pub struct ExtraInformation {
    /// The squares that are left beside the baseline.
    pub square: f64,
    /// The information on the further parameters, the baseline estimated beside.
    pub information: DMatrix<f64>,
    /// The derivative of the log-likelihood by them.
    pub score: DVector<f64>,
    /// The usual size of each, in SI units.
    pub scale: Vec<f64>,
    /// Of each further term, where its parameters begin, and behind the last one where they end.
    pub starts: Vec<usize>,
}

impl ExtraInformation {
    fn of(evidence: &Evidence, free: &[FreeParameter], baseline: usize) -> Self {
        let scale = DVector::from_iterator(free.len(), free.iter().map(|f| f.sigma));
        let all = DMatrix::from_fn(free.len(), free.len(), |row, column| {
            evidence.information[(row, column)] * scale[row] * scale[column]
        });
        let score = evidence.score.component_mul(&scale);
        let known = free.iter().filter(|f| f.term < baseline).count();
        let rest = free.len() - known;
        // What the data sheet says of the baseline counts once.
        let corner = all.view((0, 0), (known, known)) + DMatrix::identity(known, known);
        let across = all.view((0, known), (known, rest)).into_owned();
        let first = score.rows(0, known).into_owned();
        let mut starts: Vec<usize> = Vec::new();
        for (place, parameter) in free[known..].iter().enumerate() {
            if parameter.term - baseline == starts.len() {
                starts.push(place);
            }
        }
        starts.push(rest);
        let Some(factor) = corner.cholesky() else {
            let (information, score) = (DMatrix::zeros(rest, rest), DVector::zeros(rest));
            return Self { square: 0.0, information, score, scale: Vec::new(), starts };
        };
        let solved = factor.solve(&across);
        Self {
            square: evidence.square - first.dot(&factor.solve(&first)),
            information: all.view((known, known), (rest, rest)) - across.transpose() * &solved,
            score: score.rows(known, rest) - solved.transpose() * first,
            scale: scale.as_slice()[known..].to_vec(),
            starts,
        }
    }

    /// The places of the parameters of a further term.
    pub fn places(&self, term: usize) -> std::ops::Range<usize> {
        self.starts[term]..self.starts[term + 1]
    }
}

/// A log as a recording.
pub fn recording(log: &Log, interval: f64) -> Recording {
    let increments = log.gyro.iter().zip(&log.accel).map(|(gyro, accel)| Increments {
        angle: InFrame::from_components(gyro * interval),
        velocity: InFrame::from_components(accel * interval),
        interval,
    });
    Recording {
        times: log.times.clone(),
        increments: increments.collect(),
        table_angle: Some(log.angles.clone()),
        table_rate: None,
        temperature: Some(log.temperature.clone()),
    }
}

fn station(place: &Place) -> Station {
    let site = Site { latitude: place.latitude, longitude: 0.0, height: 0.0 };
    Station { site, gravity: place.gravity }
}

/// The attitude of an axis frame with these angles \[rad\].
pub(crate) fn attitude(angles: &[f64; 3]) -> Dcm<Nav, Table> {
    EulerAngles { roll: angles[0], pitch: angles[1], yaw: angles[2] }.dcm()
}

/// The baseline at its true values; the mounting is part of both triads' matrices.
fn baseline(experiment: &Experiment) -> Model {
    let [x, y] = experiment.mounting;
    let turned = UnitQuaternion::from_scaled_axis(Vector3::new(x, y, 0.0)).inverse();
    let of_table = |sensors: &Sensors| {
        let matrix = (Matrix3::identity() + sensors.matrix) * turned.to_rotation_matrix().matrix();
        matrix - Matrix3::identity()
    };
    let triads = [
        (
            &experiment.gyro,
            [&catalogue::GYRO_BIAS, &catalogue::GYRO_SCALE, &catalogue::GYRO_MISALIGNMENT],
        ),
        (
            &experiment.accel,
            [&catalogue::ACCEL_BIAS, &catalogue::ACCEL_SCALE, &catalogue::ACCEL_MISALIGNMENT],
        ),
    ];
    let mut model = Model::full();
    for (sensors, [bias, scale, misalignment]) in triads {
        let m = of_table(sensors);
        for chosen in &mut model.terms {
            if chosen.term.is(bias) {
                chosen.values = sensors.bias.as_slice().to_vec();
            } else if chosen.term.is(scale) {
                chosen.values = m.diagonal().as_slice().to_vec();
            } else if chosen.term.is(misalignment) {
                chosen.values =
                    vec![m[(0, 1)], m[(0, 2)], m[(1, 0)], m[(1, 2)], m[(2, 0)], m[(2, 1)]];
            }
        }
    }
    model
}
