//! Runs from which no estimate would mean anything.

use rins_frames::units::DEG;
use rins_io::{Loaded, shown};

use crate::check::inspected;

/// A table that turns by less in all \[rad\] does not rotate.
const LEAST_TURN: f64 = 1.0 * DEG;

/// Refuses a run whose table does not turn: it does not show the gyro errors along the spin axis.
pub(super) fn refuse_standing(loaded: &Loaded) -> anyhow::Result<()> {
    let recording = &loaded.recording;
    let turned = match (&recording.table_angle, &recording.table_rate) {
        (Some(angle), _) => {
            let most = angle.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            most - angle.iter().copied().fold(f64::INFINITY, f64::min)
        }
        (None, Some(rate)) => {
            rate.iter().zip(&recording.increments).map(|(rate, s)| rate.abs() * s.interval).sum()
        }
        (None, None) => return Ok(()),
    };
    anyhow::ensure!(
        turned > LEAST_TURN,
        "{}: the table turns by {:.3} deg in all, the gyro about the axis of rotation by {:.2}: gyro errors along that axis cannot be observed",
        shown(&loaded.rig.log.path),
        turned / DEG,
        inspected(loaded).turns * 360.0
    );
    Ok(())
}
