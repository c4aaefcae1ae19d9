//! A scenario becomes a recording.

use rins_frames::{Body, Dcm, InFrame, Nav, Table};
use rins_imu::{ImuError, Sensor, Span};
use rins_motion::{Recording, Station, TrueMotion};

use crate::check::ScenarioError;
use crate::scenario::{Scenario, TableRecord};

/// A simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// What a log of it holds.
    pub recording: Recording,
    /// What it does not hold.
    pub truth: Truth,
}

/// What is true of a simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Where the table stands.
    pub station: Station,
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The IMU's bias, scale and misalignment; wandering biases are not in it.
    pub imu_error: ImuError,
    /// The velocity at time zero, and, since the table does not travel, ever after \[m/s\].
    pub initial_velocity: InFrame<Nav>,
    /// The table angle at the end of each interval \[rad\]; at time zero it is zero.
    pub table_angle: Vec<f64>,
}

impl Truth {
    /// The attitude of the body at time zero.
    pub fn initial_attitude(&self) -> Dcm<Nav, Body> {
        self.attitude_at(0.0)
    }

    /// The attitude of the body at the end of an interval, if the run has it.
    pub fn attitude(&self, sample: usize) -> Option<Dcm<Nav, Body>> {
        self.table_angle.get(sample).map(|&angle| self.attitude_at(angle))
    }

    fn attitude_at(&self, angle: f64) -> Dcm<Nav, Body> {
        self.nav_from_table * Dcm::<Table, Body>::about_z(angle)
    }
}

/// The run that `scenario` describes.
///
/// Each sample is true motion, then eq. (1), then noise, then the resolution; the table's angle is
/// read by its encoder. The gyros, accelerometers and the encoder have random numbers of their own, so
/// that none of them changes with what the others are.
///
/// # Errors
/// [`ScenarioError`] if a figure is impossible, or the run is empty or too long.
pub fn simulate(scenario: &Scenario) -> Result<Simulated, ScenarioError> {
    let n_samples = scenario.check()?;
    let Scenario { interval, station, nav_from_table, imu_error, table, seed, .. } = *scenario;
    let profile = scenario.profile.clone();
    let duration = profile.duration();
    let span = Span { interval, duration: duration.max(interval) };
    let mut noise = scenario.noise.as_ref().map(|noise| noise.source(&span, seed)).transpose()?;
    let mut encoder_noise = seed.stream(Sensor::Encoder);

    let mut times = reserved(n_samples)?;
    let mut increments = reserved(n_samples)?;
    let mut table_angle = reserved(n_samples)?;
    let mut of_table = reserved(if table == TableRecord::Nothing { 0 } else { n_samples })?;
    let motion = TrueMotion { station, nav_from_table, profile };
    for sample in motion.samples(interval) {
        let measured = imu_error.measure(&sample.increments);
        times.push(sample.time);
        increments.push(noise.as_mut().map_or(measured, |noise| noise.corrupt(&measured)));
        table_angle.push(sample.angle);
        match table {
            TableRecord::Angle(encoder) => {
                of_table.push(encoder.reading(sample.angle, &mut encoder_noise));
            }
            TableRecord::CommandedRate => of_table.push(sample.mean_rate),
            TableRecord::Nothing => {}
        }
    }
    if times.is_empty() {
        return Err(ScenarioError::TooShort { duration, interval });
    }
    let temperature = scenario.temperature.map(|value| vec![value; times.len()]);
    let (angle_read, rate_commanded) = match table {
        TableRecord::Angle(_) => (Some(of_table), None),
        TableRecord::CommandedRate => (None, Some(of_table)),
        TableRecord::Nothing => (None, None),
    };
    Ok(Simulated {
        recording: Recording {
            times,
            increments,
            table_angle: angle_read,
            table_rate: rate_commanded,
            temperature,
        },
        truth: Truth {
            station,
            nav_from_table,
            imu_error,
            initial_velocity: InFrame::zeros(),
            table_angle,
        },
    })
}

/// An empty list with room for `n_samples`.
fn reserved<T>(n_samples: usize) -> Result<Vec<T>, ScenarioError> {
    let mut list = Vec::new();
    match list.try_reserve_exact(n_samples) {
        Ok(()) => Ok(list),
        Err(_) => Err(ScenarioError::OutOfMemory { n_samples }),
    }
}
