//! The table angle from two sensors: the reference, whose error is white, and the gyro, whose error is a random walk.

/// The fraction of a run over which its noise levels are averaged; of these the median counts, so that a single slip or a
/// ramp does not.
const STRETCHES: usize = 32;

/// A stretch has at least this number of the longest differences.
const FEWEST: usize = 8;

/// Noise of the difference between reading and integrated gyro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Levels {
    /// Variance of the readings \[rad²\].
    white: f64,
    /// Variance of the gyro's random walk over one sample \[rad²\].
    walk: f64,
}

impl Levels {
    /// The levels from second differences at lags of 1, 2, 4, ... samples up to `longest`, whose variance at lag `n` is
    /// `2 n walk + 6 white`.
    ///
    /// Errors other than noise, such as harmonics of the encoder or its quantization, increase the slope at some of the lags;
    /// the smallest slope is the random walk.
    pub(crate) fn of(differences: &[f64], longest: usize) -> Self {
        let lags = || {
            std::iter::successors(Some(1), |lag| Some(2 * lag))
                .take_while(|lag| *lag <= longest.max(2))
        };
        let variances: Vec<(f64, f64)> =
            lags().filter_map(|lag| Some((lag as f64, variance(differences, lag)?))).collect();
        let slope = |pair: &[(f64, f64)]| (pair[1].1 - pair[0].1) / (2.0 * (pair[1].0 - pair[0].0));
        let walk = variances.windows(2).map(slope).fold(f64::INFINITY, f64::min);
        let walk = if walk.is_finite() { walk.max(0.0) } else { 0.0 };
        let rest = variances.iter().map(|(lag, variance)| (variance - 2.0 * lag * walk) / 6.0);
        Self { white: rest.fold(0.0, f64::max), walk }
    }

    /// The square of the time constant of the smoothing, in samples: the reading determines the angle over longer times, the
    /// gyro over shorter ones.
    fn constant_squared(&self, longest: usize) -> f64 {
        let most = (longest * longest) as f64;
        if self.walk * most <= self.white { most } else { self.white / self.walk }
    }
}

/// The angle of the reference relative to the integrated gyro, smoothed as the noise levels say, at the start and at the end of each
/// sample: the minimum of `Σ (d - s)²/white + Σ (Δs - mean)²/walk` (Whittaker and Henderson), the two-sided Kalman smoother of
/// a random walk in white noise.
///
/// The error of the result is uncorrelated with what remains of reading and gyro, so that no function of the table rate
/// explains noise. `linked` tells of each sample but the first whether the gyro measured the rotation since the one before.
pub(crate) fn smoothed(
    differences: &[f64],
    linked: impl Fn(usize) -> bool,
    longest: usize,
) -> Vec<f64> {
    let constant = Levels::of(differences, longest).constant_squared(longest);
    let steps = || {
        differences
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .enumerate()
            .filter(|(step, _)| linked(step + 1))
    };
    let mean = steps().map(|(_, step)| step).sum::<f64>() / steps().count().max(1) as f64;
    let link = |step: usize| {
        if step > 0 && step < differences.len() && linked(step) { constant } else { 0.0 }
    };
    // Thomas algorithm: the matrix is tridiagonal, symmetric and diagonally dominant.
    let mut eliminated: Vec<(f64, f64)> = Vec::with_capacity(differences.len());
    for (sample, difference) in differences.iter().enumerate() {
        let (before, after) = (link(sample), link(sample + 1));
        let (ratio, value) = eliminated.last().copied().unwrap_or_default();
        let pivot = 1.0 + before + after - before * ratio;
        let right = difference + mean * (before - after) + before * value;
        eliminated.push((after / pivot, right / pivot));
    }
    let mut next = 0.0;
    let mut angles: Vec<f64> = eliminated
        .iter()
        .rev()
        .map(|(ratio, value)| {
            next = value + ratio * next;
            next
        })
        .collect();
    angles.push(next - mean);
    angles.reverse();
    angles
}

/// Mean square of the second differences at this lag: the median over stretches.
fn variance(values: &[f64], lag: usize) -> Option<f64> {
    let squares: Vec<f64> = values
        .get(2 * lag..)?
        .iter()
        .zip(&values[lag..])
        .zip(values)
        .map(|((after, at), before)| (after - 2.0 * at + before).powi(2))
        .collect();
    let length = squares.len().div_ceil(STRETCHES).max(FEWEST * lag);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let mut means: Vec<f64> = squares.chunks(length).map(mean).collect();
    means.sort_by(f64::total_cmp);
    means.get(means.len() / 2).copied()
}
