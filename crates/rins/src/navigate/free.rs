//! The initial attitude and the solution of free navigation.

use anyhow::Context;
use rins_calibration::{FreeNavigation, navigate_freely, table_angles};
use rins_frames::{Body, Dcm, Nav, Table};
use rins_imu::{Compensation, ImuError, TriadError};
use rins_io::{Loaded, shown};
use rins_motion::Recording;
use rins_report::number::decimal;
use rins_terms::{Model, Surroundings, compensated};

use crate::align::found;

/// The initial conditions of free navigation.
#[derive(Debug)]
pub(super) struct Start {
    pub(super) nav_from_table: Dcm<Nav, Table>,
    /// The gyro biases from the static interval, if it also gives the attitude.
    pub(super) gyro_bias: Option<ImuError>,
    pub(super) source: String,
    /// The navigated samples: the whole run or, if there is no table angle to relate earlier attitudes to the static interval,
    /// the samples from its start on.
    pub(super) recording: Recording,
    /// The table angle before each sample and after the last.
    angles: Vec<f64>,
}

impl Start {
    /// The navigated time \[s\].
    pub(super) fn duration(&self) -> f64 {
        self.recording.increments.iter().map(|sample| sample.interval).sum()
    }
}

pub(super) fn start(loaded: &Loaded) -> anyhow::Result<Start> {
    let recording = &loaded.recording;
    let angles =
        table_angles(recording, latency(loaded)).unwrap_or_else(|| vec![0.0; recording.len() + 1]);
    if let Some(attitude) = loaded.rig.attitude {
        return Ok(Start {
            nav_from_table: attitude.angles.dcm(),
            gyro_bias: None,
            source: "the attitude that the rig gives".into(),
            recording: recording.clone(),
            angles,
        });
    }
    let found = found(loaded).with_context(|| shown(&loaded.rig.log.path))?;
    let first = if has_table(recording) { 0 } else { found.span.start };
    let angle = angles[found.span.start];
    let table_from_body = Dcm::<Table, Body>::about_z(angle);
    let gyro =
        TriadError { bias: *found.residual.angular_rate.components(), ..TriadError::default() };
    Ok(Start {
        nav_from_table: found.nav_from_body * table_from_body.inverse(),
        gyro_bias: found.north_found().then(|| ImuError { gyro, ..ImuError::default() }),
        source: format!(
            "the attitude{} found over the static interval from {} s to {} s, which is part of the navigated span",
            if found.north_found() { " and the gyro bias" } else { " (yaw arbitrary)" },
            decimal(found.start, 0),
            decimal(recording.times[found.span.end - 1], 0)
        ),
        recording: recording.slice(first, recording.len()),
        angles: angles[first..].to_vec(),
    })
}

/// The attitude of a run's axis at table angle zero: given, or found from a static interval.
pub(crate) fn axis_attitude(loaded: &Loaded) -> anyhow::Result<Dcm<Nav, Table>> {
    Ok(start(loaded)?.nav_from_table)
}

/// Whether a table angle or rate is recorded.
pub(super) const fn has_table(recording: &Recording) -> bool {
    recording.table_angle.is_some() || recording.table_rate.is_some()
}

pub(super) fn navigated(
    loaded: &Loaded,
    start: &Start,
    compensation: Option<&Compensation>,
) -> FreeNavigation {
    navigate_freely(
        &start.recording,
        &start.angles,
        start.nav_from_table,
        &loaded.station,
        compensation,
    )
}

/// Navigates with the readings that a calibration has compensated.
pub(super) fn undone(
    loaded: &Loaded,
    start: &Start,
    (error, terms): (ImuError, Model),
) -> anyhow::Result<FreeNavigation> {
    if terms.terms.is_empty() {
        return Ok(navigated(loaded, start, Some(&error.compensation()?)));
    }
    // Terms may depend on the time since the start of the run, so the whole run is compensated.
    let around = Surroundings::new(loaded.station, start.nav_from_table);
    let mut model = Model::from(&error);
    model.terms.extend(terms.terms);
    let whole = compensated(&model, around, &loaded.recording)?;
    let first = whole.len() - start.recording.len();
    let angles = table_angles(&whole, latency(loaded))
        .map_or_else(|| start.angles.clone(), |angles| angles[first..].to_vec());
    let recording = whole.slice(first, whole.len());
    let nav_from_table = start.nav_from_table;
    Ok(navigate_freely(&recording, &angles, nav_from_table, &loaded.station, None))
}

/// The latency of the table angle \[s\].
fn latency(loaded: &Loaded) -> f64 {
    loaded.rig.log.table_angle().and_then(|angle| angle.latency).unwrap_or_default()
}
