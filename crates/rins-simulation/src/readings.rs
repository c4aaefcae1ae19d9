//! Readings without noise from true motion: eq. (1) and the effects.

use rins_frames::{InFrame, Increments, Table};
use rins_terms::{MeasurementModel, Model, Surroundings, Track};

use crate::check::ScenarioError;
use crate::scenario::Scenario;

/// The true motion of a run, sample by sample.
#[derive(Debug)]
pub(crate) struct TrueRun {
    pub(crate) times: Vec<f64>,
    pub(crate) increments: Vec<Increments>,
    /// The table angle at the end of each interval \[rad\]; zero at time zero.
    pub(crate) angles: Vec<f64>,
    pub(crate) temperature: Option<Vec<f64>>,
}

/// The readings without noise.
#[derive(Debug)]
pub(crate) struct Readings {
    pub(crate) increments: Vec<Increments>,
    /// The error of each reading of the table angle \[rad\]; empty if no effect acts on them.
    pub(crate) angle_errors: Vec<f64>,
    /// The tilt at time zero and at the end of each interval; empty if the axis does not move.
    pub(crate) tilts: Vec<InFrame<Table>>,
}

/// An empty list with room for `n_samples`.
pub(crate) fn reserved<T>(n_samples: usize) -> Result<Vec<T>, ScenarioError> {
    let mut list = Vec::new();
    match list.try_reserve_exact(n_samples) {
        Ok(()) => Ok(list),
        Err(_) => Err(ScenarioError::OutOfMemory { n_samples }),
    }
}

impl Scenario {
    /// The readings without noise for the true motion `truth`.
    pub(crate) fn readings(&self, truth: &TrueRun) -> Result<Readings, ScenarioError> {
        let mut readings = Readings {
            increments: reserved(truth.increments.len())?,
            angle_errors: Vec::new(),
            tilts: Vec::new(),
        };
        if !self.effects.terms.iter().any(|chosen| chosen.term.is_signal()) {
            let measured = truth.increments.iter().map(|truth| self.imu_error.measure(truth));
            readings.increments.extend(measured);
            return Ok(readings);
        }
        // Eq. (1) acts on the actual motion including the tilt of the table, so all terms are applied together.
        let mut model = Model::from(&self.imu_error);
        model.terms.extend(self.effects.terms.iter().cloned());
        let track = self.track(truth)?;
        let mut making = MeasurementModel::new(&model, &track);
        readings.angle_errors = reserved(truth.increments.len())?;
        readings.tilts = reserved(truth.increments.len() + 1)?;
        readings.tilts.push(InFrame::from_components(making.tilt()));
        for (moment, truth) in track.moments().zip(&truth.increments) {
            let reading = making.read(&moment, truth);
            readings.increments.push(reading.increments);
            readings.angle_errors.push(reading.angle_error);
            readings.tilts.push(InFrame::from_components(reading.tilt));
        }
        if readings.tilts.iter().all(|tilt| *tilt == InFrame::zeros()) {
            readings.tilts = Vec::new();
        }
        Ok(readings)
    }

    fn track(&self, truth: &TrueRun) -> Result<Track, ScenarioError> {
        let n_samples = truth.times.len();
        let (mut times, mut intervals) = (reserved(n_samples)?, reserved(n_samples)?);
        let mut angles = reserved(n_samples + 1)?;
        times.extend_from_slice(&truth.times);
        intervals.resize(n_samples, self.interval);
        angles.push(0.0);
        angles.extend_from_slice(&truth.angles);
        let surroundings = Surroundings::new(self.station, self.nav_from_table);
        Ok(Track::new(surroundings, times, intervals, angles, truth.temperature.clone()))
    }
}
