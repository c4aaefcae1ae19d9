//! PSINS text logs (‹psins›): three rows of header, then six numbers per sample.

use std::io::Write;

use rins_frames::units::{ARCSEC, DEG};
use rins_motion::Recording;

use super::exact::{inverted, quotient};
use super::failure::Failure;
use super::signals::channel;
use crate::error::WriteProblem;
use crate::log::Loaded;

/// The maximum difference of a time from even steps, in intervals.
const EVEN_WITHIN: f64 = 1e-6;

/// The minimum and maximum number of binary fraction digits of the increments' unit, if rins chooses it.
const BITS: std::ops::RangeInclusive<i32> = 10..=40;

/// Writes increments as multiples of the header's scales.
///
/// If the log has scales of which every increment is an integer multiple, they are kept. Otherwise
/// the scale is a power of two, of which every double is a multiple by a double.
pub(super) fn write(loaded: &Loaded, out: &mut dyn Write) -> Result<(), Failure> {
    let recording = &loaded.recording;
    let header = loaded.psins_header;
    let (Some(first), Some(time)) = (recording.increments.first(), recording.times.first()) else {
        return Ok(());
    };
    let interval = header.map_or(first.interval, |header| header.interval);
    let start = header.map_or(time - interval, |header| header.start);
    refuse_uneven(recording, start, interval)?;
    let gravity = header.map_or(loaded.station.gravity, |header| header.gravity);
    if !(9.7..=9.9).contains(&gravity) {
        let why = "its unit ug is one of a gravity from 9.7 to 9.9 m/s^2";
        return Err(WriteProblem::TooMuch { what: "this gravity", format: "psins", why }.into());
    }
    let micro = 1e-6 * gravity;
    let known = |place: usize| match (header, place) {
        (Some(header), 0..3) => header.angle_scale.as_slice().to_vec(),
        (Some(header), _) => header.velocity_scale.as_slice().to_vec(),
        (None, _) => Vec::new(),
    };
    let mut units = [(1.0, 1.0, false); 6];
    for (place, unit) in units.iter_mut().enumerate() {
        let factor = if place < 3 { ARCSEC } else { micro };
        *unit = scale(recording, place, &known(place), factor);
    }
    let site = loaded.station.site;
    let angles = header.map(|header| header.attitude).unwrap_or_default();
    let velocity = header.map(|header| header.velocity).unwrap_or_default();
    writeln!(out, "% PSINS-format SIMU log file, written by rins.")?;
    writeln!(
        out,
        "% 1: pitch, roll, yaw [deg], velocity east, north, up [m/s]: not known if zero."
    )?;
    writeln!(
        out,
        "% 2: latitude, longitude [deg], height [m], start [s], interval [ms], g [m/s^2]."
    )?;
    writeln!(
        out,
        "% 3: what one of each number is: three angles [arcsec], three velocities [ug s]."
    )?;
    writeln!(
        out,
        "% Then increments along right, front and up: three of angle, three of velocity."
    )?;
    let degrees = |angle: f64| quotient(angle, DEG);
    let rows = [
        [
            degrees(angles.pitch),
            degrees(angles.roll),
            degrees(angles.yaw),
            velocity.x,
            velocity.y,
            velocity.z,
        ],
        [
            degrees(site.latitude),
            degrees(site.longitude),
            site.height,
            start,
            inverted(interval, interval * 1e3, |number| number / 1e3).unwrap_or(interval * 1e3),
            gravity,
        ],
        units.map(|(written, ..)| written),
    ];
    for row in rows {
        writeln!(out, "{}", row.map(|number| number.to_string()).join(" "))?;
    }
    for sample in &recording.increments {
        let numbers = sample.angle.components().iter().chain(sample.velocity.components().iter());
        let row: Vec<String> = numbers
            .zip(units)
            .map(|(number, (_, scale, whole))| {
                let count = number / scale;
                if whole { format!("{count:.0}") } else { format!("{count:e}") }
            })
            .collect();
        writeln!(out, "{}", row.join(" "))?;
    }
    Ok(())
}

fn refuse_uneven(recording: &Recording, start: f64, interval: f64) -> Result<(), WriteProblem> {
    for (index, (time, sample)) in recording.times.iter().zip(&recording.increments).enumerate() {
        let even = start + (index + 1) as f64 * interval;
        let off = (time - even).abs().max((sample.interval - interval).abs());
        if off > EVEN_WITHIN * interval {
            return Err(WriteProblem::Uneven { sample: index + 1, off, interval });
        }
    }
    Ok(())
}

/// A scale as written, its value in SI units, and whether all increments are integer multiples.
fn scale(recording: &Recording, place: usize, known: &[f64], factor: f64) -> (f64, f64, bool) {
    for &scale in known {
        let whole = |number: f64| (number / scale).round() * scale;
        let written = inverted(scale, scale / factor, |written| written * factor);
        #[expect(clippy::float_cmp, reason = "a multiple is one to the last bit")]
        let fits = channel(recording, place).all(|number| whole(number) == number);
        if let Some(written) = written.filter(|_| fits) {
            return (written, scale, true);
        }
    }
    let power = BITS.map(|bits| 2.0_f64.powi(-bits)).find_map(|power| {
        let written = inverted(power, power / factor, |written| written * factor)?;
        Some((written, power, false))
    });
    power.unwrap_or((1.0, factor, false))
}
