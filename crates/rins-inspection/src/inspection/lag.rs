//! The latency of the table angle, and its ratio to the angle of the z gyro.

use nalgebra::{Cholesky, Matrix3, Vector3};

use rins_motion::Recording;

/// The smallest change of the table rate \[rad/s\], rms, for which a latency is observable.
const LEAST_CHANGE: f64 = 1e-3;

/// The largest latency in samples that is a matter of convention: a time stamp may be that of the start, the middle or the
/// end of a sample, or of the previous one.
const MOST_SAMPLES_LATE: f64 = 2.0;

/// The averaging time of angles and rates \[s\]: the noise of a rate is small compared with its changes.
const BLOCK: f64 = 1.0;

/// The smallest number of blocks from which the noise can be estimated.
const FEWEST_BLOCKS: usize = 12;

/// The range of the variance of the random walk over a block, relative to that of a block's white noise: from a negligible
/// random walk to negligible white noise.
const WALK: [f64; 2] = [1e-8, 1e8];

/// The number of grid values in this range, ...
const TRIED: u32 = 17;

/// ... and the number of golden-section steps that refine the best one.
const NARROWED: usize = 20;

/// The latency is estimated again about the last estimate until it changes by less than this fraction of its 1σ, ...
const STILL: f64 = 0.1;

/// ... or until this number of passes.
const MOST_PASSES: usize = 5;

/// The angle of the z gyro compared with that of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableLag {
    /// The latency of the table angle \[s\].
    pub latency: f64,
    /// Its 1σ from the scatter of the angles: white noise and a random walk \[s\].
    pub sigma: f64,
    /// The ratio of the gyro's to the table's angle of rotation: the gyro's scale factor times the ratio of the clocks.
    pub ratio: f64,
}

/// The means over a block of samples.
struct Block {
    /// The gyro's mean angle \[rad\].
    angle: f64,
    /// The table's mean angle \[rad\], the gyro's mean rate \[rad/s\], and the mean time \[s\].
    columns: Vector3<f64>,
}

/// A generalized least squares fit to angles with a given ratio of random walk to white noise.
struct Trial {
    found: Vector3<f64>,
    sigma_of_rate: f64,
    /// Twice the restricted log-likelihood.
    likelihood: f64,
}

impl TableLag {
    /// The latency; `None` without a measured angle, or if the table rotates at a single rate.
    ///
    /// The gyro's angle is `ratio · (θ + latency · ω) + bias · t + start`, in means over blocks, for which the equation holds
    /// too. Its noise is the sum of the angle's white noise and the gyro's random walk. Their ratio is estimated by
    /// restricted maximum likelihood, the parameters by generalized least squares (local level model; ‹harvey1989›, section
    /// 4.1).
    ///
    /// The equation holds for a latency in which the rate does not change: the fit is repeated with the gyro's angle delayed
    /// by the estimated latency until the remainder vanishes (Gauss–Newton).
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        let table = recording.table_angle.as_deref()?;
        let angles = gyro_angles(recording);
        let mut found = Self::beyond(0.0, &recording.times, &angles, table)?;
        for _ in 1..MOST_PASSES {
            let left = Self::beyond(found.latency, &recording.times, &angles, table)?;
            found = Self { latency: found.latency + left.latency, ..left };
            if left.latency.abs() <= STILL * left.sigma {
                break;
            }
        }
        Some(found)
    }

    /// The remaining latency for the gyro's angle delayed by `latency`.
    fn beyond(latency: f64, times: &[f64], angles: &[f64], table: &[f64]) -> Option<Self> {
        let blocks = blocks(latency, times, angles, table);
        if blocks.len() < FEWEST_BLOCKS {
            return None;
        }
        let rates = || blocks.iter().map(|block| block.columns.y);
        let count = blocks.len() as f64;
        let mean = rates().sum::<f64>() / count;
        let change = rates().map(|rate| (rate - mean).powi(2)).sum::<f64>() / count;
        if change.sqrt() < LEAST_CHANGE {
            return None;
        }
        let [low, high] = WALK.map(f64::ln);
        let step = (high - low) / f64::from(TRIED - 1);
        let likelihood = |walk: f64| {
            Trial::of(&blocks, walk.exp()).map_or(f64::NEG_INFINITY, |trial| trial.likelihood)
        };
        let places = (0..TRIED).map(|place| low + step * f64::from(place));
        let tried = places.map(|walk| (likelihood(walk), walk));
        let (_, best) = tried.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let walk = golden_section(best - step, best + step, likelihood);
        let Trial { found, sigma_of_rate, .. } = Trial::of(&blocks, walk.exp())?;
        let lag = Self { latency: found.y, sigma: sigma_of_rate, ratio: found.x };
        (lag.latency.is_finite() && lag.sigma.is_finite()).then_some(lag)
    }

    /// The latency, if it is a matter of the convention of time stamps for samples of duration `interval` \[s\]: it is
    /// reported as a latency, and is not evidence of a different motion of the table.
    pub(super) fn by_convention(&self, interval: f64) -> Option<f64> {
        (self.latency.abs() <= MOST_SAMPLES_LATE * interval).then_some(self.latency)
    }
}

