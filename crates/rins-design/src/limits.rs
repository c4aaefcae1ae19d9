//! The limits of a table.

use rins_frames::units::DEG_PER_SECOND;
use rins_motion::Segment;

/// The rate of a table without stated limits \[rad/s\].
pub const TYPICAL_RATE: f64 = 10.0 * DEG_PER_SECOND;

/// The angular acceleration of a table without stated limits \[rad/s²\].
pub const TYPICAL_ACCELERATION: f64 = 5.0 * DEG_PER_SECOND;

/// The limits of a table, and the available time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The largest rate \[rad/s\].
    pub rate: f64,
    /// The angular acceleration between two rates \[rad/s²\].
    pub acceleration: f64,
    /// The longest duration of all runs together \[s\].
    pub duration: f64,
    /// The largest number of directions of the axis.
    pub directions: usize,
}

/// The segment that turns a table at rest by an angle \[rad\], if the following one is static; none if the angle is zero.
pub(crate) fn transit(angle: f64, limits: &Limits) -> Vec<Segment> {
    if angle.abs() < 1e-9 {
        return Vec::new();
    }
    // The ramp at the end is part of the next segment: rate times duration is the angle.
    let rate = limits.rate.min((angle.abs() * limits.acceleration).sqrt());
    vec![Segment { rate: rate.copysign(angle), duration: angle.abs() / rate }]
}
