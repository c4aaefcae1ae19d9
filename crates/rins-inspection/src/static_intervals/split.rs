//! Where within a quiet run of cells the mean rate changes.

use std::ops::Range;

use super::cells::Cells;
use super::noise::Noise;
use super::options::StaticOptions;

/// A mean that has changed by so many sigma has changed: of a million differences none does by chance.
pub(super) const SIGMAS: f64 = 6.0;

/// The parts of a run of cells over which the mean rate is the same.
///
/// The means of neighbouring blocks are compared, from one cell to half the run. They may differ by noise, by an angle
/// that the base sways while a block lasts, and by how far a bias changes.
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

/// Where the rate changes most beyond what it may; none if it does not.
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

/// By how much the mean of a coarse gyro may change by rounding alone \[rad/s\]: not at all where noise carries it over
/// its steps.
pub(super) fn coarse_step(cells: &Cells, noise: &Noise, axis: usize) -> f64 {
    let step = cells.gyro_step[axis];
    let cell = noise.gyro.first().map_or(0.0, |sigma| sigma[axis]);
    if cell < 0.1 * step { step } else { 0.0 }
}