/// The angle \[rad\] of rotation of the z gyro at the end of each sample.
fn gyro_angles(recording: &Recording) -> Vec<f64> {
    let turned = |angle: &mut f64, by: f64| {
        *angle += by;
        Some(*angle)
    };
    recording
        .increments
        .iter()
        .map(|sample| sample.angle.components().z)
        .scan(0.0, turned)
        .collect()
}

/// The means over blocks of samples, with the gyro's angle delayed by `latency` \[s\].
fn blocks(latency: f64, times: &[f64], angles: &[f64], table: &[f64]) -> Vec<Block> {
    let [start, .., end] = times else {
        return Vec::new();
    };
    let known = times.partition_point(|time| time - latency < *start)
        ..times.partition_point(|time| time - latency <= *end);
    let gyro = interpolated(times, angles, times[known.clone()].iter().map(|time| time - latency));
    let (count, times, table) = (known.len(), &times[known.clone()], &table[known]);
    if count < 2 {
        return Vec::new();
    }
    let interval = (times[count - 1] - times[0]) / (count - 1) as f64;
    // At the middle between samples, so that the mean rate refers to the same time as the mean angle.
    let between = |values: &[f64], after: usize| 0.5 * (values[after - 1] + values[after]);
    let mut blocks = Vec::new();
    let mut first = 1;
    while let Some(end) =
        (first + 1..count).find(|&end| times[end] - times[first] >= BLOCK - 0.5 * interval)
    {
        let length = (end - first) as f64;
        let mean = |values: &[f64]| values[first..end].iter().sum::<f64>() / length;
        let lasting = between(times, end) - between(times, first);
        let rate = (between(&gyro, end) - between(&gyro, first)) / lasting;
        blocks.push(Block {
            angle: mean(&gyro),
            columns: Vector3::new(mean(table) - table[0], rate, mean(times) - times[0]),
        });
        first = end;
    }
    blocks
}

/// Linear interpolation of a table of values at increasing times \[s\] within its range.
fn interpolated(times: &[f64], values: &[f64], at: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut after = 1;
    at.map(|time| {
        while after + 1 < times.len() && times[after] < time {
            after += 1;
        }
        let part = (time - times[after - 1]) / (times[after] - times[after - 1]);
        values[after - 1] + part * (values[after] - values[after - 1])
    })
    .collect()
}

impl Trial {
    /// The fit with a random walk whose variance over a block is `walk` times that of a block's white noise.
    fn of(blocks: &[Block], walk: f64) -> Option<Self> {
        let (first, rest) = blocks.split_first()?;
        // The initial level is unknown: it is that of the first block.
        let (mut variance, mut level, mut levels) = (1.0 + walk, first.angle, first.columns);
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        let (mut square, mut logarithms) = (0.0, 0.0);
        for block in rest {
            let of_innovation: f64 = variance + 1.0;
            let (angle, columns) = (block.angle - level, block.columns - levels);
            let weight = of_innovation.recip();
            normal += columns * columns.transpose() * weight;
            right += columns * (angle * weight);
            square += angle * angle * weight;
            logarithms += of_innovation.ln();
            let gain = variance * weight;
            level += gain * angle;
            levels += columns * gain;
            variance = gain + walk;
        }
        // Normalized, for the condition of the normal equations.
        let size = normal.diagonal().map(|own: f64| own.sqrt().max(f64::MIN_POSITIVE));
        let scaled =
            Matrix3::from_fn(|row, column| normal[(row, column)] / (size[row] * size[column]));
        let factor = Cholesky::new(scaled)?;
        let found = factor.solve(&right.component_div(&size));
        let left = (square - found.dot(&right.component_div(&size))).max(f64::MIN_POSITIVE);
        let freedom = rest.len().checked_sub(3).filter(|freedom| *freedom > 0)? as f64;
        let scatter = left / freedom;
        let determinant =
            2.0 * (factor.l_dirty().diagonal().map(f64::ln).sum() + size.map(f64::ln).sum());
        Some(Self {
            found: found.component_div(&size),
            sigma_of_rate: (scatter * factor.inverse()[(1, 1)]).sqrt() / size.y,
            likelihood: -freedom * scatter.ln() - logarithms - determinant,
        })
    }
}

/// The place of the maximum between `low` and `high` of a unimodal function.
fn golden_section(mut low: f64, mut high: f64, of: impl Fn(f64) -> f64) -> f64 {
    let part = (5.0_f64.sqrt() - 1.0) / 2.0;
    let inside = |low: f64, high: f64| [high - part * (high - low), low + part * (high - low)];
    let [mut left, mut right] = inside(low, high);
    let [mut of_left, mut of_right] = [of(left), of(right)];
    for _ in 0..NARROWED {
        if of_left > of_right {
            (high, right, of_right) = (right, left, of_left);
            left = inside(low, high)[0];
            of_left = of(left);
        } else {
            (low, left, of_left) = (left, right, of_right);
            right = inside(low, high)[1];
            of_right = of(right);
        }
    }
    0.5 * (low + high)
}
