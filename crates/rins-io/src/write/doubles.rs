//! PSINS rows of seven doubles: angle increments, velocity increments, time (‹psins›).

use std::io::{self, Write};

use rins_motion::Recording;

/// Writes `[wm vm t]` in rad, m/s and s, along right, front and up.
pub(super) fn write(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    for (time, increments) in recording.times.iter().zip(&recording.increments) {
        let (angle, velocity) = (increments.angle.components(), increments.velocity.components());
        for number in angle.iter().chain(velocity.iter()).chain([time]) {
            out.write_all(&number.to_le_bytes())?;
        }
    }
    Ok(())
}
