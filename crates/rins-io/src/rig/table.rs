//! The commanded motion of the table: `[table]`.

use rins_motion::{Profile, Segment};

use super::table_columns::sense;
use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::Section;

/// The maximum number of segments of a profile.
const MOST_SEGMENTS: usize = 100_000;

/// The data of the table that are not in the log.
#[derive(Clone, Debug, PartialEq)]
pub struct TableSpec {
    /// The commanded motion; it begins with the log.
    pub profile: Option<Profile>,
    /// The segments of the profile.
    pub segments: Vec<Segment>,
    /// The factor that was applied to the profile's rates: -1 for a table that counts opposite to the body's
    /// direction of rotation, otherwise 1.
    pub sense: f64,
    /// The table's acceleration at each change of rate \[rad/s²\]; `None` if the commanded rate changes in a step.
    pub acceleration: Option<f64>,
    /// The wobble: the standard deviation of the direction of the axis during rotation \[rad\].
    pub wobble: Option<f64>,
}

pub(super) fn read(root: &Section<'_>) -> Result<Option<TableSpec>, IoError> {
    let Some(table) = root.section("table", &["profile", "sense", "acceleration", "wobble"])?
    else {
        return Ok(None);
    };
    let acceleration = table.quantity("acceleration", &kinds::TABLE_ACCELERATION)?;
    let sense = sense(&table)?;
    let mut segments = Vec::new();
    let profile = table.tables("profile", &["rate", "duration"])?;
    for segment in profile.iter().flatten().take(MOST_SEGMENTS + 1) {
        let rate = segment.require_quantity("rate", &kinds::TABLE_RATE)?;
        segments.push(Segment {
            // Avoids a negative zero.
            rate: if rate == 0.0 { 0.0 } else { sense * rate },
            duration: segment.require_quantity("duration", &kinds::DURATION)?,
        });
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
    let wobble = table.quantity("wobble", &kinds::ANGLE_SIGMA)?;
    Ok(Some(TableSpec { profile, segments, sense, acceleration, wobble }))
}
