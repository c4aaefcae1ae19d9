//! The static intervals of a table whose angle or rate is known.

use std::ops::Range;

use rins_frames::units::DEG_PER_SECOND;

use super::cells::Cells;
use rins_motion::Recording;

/// The rate below which a table is static \[rad/s\]: 7.2″/s, half the Earth's rate, and seven sigma of the error of a rate
/// over one second due to an encoder's noise of 2″ at 50 Hz.
const SLOWEST: f64 = 0.002 * DEG_PER_SECOND;

/// The window over which the rate is calculated from an angle \[s\].
const WINDOW: f64 = 1.0;

/// The cells in which the table is static; `None` if its motion is unknown.
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

/// The mean slope of equally spaced readings: the mean of the last third minus that of the first third.
///
/// A difference of two readings would contain the encoder's noise without averaging.
fn slope(angle: &[f64], duration: f64) -> f64 {
    let third = (angle.len() / 3).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let apart = duration * (angle.len() - third) as f64 / angle.len() as f64;
    let change = mean(&angle[angle.len() - third..]) - mean(&angle[..third]);
    if apart > 0.0 { change / apart } else { 0.0 }
}
