//! A series that switches between two levels: the most likely path (a hidden Markov chain with normal noise).

use statrs::function::factorial::ln_binomial;

/// How often the levels, the noise and the rates of switching are found anew.
const ROUNDS: usize = 40;

/// How many parts of the series a level lasts in the mean, where the search starts.
const LASTING: [f64; 3] = [5.0, 12.0, 30.0];

/// The most likely path of a two-level series.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Path {
    /// On which level each figure is: 0 or 1.
    pub(crate) states: Vec<usize>,
    /// How often it switches.
    pub(crate) switches: usize,
    /// By how much the logarithm of the likelihood rises over one level with white noise, if this is the path.
    pub(crate) gain: f64,
}

/// What is known of a chain: two levels, one noise, and the chance of leaving each level.
#[derive(Clone, Copy, Debug)]
struct Chain {
    levels: [f64; 2],
    variance: f64,
    leaving: [f64; 2],
}

/// The most likely path of `series` between two levels; none if it never switches.
pub(crate) fn two_levels(series: &[f64]) -> Option<Path> {
    let n = series.len() as f64;
    let mean = series.iter().sum::<f64>() / n;
    let variance = series.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
    if series.len() < 10 || variance <= 0.0 {
        return None;
    }
    let mut best: Option<(f64, Chain)> = None;
    for lasting in LASTING {
        let away = 0.7 * variance.sqrt();
        let mut chain = Chain {
            levels: [mean - away, mean + away],
            variance: 0.5 * variance,
            leaving: [lasting / n; 2],
        };
        let mut likelihood = f64::NEG_INFINITY;
        for _ in 0..ROUNDS {
            (chain, likelihood) = chain.improved(series);
        }
        if likelihood.is_finite() && best.is_none_or(|(most, _)| likelihood > most) {
            best = Some((likelihood, chain));
        }
    }
    let states = best?.1.path(series);
    let switches = states.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let gain = 0.5 * n * (variance / variance_about(series, &states)).ln();
    (switches > 0).then_some(Path { states, switches, gain })
}

impl Path {
    /// The logarithm of the odds for the path if noise is white.
    pub(crate) fn odds(&self) -> f64 {
        self.gain - self.cost(2.0 * self.gain)
    }

    /// What it costs that the path is not known, as a logarithm of odds, where the squares fall by `statistic` with it:
    /// the number of ways in which as many switches could have been chosen, over that of paths that do as well. A switch
    /// comes earlier or later by about as many figures as it takes to show.
    pub(crate) fn cost(&self, statistic: f64) -> f64 {
        let places = self.states.len();
        let (n, switches) = (places as f64, self.switches as f64);
        let ways = ln_binomial(places as u64, self.switches as u64);
        // No further than to the next one.
        let freedom = (1.0 + n / statistic).min(n / switches);
        // How many switches there are is not known either.
        ways + n.ln() - switches * freedom.ln()
    }
}

/// The variance of a series about the mean of each level.
fn variance_about(series: &[f64], states: &[usize]) -> f64 {
    let mut sums = [(0.0, 0.0, 0.0); 2];
    for (x, &state) in series.iter().zip(states) {
        let (count, sum, squares) = sums[state];
        sums[state] = (count + 1.0, sum + x, squares + x * x);
    }
    let about = sums.map(|(count, sum, squares)| squares - sum * sum / f64::max(count, 1.0));
    (about[0] + about[1]) / series.len() as f64
}

impl Chain {
    /// The probability density of a figure on each level, but for a common factor.
    fn densities(&self, x: f64) -> [f64; 2] {
        let exponents = self.levels.map(|level| -0.5 * (x - level).powi(2) / self.variance);
        let most = exponents[0].max(exponents[1]);
        exponents.map(|exponent| (exponent - most).exp())
    }

    /// The chance of going from one level to the other, or of staying.
    fn going(&self, from: usize, to: usize) -> f64 {
        if from == to { 1.0 - self.leaving[from] } else { self.leaving[from] }
    }

