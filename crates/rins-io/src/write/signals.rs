//! The signals of a recording by name.

use rins_motion::Recording;

/// The names of the IMU's increments.
pub(crate) const COLUMNS: [&str; 6] =
    ["gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"];

/// The signals of a recording other than the IMU's, with their names.
pub(super) fn others(recording: &Recording) -> Vec<(&'static str, &[f64])> {
    let all = [
        ("table_angle", &recording.table_angle),
        ("table_rate", &recording.table_rate),
        ("temperature", &recording.temperature),
    ];
    all.into_iter().filter_map(|(name, list)| Some((name, list.as_deref()?))).collect()
}

/// The increments of one channel, in the order of [`COLUMNS`].
pub(super) fn channel(recording: &Recording, channel: usize) -> impl Iterator<Item = f64> {
    recording.increments.iter().map(move |sample| match channel {
        0..3 => sample.angle.components()[channel],
        _ => sample.velocity.components()[channel - 3],
    })
}
