//! Text of the EuRoC data set: nanoseconds, angular rates, specific forces (‹burri2016›).

use std::io::Write;

use super::exact::quotient;
use super::failure::Failure;
use crate::error::WriteProblem;
use crate::log::Loaded;

const HEADER: &str = "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],\
                      a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";

/// The largest time whose nanoseconds fit in 63 bits \[s\].
const LARGEST: f64 = 9e9;

/// Writes stamps of the ends of intervals, and mean rates over the intervals.
pub(super) fn write(loaded: &Loaded, out: &mut dyn Write) -> Result<(), Failure> {
    let origin = loaded.summary.time_origin;
    let last = loaded.recording.times.last().copied().unwrap_or_default();
    if (origin + last).abs() > LARGEST {
        let why = "it counts nanoseconds, of which 63 bits hold 292 years";
        return Err(WriteProblem::TooMuch { what: "the time", format: "euroc", why }.into());
    }
    writeln!(out, "{HEADER}")?;
    for (time, increments) in loaded.recording.times.iter().zip(&loaded.recording.increments) {
        // The origin is an integer second.
        #[expect(clippy::cast_possible_truncation, reason = "both are below 2⁶³")]
        let stamp = origin as i64 * 1_000_000_000 + (time * 1e9).round() as i64;
        write!(out, "{stamp}")?;
        for triad in [increments.angle.components(), increments.velocity.components()] {
            for number in triad {
                write!(out, ",{:e}", quotient(*number, increments.interval))?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