    /// A more likely chain, and how likely this one is: a step of expectation and maximisation (Baum and Welch).
    fn improved(&self, series: &[f64]) -> (Self, f64) {
        let n = series.len();
        let mut forward = Vec::with_capacity(n);
        let mut likelihood = -0.5 * n as f64 * self.variance.ln();
        let mut before = [0.5, 0.5];
        for (place, &x) in series.iter().enumerate() {
            let density = self.densities(x);
            let far = self.levels.map(|level| (x - level).powi(2));
            likelihood -= 0.5 * far[0].min(far[1]) / self.variance;
            let arrived = |to: usize| match place {
                0 => 0.5,
                _ => before[0] * self.going(0, to) + before[1] * self.going(1, to),
            };
            let now = [0, 1].map(|to| arrived(to) * density[to]);
            let sum = now[0] + now[1];
            likelihood += sum.ln();
            before = now.map(|p| p / sum);
            forward.push(before);
        }
        let mut backward = [1.0, 1.0];
        let mut weights = [0.0; 2];
        let mut sums = [0.0; 2];
        let mut squares = 0.0;
        let mut left = [0.0; 2];
        let mut stayed = [0.0; 2];
        for place in (0..n).rev() {
            let x = series[place];
            let here = [0, 1].map(|state| forward[place][state] * backward[state]);
            let sum = here[0] + here[1];
            for state in 0..2 {
                let share = here[state] / sum;
                weights[state] += share;
                sums[state] += share * x;
                squares += share * (x - self.levels[state]).powi(2);
            }
            if place == 0 {
                break;
            }
            let density = self.densities(x);
            let after = [0, 1].map(|to| density[to] * backward[to]);
            let pair = |from: usize, to: usize| {
                forward[place - 1][from] * self.going(from, to) * after[to]
            };
            let all = pair(0, 0) + pair(0, 1) + pair(1, 0) + pair(1, 1);
            for from in 0..2 {
                left[from] += pair(from, 1 - from) / all;
                stayed[from] += pair(from, from) / all;
            }
            let earlier =
                [0, 1].map(|from| self.going(from, 0) * after[0] + self.going(from, 1) * after[1]);
            let scale = earlier[0] + earlier[1];
            backward = earlier.map(|p| p / scale);
        }
        let least = 1e-12 * self.variance;
        let chain = Self {
            levels: [0, 1].map(|s| if weights[s] > 0.0 { sums[s] / weights[s] } else { 0.0 }),
            variance: (squares / n as f64).max(least),
            leaving: [0, 1].map(|s| (left[s] / (left[s] + stayed[s]).max(1.0)).clamp(1e-6, 0.5)),
        };
        (chain, likelihood)
    }

    /// The most likely path (Viterbi).
    fn path(&self, series: &[f64]) -> Vec<usize> {
        let mut costs = [0.0; 2];
        let mut from: Vec<[usize; 2]> = Vec::with_capacity(series.len());
        for &x in series {
            let reached = [0, 1].map(|to| {
                let ways = [0, 1].map(|from| costs[from] - self.going(from, to).ln());
                let way = usize::from(ways[1] < ways[0]);
                (way, ways[way] + 0.5 * (x - self.levels[to]).powi(2) / self.variance)
            });
            from.push(reached.map(|(way, _)| way));
            costs = reached.map(|(_, cost)| cost);
        }
        let mut state = usize::from(costs[1] < costs[0]);
        let mut states = vec![0; series.len()];
        for (place, ways) in from.iter().enumerate().rev() {
            states[place] = state;
            state = ways[state];
        }
        states
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;

    fn telegraph(n: usize, height: f64, seed: u64) -> (Vec<f64>, Vec<usize>) {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut state = 0;
        let mut states = Vec::new();
        let mut series = Vec::new();
        for _ in 0..n {
            if random.random_bool(0.02) {
                state = 1 - state;
            }
            let white: f64 = StandardNormal.sample(&mut random);
            states.push(state);
            series.push(5.0 + height * state as f64 + white);
        }
        (series, states)
    }

    #[test]
    fn path_of_a_telegraph_is_found() {
        for seed in 0..10 {
            let (series, states) = telegraph(600, 1.5, seed);
            let path = two_levels(&series).expect("a path");
            let wrong = path.states.iter().zip(&states).filter(|(a, b)| a != b).count();
            // Which level is called the first is a matter of chance.
            let wrong = wrong.min(600 - wrong);
            assert!(wrong < 60, "{seed}: {wrong}");
            assert!(path.odds() > 20.0, "{seed}: {path:?}");
        }
    }

    /// The odds for a path are honest: of white noise they exceed 100 in one series of a hundred at most.
    #[test]
    fn white_noise_does_not_pay_for_a_path() {
        let pays = |seed: &u64| {
            let path = two_levels(&telegraph(600, 0.0, *seed).0);
            path.is_some_and(|path| path.odds() > 100.0_f64.ln())
        };
        assert!((0..200).filter(pays).count() <= 4);
    }

    #[test]
    fn what_is_constant_has_no_path() {
        assert_eq!(two_levels(&[1.0; 100]), None);
        assert_eq!(two_levels(&[]), None);
    }
}
