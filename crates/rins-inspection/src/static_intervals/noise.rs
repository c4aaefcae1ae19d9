//! The noise in the quietest parts of a log, and the cells with no more noise.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::DEG_PER_SECOND;

use super::cells::Cells;
use super::options::StaticOptions;
use rins_motion::{median, whole};

/// The scatter of a window, relative to that of the quietest, above which the IMU moves.
const SCATTER_RATIO: f64 = 4.0;

/// The quietest fraction of all windows, one in this number, is taken as quiet.
const QUIETEST: usize = 50;

/// The scatter of a gyro \[rad/s\] up to which a base may sway: it changes no angle by an arcsecond.
const LEAST_GYRO_SCATTER: f64 = 0.05 * DEG_PER_SECOND;

/// The same for accelerometers \[m/s²\].
const LEAST_ACCEL_SCATTER: f64 = 0.02;

/// Gyros whose quietest scatter exceeds the data sheet's noise by this factor are never static ...
const SHEET_RATIO: f64 = 10.0;

/// ... if it exceeds that of a trembling hand \[rad/s\].
const TREMOR: f64 = 0.5 * DEG_PER_SECOND;

/// The smallest number of differences whose median is an estimate of a sigma.
const ENOUGH_DIFFERENCES: usize = 8;

/// The median of the magnitude of a standard normal deviate.
const MEDIAN_MAGNITUDE: f64 = 0.6745;

/// The largest scatter of a static IMU.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) gyro: f64,
    pub(super) accel: f64,
}

impl Limits {
    /// The limits from the quietest windows among the cells in `stand`.
    pub(super) fn of(cells: &Cells, stand: &[bool], options: &StaticOptions) -> Self {
        let mut scatters: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
        let mut start = 0;
        while start + cells.window <= cells.len() {
            let window = start..start + cells.window;
            if window.clone().all(|cell| stand[cell] && !cells.cells[cell].gap) {
                for (list, scatter) in scatters.iter_mut().zip(cells.scatter(&window)) {
                    list.push(scatter);
                }
            }
            start = window.end;
        }
        let [gyro, accel] = scatters.map(quietest);
        let gyro_step = cells.gyro_step.norm();
        let mut limit = (SCATTER_RATIO * gyro).max(LEAST_GYRO_SCATTER).max(gyro_step);
        if let Some(density) = options.gyro.noise_density {
            let white = 3.0_f64.sqrt() * density / cells.interval.sqrt();
            limit = limit.min(SHEET_RATIO * white.max(TREMOR / SHEET_RATIO).max(gyro_step));
        }
        Self {
            gyro: limit,
            accel: (SCATTER_RATIO * accel).max(LEAST_ACCEL_SCATTER).max(cells.accel_step.norm()),
        }
    }

    /// The cells in windows within these limits.
    pub(super) fn quiet(&self, cells: &Cells, stand: &[bool]) -> Vec<bool> {
        let mut quiet = vec![false; cells.len()];
        let allowed = |cell: usize| stand[cell] && !cells.cells[cell].gap;
        for start in 0..=cells.len().saturating_sub(cells.window) {
            let window = start..(start + cells.window).min(cells.len());
            if !window.clone().all(allowed) {
                continue;
            }
            let [gyro, accel] = cells.scatter(&window);
            if gyro <= self.gyro && accel <= self.accel {
                quiet[window].fill(true);
            }
        }
        quiet
    }
}

/// One of the smallest values; exact zeros, as of a stuck sensor, are used only if they are the majority.
fn quietest(mut scatters: Vec<f64>) -> f64 {
    let count = scatters.len();
    let moving: Vec<f64> = scatters.iter().copied().filter(|scatter| *scatter > 0.0).collect();
    if 2 * moving.len() > count {
        scatters = moving;
    }
    scatters.sort_by(f64::total_cmp);
    scatters.get(scatters.len() / QUIETEST).copied().unwrap_or_default()
}

/// The differences of mean rate and specific force between successive blocks.
type Difference = (Vector3<f64>, Vector3<f64>);

