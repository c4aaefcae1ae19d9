//! Turns to and fro, where gyros are too noisy or a log too restless for its quietest parts to show them.

use std::ops::Range;

use nalgebra::Vector3;

use super::cells::Cells;
use super::interval::NotStatic;
use super::options::StaticOptions;

/// The probability that white noise makes a static interval look like one in which the IMU turns to and fro.
const BY_CHANCE: f64 = 1e-6;

/// Whether over some cells the gyros, their mean removed, turn farther than a base sways or a bias drifts, and farther than
/// white noise makes them.
///
/// How strong that is, neighbouring cells say: motion hardly makes these differ. Where a log never stands still, its
/// quietest parts would call motion noise.
pub(super) fn wanders(
    cells: &Cells,
    run: &Range<usize>,
    options: &StaticOptions,
) -> Option<NotStatic> {
    let lasting = cells.duration(run);
    // A rate that drifts by so much over a time turns by an eighth of their product beside its mean.
    let allowed = options.largest_sway + options.largest_rate_change() * lasting / 8.0;
    let farthest = cells.farthest(run);
    let angle = farthest.max();
    if angle <= allowed {
        return None;
    }
    // The farthest point of a Brownian bridge (Kolmogorov).
    let by_chance = (-0.5 * (0.5 * BY_CHANCE).ln()).sqrt();
    let white: Vector3<f64> = cells.neighbours(run) * (lasting / (run.len() as f64).sqrt());
    (0..3)
        .any(|axis| farthest[axis] > allowed && farthest[axis] > by_chance * white[axis])
        .then_some(NotStatic::Rotates { angle })
}

impl Cells {
    /// How far each gyro turns within some cells, its mean over them removed \[rad\].
    fn farthest(&self, cells: &Range<usize>) -> Vector3<f64> {
        let rate = self.rate(cells);
        (cells.start + 1..cells.end).fold(Vector3::zeros(), |most: Vector3<f64>, end| {
            let turned = self.rate(&(cells.start..end)) - rate;
            most.sup(&(turned * self.duration(&(cells.start..end))).abs())
        })
    }

    /// The 1σ of white noise by which the mean rates of neighbouring cells differ \[rad/s\].
    fn neighbours(&self, cells: &Range<usize>) -> Vector3<f64> {
        let rate = |cell: usize| self.rate(&(cell..cell + 1));
        let squares = (cells.start + 1..cells.end)
            .map(|cell| (rate(cell) - rate(cell - 1)).map(|step| step * step))
            .sum::<Vector3<f64>>();
        (squares / (2.0 * (cells.len() - 1).max(1) as f64)).map(f64::sqrt)
    }
}
