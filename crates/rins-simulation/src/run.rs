//! Simulation of a scenario to a recording.

use rins_frames::{Body, Dcm, InFrame, Nav, Table};
use rins_imu::{ImuError, ImuNoise, Sensor, Span};
use rins_motion::{Recording, Station, TrueMotion};
use rins_terms::Model;

use crate::check::ScenarioError;
use crate::readings::{TrueRun, reserved};
use crate::scenario::{Encoder, Scenario, TableRecord};

/// A simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// The recording, as in a log.
    pub recording: Recording,
    /// The truth, which a log does not contain.
    pub truth: Truth,
}

/// The truth of a simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// The site of the table.
    pub station: Station,
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The IMU's bias, scale error and misalignment, without random biases.
    pub imu_error: ImuError,
    /// The further effects.
    pub effects: Model,
    /// The velocity at time zero, which is constant because the table has a fixed position \[m/s\].
    pub initial_velocity: InFrame<Nav>,
    /// The table angle at the end of each interval \[rad\]; zero at time zero.
    pub table_angle: Vec<f64>,
    /// The rotation vector by which the table is tilted relative to the axis frame, at time zero and at the
    /// end of each interval \[rad\]; empty if there is no tilt.
    pub tilt: Vec<InFrame<Table>>,
}

impl Truth {
    /// The attitude of the body at time zero.
    pub fn initial_attitude(&self) -> Dcm<Nav, Body> {
        self.attitude_at(0.0, self.tilt.first())
    }

    /// The attitude of the body at the end of an interval; `None` if the run has no such sample.
    pub fn attitude(&self, sample: usize) -> Option<Dcm<Nav, Body>> {
        let angle = self.table_angle.get(sample)?;
        Some(self.attitude_at(*angle, self.tilt.get(sample + 1)))
    }

    fn attitude_at(&self, angle: f64, tilt: Option<&InFrame<Table>>) -> Dcm<Nav, Body> {
        let turned = Dcm::<Table, Body>::about_z(angle);
        match tilt {
            Some(tilt) => {
                let tilted = Dcm::<Table, Table>::from_rotation_vector(tilt.components());
                self.nav_from_table * (tilted * turned)
            }
            None => self.nav_from_table * turned,
        }
    }
}

/// Simulates the run of `scenario`.
///
/// Each sample is computed in the order true motion, eq. (1) and effects, noise, resolution; the table
/// angle comes from its encoder. Effects on the log are applied last. The gyros, the accelerometers and the encoder
/// have random numbers of their own, so that none of them changes with the settings of the others.
///
/// # Errors
/// [`ScenarioError`] if a quantity is invalid, an effect needs something that the run does not have, or the run is
/// empty or too long.
pub fn simulate(scenario: &Scenario) -> Result<Simulated, ScenarioError> {
    let n_samples = scenario.check()?;
    let Scenario { interval, station, nav_from_table, imu_error, table, seed, .. } = *scenario;
    let profile = scenario.profile.clone();
    let duration = profile.duration();

    let mut truth = TrueRun {
        times: reserved(n_samples)?,
        increments: reserved(n_samples)?,
        angles: reserved(n_samples)?,
        temperature: scenario.temperature.map(|_| reserved(n_samples)).transpose()?,
    };
    let mut mean_rates = reserved(if table == TableRecord::CommandedRate { n_samples } else { 0 })?;
    for sample in (TrueMotion { station, nav_from_table, profile }).samples(interval) {
        truth.times.push(sample.time);
        truth.increments.push(sample.increments);
        truth.angles.push(sample.angle);
        if let (Some(list), Some(profile)) = (&mut truth.temperature, scenario.temperature) {
            list.push(profile.at(sample.time));
        }
        if table == TableRecord::CommandedRate {
            mean_rates.push(sample.mean_rate);
        }
    }
    if truth.times.is_empty() {
        return Err(ScenarioError::TooShort { duration, interval });
    }

    let mut readings = scenario.readings(&truth)?;
    let noises = scenario.noises();
    if noises.imu != ImuNoise::default() {
        let span = Span { interval, duration: duration.max(interval) };
        let mut noise = noises.imu.source(&span, seed)?;
        for increments in &mut readings.increments {
            *increments = noise.corrupt(increments);
        }
    }
    let TrueRun { times, angles, temperature, .. } = truth;
    let (table_angle, table_rate) = match table {
        TableRecord::Angle(encoder) => {
            let encoder = Encoder { noise: noises.encoder, ..encoder };
            let mut stream = seed.stream(Sensor::Encoder);
            let mut read = reserved(n_samples)?;
            for (index, angle) in angles.iter().enumerate() {
                let error = readings.angle_errors.get(index).copied().unwrap_or(0.0);
                read.push(encoder.reading(angle + error, &mut stream));
            }
            (Some(read), None)
        }
        TableRecord::CommandedRate => (None, Some(mean_rates)),
        TableRecord::Nothing => (None, None),
    };
    let increments = readings.increments;
    let mut recording = Recording { times, increments, table_angle, table_rate, temperature };
    scenario.effects.distort(seed, &mut recording);
    let truth = Truth {
        station,
        nav_from_table,
        imu_error,
        effects: scenario.effects.clone(),
        initial_velocity: InFrame::zeros(),
        table_angle: angles,
        tilt: readings.tilts,
    };
    Ok(Simulated { recording, truth })
}
