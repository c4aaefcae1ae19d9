//! When a table whose angle or rate is known stands.

use std::ops::Range;

use rins_frames::units::DEG_PER_SECOND;

use super::cells::Cells;
use rins_motion::Recording;

/// A table that turns more slowly than this \[rad/s\] stands still: 7.2″ a second, half the Earth's
/// rate, and seven sigma of what an encoder's noise of 2″ at 50 Hz feigns over a second.
const SLOWEST: f64 = 0.002 * DEG_PER_SECOND;

/// The slope of an angle is taken over this \[s\].
const WINDOW: f64 = 1.0;

/// Which cells the table stands in; `None` if nothing says how it turns.
pub(super) fn stands(recording: &Recording, cells: &Cells) -> Option<Vec<bool>> {
    if let Some(rates) = &recording.table_rate {
        let slow =
            |span: &Range<usize>| rates[span.clone()].iter().all(|rate| rate.abs() < SLOWEST);
        return Some(cells.cells.iter().map(|cell| slow(&cell.span)).collect());
    }
    let angles = recording.table_angle.as_ref()?;
    let mut stands = vec![false; cells.len()];
    let mut end = 0;
    for start in 0..cells.len() {
        while end < cells.len()
            && (end <= start || cells.duration(&(start..end)) < WINDOW * (1.0 - 1e-9))
        {
            end += 1;
        }
        let window = start..end;
        let whole = cells.duration(&window) >= WINDOW * (1.0 - 1e-9);
        if (whole || start == 0)
            && slope(&angles[cells.samples(&window)], cells.duration(&window)).abs() < SLOWEST
        {
            stands[window].fill(true);
        }
        if !whole {
            break;
        }
    }
    Some(stands)
}

/// The mean slope of equally spaced readings: the last third's mean less the first third's.
///
/// A difference of two readings would carry the encoder's noise in full.
fn slope(angle: &[f64], duration: f64) -> f64 {
    let third = (angle.len() / 3).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let apart = duration * (angle.len() - third) as f64 / angle.len() as f64;
    let change = mean(&angle[angle.len() - third..]) - mean(&angle[..third]);
    if apart > 0.0 { change / apart } else { 0.0 }
}
