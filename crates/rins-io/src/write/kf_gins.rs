//! KF-GINS text: time, angle and velocity increments along front, right and down (‹kf-gins›).

use std::io::{self, Write};

use rins_motion::Recording;

use crate::rig::Axes;

/// Writes seven columns separated by blanks, with the smallest number of digits that preserves the value.
pub(super) fn write(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    for (time, increments) in recording.times.iter().zip(&recording.increments) {
        write!(out, "{time}")?;
        for triad in [increments.angle.components(), increments.velocity.components()] {
            // The assignment of axes is its own inverse.
            for number in Axes::FRONT_RIGHT_DOWN.apply(triad).iter() {
                write!(out, " {number:e}")?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
