//! The static intervals of a table whose angle or rate is known.

use std::ops::Range;

use rins_frames::units::DEG_PER_SECOND;

use super::cells::Cells;
use rins_motion::Recording;

/// The rate below which a table is static \[rad/s\]: 7.2″/s, half the Earth's rate, and seven sigma of the error of a rate
/// over one second due to an encoder's noise of 2″ at 50 Hz.
const SLOWEST: f64 = 0.002 * DEG_PER_SECOND;

/// A table is not static if its rate exceeds this number of sigmas of the encoder's noise.
const SIGMAS: f64 = 4.0;

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
        if whole || start == 0 {
            let (slope, sigma) = slope(&angles[cells.samples(&window)], cells.duration(&window));
            if slope.abs() < SLOWEST.max(SIGMAS * sigma) {
                stands[window].fill(true);
            }
        }
        if !whole {
            break;
        }
    }
    Some(stands)
}

/// The mean slope of equally spaced readings, the mean of the last third minus that of the first third, and its 1σ by the noise
/// of the readings, which their second differences show.
///
/// A difference of two readings would contain the encoder's noise without averaging.
fn slope(angle: &[f64], duration: f64) -> (f64, f64) {
    let third = (angle.len() / 3).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let apart = duration * (angle.len() - third) as f64 / angle.len() as f64;
    let change = mean(&angle[angle.len() - third..]) - mean(&angle[..third]);
    let second = |three: &[f64]| (three[2] - 2.0 * three[1] + three[0]).powi(2);
    let count = angle.len().saturating_sub(2).max(1) as f64;
    let variance = angle.windows(3).map(second).sum::<f64>() / (6.0 * count);
    let sigma = (2.0 * variance / third as f64).sqrt();
    if apart > 0.0 { (change / apart, sigma / apart) } else { (0.0, 0.0) }
}
