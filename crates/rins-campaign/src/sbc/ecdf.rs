//! Uniformity of ranks: the empirical distribution function with simultaneous confidence bands (‹sailynoja2022›).

use statrs::distribution::{Binomial, Discrete, DiscreteCDF, Poisson};

/// The number of equal intervals between whose ends the empirical distribution function is evaluated.
pub const POINTS: usize = 100;

/// The tails of a Poisson distribution beyond this number of standard deviations, and this number of counts, are neglected: 1e-20.
const TAIL: f64 = 10.0;

/// The relative rounding error of a tail.
const ROUNDING: f64 = 1e-9;

/// A p-value below this is replaced by the bound of Bonferroni, because it is a difference from one.
const EXACT: f64 = 1e-9;

/// The simultaneous confidence band of the empirical distribution function of uniform numbers.
///
/// At each of the points `z = 1/100, ..., 99/100` the number of ranks below `z` lies between two quantiles of its binomial distribution.
/// Their common probability is chosen so that all counts lie within with the probability `level`; this probability is calculated
/// exactly, as the counts are a Markov chain (‹sailynoja2022›, section 2.2).
#[derive(Clone, Debug, PartialEq)]
pub struct EcdfBand {
    /// The number of ranks.
    pub runs: u64,
    /// The least count at each point.
    pub lower: Vec<u64>,
    /// The largest count at each point.
    pub upper: Vec<u64>,
}

/// The counts that are possible at a point, from the first to the last.
type Window = [u64; 2];

impl EcdfBand {
    /// The band of `runs` ranks that contains all counts with probability `level`.
    ///
    /// # Panics
    /// If there are no runs, or `level` is not between 0 and 1.
    pub fn new(runs: u64, level: f64) -> Self {
        assert!(runs > 0 && level > 0.0 && level < 1.0, "{runs} runs, level {level}");
        let points = Points::new(runs);
        // The pointwise probability outside, on a logarithmic scale: between Bonferroni's and that of one point.
        let (mut low, mut high) = (((1.0 - level) / POINTS as f64).ln(), (1.0 - level).ln());
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            if points.inside(middle.exp()) >= level {
                low = middle;
            } else {
                high = middle;
            }
        }
        let windows = points.windows(low.exp());
        Self {
            runs,
            lower: windows.iter().map(|window| window[0]).collect(),
            upper: windows.iter().map(|window| window[1]).collect(),
        }
    }

    /// The points, without 0 and 1.
    pub fn points() -> impl ExactSizeIterator<Item = f64> {
        (1..POINTS).map(|point| point as f64 / POINTS as f64)
    }

    /// The lower and the upper edge of the band of the difference between the empirical distribution function and the uniform one.
    pub fn differences(&self) -> [Vec<f64>; 2] {
        [&self.lower, &self.upper].map(|edge| differences(edge, self.runs))
    }

    /// Whether the counts at the points lie within the band.
    pub fn contains(&self, counts: &[u64]) -> bool {
        let edges = self.lower.iter().zip(&self.upper);
        counts.iter().zip(edges).all(|(count, (low, high))| (low..=high).contains(&count))
    }

    /// The p-value of counts: the probability that uniform ranks leave a band as soon as these do.
    ///
    /// `counts` has the number of ranks below each point.
    ///
    /// # Panics
    /// If there are other than 99 counts, or no runs.
    pub fn p_value(counts: &[u64], runs: u64) -> f64 {
        assert!(counts.len() == POINTS - 1 && runs > 0, "{} counts of {runs} runs", counts.len());
        let points = Points::new(runs);
        let tails = counts.iter().zip(&points.counts).map(|(&count, at)| both_tails(at, count));
        let least = tails.fold(1.0, f64::min);
        let exactly = 1.0 - points.inside(least);
        let p_value = if exactly < EXACT { POINTS as f64 * least } else { exactly };
        p_value.clamp(0.0, 1.0)
    }
}

/// The difference between the empirical distribution function with these counts at the points and the uniform one.
pub(super) fn differences(counts: &[u64], runs: u64) -> Vec<f64> {
    EcdfBand::points().zip(counts).map(|(z, &count)| count as f64 / runs as f64 - z).collect()
}

/// Twice the smaller tail of a count.
fn both_tails(at: &Binomial, count: u64) -> f64 {
    let above = if count == 0 { 1.0 } else { at.sf(count - 1) };
    2.0 * at.cdf(count).min(above)
}

/// The distribution of uniform ranks at the points.
struct Points {
    runs: u64,
    /// The distribution of the count at each point.
    counts: Vec<Binomial>,
    /// The Poisson probabilities of the ranks in one interval, from the count `first` on.
    first: u64,
    within: Vec<f64>,
}