/// The 1σ of differences between the means of successive blocks of cells, as a function of the blocks' length.
#[derive(Clone, Debug)]
pub(super) struct Noise {
    /// The number of cells in a block, from one on.
    pub(super) blocks: Vec<usize>,
    pub(super) gyro: Vec<Vector3<f64>>,
    pub(super) accel: Vec<Vector3<f64>>,
    /// The duration of a cell \[s\].
    cell: f64,
}

impl Noise {
    /// The noise of quiet runs of cells.
    pub(super) fn of(cells: &Cells, runs: &[Range<usize>]) -> Self {
        const LENGTHS: [usize; 10] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
        let duration: f64 = runs.iter().map(|run| cells.duration(run)).sum();
        let count: usize = runs.iter().map(Range::len).sum();
        let longest = runs.iter().map(Range::len).max().unwrap_or_default() / 2;
        let mut noise = Self {
            blocks: Vec::new(),
            gyro: Vec::new(),
            accel: Vec::new(),
            cell: duration / count.max(1) as f64,
        };
        for block in LENGTHS.into_iter().filter(|block| *block == 1 || *block <= longest) {
            let mut differences = Vec::new();
            let mut independent = 0;
            for run in runs.iter().filter(|run| run.len() >= 2 * block) {
                independent += run.len() / block - 1;
                // Overlapping blocks, but only as many as add information.
                let stride = (block / 5).max(1);
                differences.extend((run.start + block..=run.end - block).step_by(stride).map(
                    |middle| {
                        let (before, after) = (middle - block..middle, middle..middle + block);
                        (
                            cells.rate(&after) - cells.rate(&before),
                            cells.force(&after) - cells.force(&before),
                        )
                    },
                ));
            }
            let sigma = |of: fn(&Difference) -> &Vector3<f64>| {
                Vector3::from_fn(|axis, _| {
                    let magnitudes =
                        differences.iter().map(|difference| of(difference)[axis].abs());
                    median(magnitudes).unwrap_or_default() / MEDIAN_MAGNITUDE
                })
            };
            let white = |shorter: &[Vector3<f64>]| {
                shorter
                    .last()
                    .zip(noise.blocks.last())
                    .map_or_else(Vector3::zeros, |(sigma, &of)| {
                        sigma * (of as f64 / block as f64).sqrt()
                    })
            };
            let (gyro, accel) = if independent >= ENOUGH_DIFFERENCES || block == 1 {
                (sigma(|pair| &pair.0), sigma(|pair| &pair.1))
            } else {
                (white(&noise.gyro), white(&noise.accel))
            };
            // Longer means scatter no more than shorter ones: an increase would be due to a motion, or to a drift for which
            // there is a separate allowance.
            let limited = |sigma: Vector3<f64>, shorter: &[Vector3<f64>]| {
                shorter.last().map_or(sigma, |shorter| sigma.inf(shorter))
            };
            let (gyro, accel) = (limited(gyro, &noise.gyro), limited(accel, &noise.accel));
            noise.blocks.push(block);
            noise.gyro.push(gyro);
            noise.accel.push(accel);
        }
        noise
    }

    /// The 1σ of a mean over this duration \[s\].
    pub(super) fn of_mean(&self, of: &[Vector3<f64>], duration: f64) -> Vector3<f64> {
        let wanted = whole(duration / self.cell.max(1e-9));
        let place = self.blocks.iter().rposition(|block| *block <= wanted).unwrap_or_default();
        let block = self.blocks.get(place).copied().unwrap_or(1);
        let sigma = of.get(place).copied().unwrap_or_default();
        sigma * (0.5 * block as f64 / wanted as f64).sqrt()
    }

    /// The 1σ of the norm of a mean rate over this duration \[rad/s\].
    pub(super) fn rate(&self, duration: f64) -> f64 {
        self.of_mean(&self.gyro, duration).norm()
    }

    /// The 1σ of the norm of a mean specific force over this duration \[m/s²\].
    pub(super) fn force(&self, duration: f64) -> f64 {
        self.of_mean(&self.accel, duration).norm()
    }
}
