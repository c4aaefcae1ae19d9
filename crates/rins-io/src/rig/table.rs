//! The commanded motion of the table: `[table]`.

use rins_motion::{Profile, Segment};

use super::table_columns::sense;
use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::Section;

/// The maximum number of segments of a profile.
const MOST_SEGMENTS: usize = 100_000;

/// A rotation about the spin axis of which the total angle is known, but not the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedRotation {
    /// The time at which it is known to begin \[s\].
    pub start: f64,
    /// The time at which it is known to have ended \[s\].
    pub end: f64,
    /// The angle \[rad\].
    pub angle: f64,
    /// 1σ of the angle \[rad\].
    pub sigma: f64,
    /// Whether the angle is the difference of two readings, at the start and at the end.
    pub read: bool,
}

/// The data of the table that are not in the log.
#[derive(Clone, Debug, PartialEq)]
pub struct TableSpec {
    /// The commanded motion; it begins with the log.
    pub profile: Option<Profile>,
    /// The segments of the profile.
    pub segments: Vec<Segment>,
    /// The rotations whose angles are stated instead of rates, with times from the beginning of the log. There is then no profile.
    pub turns: Vec<StatedRotation>,
    /// The factor that was applied to the profile's rates: -1 for a table that counts opposite to the body's
    /// direction of rotation, otherwise 1.
    pub sense: f64,
    /// The table's acceleration at each change of rate \[rad/s²\]; `None` if the commanded rate changes in a step.
    pub acceleration: Option<f64>,
    /// The wobble: the standard deviation of the direction of the axis during rotation \[rad\].
    pub wobble: Option<f64>,
}

/// The keys of `[table]`.
pub(super) const KEYS: [&str; 7] = [
    "profile",
    "sense",
    "acceleration",
    "wobble",
    "angle_sigma",
    "rate_accuracy",
    "angle_accuracy",
];

pub(super) fn read(root: &Section<'_>) -> Result<Option<TableSpec>, IoError> {
    let Some(table) = root.section("table", &KEYS)? else { return Ok(None) };
    let acceleration = table.quantity("acceleration", &kinds::TABLE_ACCELERATION)?;
    let sense = sense(&table)?;
    let wobble = table.quantity("wobble", &kinds::ANGLE_SIGMA)?;
    let mut segments = Vec::new();
    let profile = table.tables("profile", &["rate", "angle", "duration"])?;
    if let Some(first) = profile.iter().flatten().find(|segment| segment.has("angle")) {
        if table.has("acceleration") {
            return Err(table.conflict("acceleration", "a rotation by an angle states no motion"));
        }
        let turns = turns(&table, profile.iter().flatten(), sense)?;
        if turns.is_empty() {
            return Err(first.not_allowed("angle", "an angle other than zero"));
        }
        return Ok(Some(TableSpec { profile: None, segments, turns, sense, acceleration, wobble }));
    }
    if table.has("angle_sigma") {
        return Err(table.conflict("angle_sigma", "the profile states no angles"));
    }
    for segment in profile.iter().flatten().take(MOST_SEGMENTS + 1) {
        let Segment { rate, duration } = self::segment(segment)?;
        // Avoids a negative zero.
        segments.push(Segment { rate: if rate == 0.0 { 0.0 } else { sense * rate }, duration });
    }
    if segments.len() > MOST_SEGMENTS {
        return Err(table.conflict("profile", format!("more than {MOST_SEGMENTS} segments")));
    }
    let profile = match profile {
        Some(_) => Some(
            Profile::new(&segments, acceleration)
                .map_err(|error| table.conflict("profile", error.to_string()))?,
        ),
        None if sense < 0.0 => {
            return Err(table.conflict("sense", "it needs a profile"));
        }
        None => None,
    };
    Ok(Some(TableSpec { profile, segments, turns: Vec::new(), sense, acceleration, wobble }))
}

/// A segment of a profile: a rate, and how long it lasts.
pub(crate) fn segment(segment: &Section<'_>) -> Result<Segment, IoError> {
    let rate = segment.require_quantity("rate", &kinds::TABLE_RATE)?;
    Ok(Segment { rate, duration: segment.require_quantity("duration", &kinds::DURATION)? })
}

/// The rotations of a profile of angles, between which the table rests.
fn turns<'s>(
    table: &Section<'_>,
    profile: impl Iterator<Item = &'s Section<'s>>,
    sense: f64,
) -> Result<Vec<StatedRotation>, IoError> {
    let sigma = table.quantity("angle_sigma", &kinds::ANGLE_SIGMA)?.unwrap_or(0.0);
    let mut turns = Vec::new();
    let mut start = 0.0;
    for segment in profile {
        let end = start + segment.require_quantity("duration", &kinds::DURATION)?;
        let rate = segment.quantity("rate", &kinds::TABLE_RATE)?;
        match (segment.quantity("angle", &kinds::TOTAL_ANGLE)?, rate) {
            (Some(_), Some(_)) => return Err(segment.conflict("angle", "a rate is stated too")),
            (None, Some(rate)) if rate != 0.0 => {
                let reason = "a profile with angles has rests between them, whose rate is zero";
                return Err(segment.conflict("rate", reason));
            }
            (Some(angle), None) if angle != 0.0 => {
                turns.push(StatedRotation { start, end, angle: sense * angle, sigma, read: false });
            }
            (None, None) => {
                return Err(segment.missing("angle", r#"an angle such as "720 deg", or a rate"#));
            }
            _ => {}
        }
        start = end;
    }
    Ok(turns)
}
