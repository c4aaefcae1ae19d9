//! Rotations forth and back if gyros are too noisy, or a log has too much motion, for its quietest parts to reveal them.

use std::ops::Range;

use nalgebra::Vector3;

use super::cells::Cells;
use super::interval::NotStatic;
use super::options::StaticOptions;

/// The probability that white noise makes a static interval resemble a rotation forth and back.
const BY_CHANCE: f64 = 1e-6;

/// Whether the angles of the gyros over these cells, after removal of the mean rate, exceed the sway of a base, the drift of
/// a bias, and the effect of white noise.
///
/// The white noise is estimated from successive cells, whose differences motion hardly affects. If a log is never static, its
/// quietest parts would treat motion as noise.
pub(super) fn wanders(
    cells: &Cells,
    run: &Range<usize>,
    options: &StaticOptions,
) -> Option<NotStatic> {
    let lasting = cells.duration(run);
    // A bias that drifts by this rate over a duration changes the angle about its mean by an eighth of their product.
    let allowed = options.largest_sway + options.largest_rate_change() * lasting / 8.0;
    let farthest = cells.farthest(run);
    let angle = farthest.max();
    if angle <= allowed {
        return None;
    }
    // The maximum of a Brownian bridge (Kolmogorov).
    let by_chance = (-0.5 * (0.5 * BY_CHANCE).ln()).sqrt();
    let white: Vector3<f64> = cells.neighbours(run) * (lasting / (run.len() as f64).sqrt());
    (0..3)
        .any(|axis| farthest[axis] > allowed && farthest[axis] > by_chance * white[axis])
        .then_some(NotStatic::Rotates { angle })
}

impl Cells {
    /// The largest angle of each gyro within these cells, after removal of its mean rate \[rad\].
    fn farthest(&self, cells: &Range<usize>) -> Vector3<f64> {
        let rate = self.rate(cells);
        (cells.start + 1..cells.end).fold(Vector3::zeros(), |most: Vector3<f64>, end| {
            let turned = self.rate(&(cells.start..end)) - rate;
            most.sup(&(turned * self.duration(&(cells.start..end))).abs())
        })
    }

    /// The 1σ of white noise from the differences of successive cells' mean rates \[rad/s\].
    fn neighbours(&self, cells: &Range<usize>) -> Vector3<f64> {
        let rate = |cell: usize| self.rate(&(cell..cell + 1));
        let squares = (cells.start + 1..cells.end)
            .map(|cell| (rate(cell) - rate(cell - 1)).map(|step| step * step))
            .sum::<Vector3<f64>>();
        (squares / (2.0 * (cells.len() - 1).max(1) as f64)).map(f64::sqrt)
    }
}
