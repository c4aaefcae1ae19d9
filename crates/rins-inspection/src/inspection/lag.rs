//! How late the table's angle is, and how its count and the z gyro's compare.

use nalgebra::{Cholesky, Matrix3, Vector3};

use rins_motion::Recording;

/// The table's rate must change by this much \[rad/s\], rms, for a lag to show.
const LEAST_CHANGE: f64 = 1e-3;

/// A time stamp may mean the start, the middle or the end of a sample, and of the one before.
const MOST_SAMPLES_LATE: f64 = 2.0;

/// Angles and rates are means over so long \[s\]: the noise of a rate is small beside what a table changes it by.
const BLOCK: f64 = 1.0;

/// Of fewer means the noise does not show.
const FEWEST_BLOCKS: usize = 12;

/// The variance of the random walk over a block, as a part of that of a block's white noise: from none that shows to hardly any
/// white noise.
const WALK: [f64; 2] = [1e-8, 1e8];

/// So many values of it are tried, ...
const TRIED: u32 = 17;

/// ... and so many steps of a golden section narrow the best down.
const NARROWED: usize = 20;

/// A lag is found again about the last one until it moves by less than this part of its 1σ, ...
const STILL: f64 = 0.1;

/// ... or until it was found so often.
const MOST_PASSES: usize = 5;

/// The angle of the z gyro against that of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableLag {
    /// By how much the table's angle is late \[s\].
    pub latency: f64,
    /// Its 1σ by the scatter of the angles: white noise and a random walk \[s\].
    pub sigma: f64,
    /// The gyro's turn over the table's: the gyro's scale, and how fast their clocks go.
    pub ratio: f64,
}

/// What a block of samples shows.
struct Block {
    /// The gyro's mean angle \[rad\].
    angle: f64,
    /// The table's mean angle \[rad\], the gyro's mean rate \[rad/s\], and the mean time \[s\].
    columns: Vector3<f64>,
}

/// A generalised least-squares fit, of angles in whose noise is so much random walk.
struct Trial {
    found: Vector3<f64>,
    sigma_of_rate: f64,
    /// Twice the restricted log-likelihood.
    likelihood: f64,
}

impl TableLag {
    /// `None` without an angle that was read, or if the table rotates at one rate only.
    ///
    /// The gyro's angle is `ratio · (θ + latency · ω) + bias · t + start`, in means over blocks, which hold as the equation does.
    /// Its noise is white, that of the angle, and a random walk, that of the gyro: how much there is of each is the most likely by
    /// restricted maximum likelihood, and with it the parameters follow by generalised least squares (local level
    /// model; ‹harvey1989›, section 4.1).
    ///
    /// The equation holds for a lag in which the rate does not change: it is asked again of the gyro's angle as late as the lag
    /// that was found, until nothing is left (Gauss–Newton).
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

    /// What is left of the lag where the gyro's angle is made so late.
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

    /// The latency, if it is a matter of which instant of a sample a time stamp means, samples being `interval` long \[s\]: it
    /// is told by itself, and no sign of a table that moved otherwise.
    pub(super) fn by_convention(&self, interval: f64) -> Option<f64> {
        (self.latency.abs() <= MOST_SAMPLES_LATE * interval).then_some(self.latency)
    }
}

/// The angle \[rad\] that the z gyro has turned by at the end of each sample.
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

/// The means over blocks of samples, of the gyro's angle as it was `latency` \[s\] before.
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
    // Half-way between samples, so that the mean rate is over the same time as the mean angle.
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

/// Values at times \[s\] that rise and lie within those of a table, by straight lines.
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
    /// With a random walk whose variance over a block is so many times that of a block's white noise.
    fn of(blocks: &[Block], walk: f64) -> Option<Self> {
        let (first, rest) = blocks.split_first()?;
        // The level is not known beforehand: it is that of the first block.
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
        // Of one size, so that the normal equations are no worse than they must be.
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

/// Where a function of one maximum between `low` and `high` is largest.
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