impl Points {
    fn new(runs: u64) -> Self {
        let counts = EcdfBand::points()
            .map(|z| Binomial::new(z, runs).expect("a probability between 0 and 1"))
            .collect();
        let mean = runs as f64 / POINTS as f64;
        let width = TAIL * (mean.sqrt() + 2.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between zero and the number of runs"
        )]
        let [first, last] = [(mean - width).max(0.0) as u64, (mean + width) as u64];
        let poisson = Poisson::new(mean).expect("a positive mean");
        let within = (first..=last).map(|count| poisson.pmf(count)).collect();
        Self { runs, counts, first, within }
    }

    /// At each point the counts of which either tail exceeds half of `outside`.
    fn windows(&self, outside: f64) -> Vec<Window> {
        // Tails that are equal but for rounding are both outside.
        let half = 0.5 * outside * (1.0 + ROUNDING);
        let of_point = |at: &Binomial| {
            let low = first(self.runs, |count| at.cdf(count) > half);
            // The first count whose upper tail is too small lies one beyond the last.
            let beyond = first(self.runs + 1, |count| count > 0 && at.sf(count - 1) <= half);
            [low, beyond.saturating_sub(1).max(low)]
        };
        self.counts.iter().map(of_point).collect()
    }

    /// The probability that all counts lie within these windows.
    ///
    /// The counts of the intervals are multinomial, which are independent Poisson counts given their sum; the sum over all paths of their
    /// partial sums within the windows is a product of matrices.
    fn inside(&self, outside: f64) -> f64 {
        let mut windows = self.windows(outside);
        windows.push([self.runs, self.runs]);
        let (mut start, mut weights) = (0, vec![1.0]);
        for [low, high] in windows {
            let n_next = usize::try_from(high - low + 1).expect("it has been allocated");
            let mut next = vec![0.0; n_next];
            for (count, weight) in (start..).zip(&weights) {
                // The next count lies `first + place` above this one.
                let from = count + self.first;
                let skipped = low.saturating_sub(from);
                let offset = from.saturating_sub(low);
                let (Ok(skipped), Ok(offset)) = (usize::try_from(skipped), usize::try_from(offset))
                else {
                    continue;
                };
                if skipped >= self.within.len() || offset >= n_next {
                    continue;
                }
                for (sum, probability) in next[offset..].iter_mut().zip(&self.within[skipped..]) {
                    *sum += weight * probability;
                }
            }
            (start, weights) = (low, next);
        }
        let all = Poisson::new(self.runs as f64).expect("a positive mean").pmf(self.runs);
        weights[0] / all
    }
}

/// The first number from 0 to `last` that satisfies a condition, which all later ones satisfy too; `last` if none does.
fn first(last: u64, holds: impl Fn(u64) -> bool) -> u64 {
    let (mut low, mut high) = (0, last);
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use rins_imu::{Seed, Sensor};
    use statrs::distribution::{ContinuousCDF, Normal};

    use super::*;

    /// The counts at the points of `runs` ranks, of standard normal numbers times `factor`.
    fn counts(seed: u64, runs: u64, factor: f64) -> Vec<u64> {
        let mut stream = Seed::new(seed).stream(Sensor::Encoder);
        let normal = Normal::standard();
        let mut bins = vec![0; POINTS];
        for _ in 0..runs {
            let rank = normal.cdf(factor * stream.sample());
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "from zero to the number of points"
            )]
            let bin = (rank * POINTS as f64) as usize;
            bins[bin.min(POINTS - 1)] += 1;
        }
        bins.iter()
            .take(POINTS - 1)
            .scan(0, |sum, bin| {
                *sum += bin;
                Some(*sum)
            })
            .collect()
    }

    /// The fraction of `trials` data sets outside of the band, and the fraction with a p-value below 5 %.
    fn outside(runs: u64, trials: u64, factor: f64) -> [f64; 2] {
        let band = EcdfBand::new(runs, 0.95);
        let (mut left, mut small) = (0, 0);
        for seed in 0..trials {
            let counts = counts(1000 + seed, runs, factor);
            left += u32::from(!band.contains(&counts));
            small += u32::from(EcdfBand::p_value(&counts, runs) < 0.05);
        }
        [left, small].map(|number| f64::from(number) / trials as f64)
    }

    #[test]
    fn uniform_ranks_leave_the_band_as_often_as_it_says() {
        const TRIALS: u64 = 1000;
        for runs in [50, 400] {
            // Four sigma of the fraction; a count is discrete, so that the band contains slightly more than 95 %.
            let sigma = (0.05 * 0.95 / TRIALS as f64).sqrt();
            for fraction in outside(runs, TRIALS, 1.0) {
                assert!(
                    fraction < 0.05 + 4.0 * sigma && fraction > 0.04 - 4.0 * sigma,
                    "{runs} runs: {fraction}"
                );
            }
        }
    }

    #[test]
    fn sigmas_that_are_a_fifth_too_small_leave_the_band() {
        for (factor, power) in [(1.25, 0.95), (0.8, 0.95)] {
            let [left, small] = outside(500, 200, factor);
            assert!(left >= power && small >= power, "{factor}: {left}, {small}");
        }
    }

    /// The probability of the whole square of windows of one rank: it is anywhere.
    #[test]
    fn the_probability_of_all_paths_is_one() {
        for runs in [1, 7, 100, 5000] {
            let inside = Points::new(runs).inside(0.0);
            // The neglected tails, and the rounding of Stirling's series.
            assert!((inside - 1.0).abs() < 1e-9, "{runs}: {inside}");
        }
    }

    /// One rank is below the point z with probability z: it lies within [0.3, 0.8) with the probability of these points.
    #[test]
    fn a_p_value_is_the_probability_of_counts_as_far_out() {
        let runs = 1;
        // The rank lies between 0.02 and 0.03: the extreme point is 0.03, with a tail of 3 %, doubled 6 %.
        let counts: Vec<u64> = EcdfBand::points().map(|z| u64::from(z > 0.025)).collect();
        let p_value = EcdfBand::p_value(&counts, runs);
        // Below 0.03 or above 0.97.
        assert!((p_value - 0.06).abs() < 1e-9, "{p_value}");
    }
}
