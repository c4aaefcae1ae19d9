//! The changes of the mean rate within a quiet run of cells.

use std::ops::Range;

use super::cells::Cells;
use super::noise::Noise;
use super::options::StaticOptions;

/// The number of sigmas from which a mean has changed: of a million differences none exceeds it by chance.
pub(super) const SIGMAS: f64 = 6.0;

/// The parts of a run of cells with a constant mean rate.
///
/// The means of successive blocks are compared, with lengths from one cell to half the run. They may differ by noise, by the
/// angle of the base's sway during a block, and by the change of a bias.
pub(super) fn parts(
    cells: &Cells,
    run: Range<usize>,
    noise: &Noise,
    options: &StaticOptions,
) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let mut rest = vec![run];
    while let Some(run) = rest.pop() {
        match change(cells, &run, noise, options) {
            None => parts.push(run),
            Some(at) => {
                rest.push(at..run.end);
                rest.push(run.start..at);
            }
        }
    }
    parts
}

/// The place where the rate changes most beyond its limit; `None` if it does not.
fn change(
    cells: &Cells,
    run: &Range<usize>,
    noise: &Noise,
    options: &StaticOptions,
) -> Option<usize> {
    let mut most = (1.0, None);
    for (&block, sigma) in noise.blocks.iter().zip(&noise.gyro) {
        if 2 * block > run.len() {
            break;
        }
        for middle in run.start + block..=run.end - block {
            let (before, after) = (middle - block..middle, middle..middle + block);
            let lasting = cells.duration(&before).min(cells.duration(&after));
            let allowed = options.largest_sway / lasting + options.largest_rate_change();
            let change = cells.rate(&after) - cells.rate(&before);
            let ratio = (0..3)
                .map(|axis| {
                    let step = coarse_step(cells, noise, axis);
                    change[axis].abs() / (SIGMAS * sigma[axis] + allowed + step)
                })
                .fold(0.0, f64::max);
            if ratio > most.0 {
                most = (ratio, Some(middle));
            }
        }
    }
    most.1
}

/// The largest change of the mean of a coarse gyro due to rounding alone \[rad/s\]: zero if its noise exceeds the
/// quantization.
pub(super) fn coarse_step(cells: &Cells, noise: &Noise, axis: usize) -> f64 {
    let step = cells.gyro_step[axis];
    let cell = noise.gyro.first().map_or(0.0, |sigma| sigma[axis]);
    if cell < 0.1 * step { step } else { 0.0 }
}
