//! Recordings as CSV.

use std::io::{self, Write};

use rins_motion::Recording;

use super::signals::{COLUMNS, others};

/// Writes `recording` as CSV, in SI units and radians.
///
/// The columns are `time`, the increments `gyro_x` … `accel_z`, and `table_angle`, `table_rate`
/// and `temperature` if the recording has them. Every number has the smallest number of digits
/// that is parsed to the same double.
///
/// # Errors
/// The errors of `out`.
pub fn write_recording(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    let others = others(recording);
    write!(out, "time,{}", COLUMNS.join(","))?;
    for (name, _) in &others {
        write!(out, ",{name}")?;
    }
    writeln!(out)?;
    for (sample, (time, increments)) in
        recording.times.iter().zip(&recording.increments).enumerate()
    {
        write!(out, "{time}")?;
        let (angle, velocity) = (increments.angle.components(), increments.velocity.components());
        for number in angle.iter().chain(velocity.iter()) {
            write!(out, ",{number:e}")?;
        }
        for (_, list) in &others {
            write!(out, ",{:e}", list[sample])?;
        }
        writeln!(out)?;
    }
    Ok(())
}
