//! What switches between two levels: when it most likely does, from what a run says of it part by part.

use nalgebra::{DMatrix, DVector};
use statrs::function::factorial::ln_binomial;

/// How often a path is bettered at most.
const ROUNDS: usize = 200;

/// What a run says of a quantity in each of its parts, if it may be another in each and all else is estimated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parts {
    /// The information on what it is in each.
    pub(crate) information: DMatrix<f64>,
    /// The derivative of the log-likelihood.
    pub(crate) score: DVector<f64>,
}

/// The most likely path between two levels.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Path {
    /// In which parts it is on the second.
    pub(crate) up: Vec<bool>,
    /// How often it switches.
    pub(crate) switches: usize,
    /// How far the second level is above the first.
    pub(crate) height: f64,
    /// By how much the squares fall with it.
    pub(crate) statistic: f64,
}

/// A path on its way to a better one: what the derivative and the information are along it.
#[derive(Clone)]
struct Way {
    score: f64,
    information: f64,
    /// The information on each part together with it.
    seen: DVector<f64>,
}

impl Parts {
    /// The most likely path; none if it pays nowhere to leave a level.
    ///
    /// From one level all along, stretches are put onto the other level, or back, that pay most, as long as one does.
    pub(crate) fn path(&self) -> Option<Path> {
        let n = self.score.len();
        let mut up = vec![false; n];
        let mut way = Way { score: 0.0, information: 0.0, seen: DVector::zeros(n) };
        let mut most = 0.0;
        for _ in 0..ROUNDS {
            let Some((first, last, odds)) = self.best_stretch(&up, &way) else { break };
            if odds <= most {
                break;
            }
            most = odds;
            for (part, is_up) in up.iter_mut().enumerate().take(last + 1).skip(first) {
                way.flip(self, part, *is_up);
                *is_up = !*is_up;
            }
        }
        let switches = switches(&up);
        (switches > 0).then(|| Path {
            switches,
            height: way.score / way.information,
            statistic: way.statistic(),
            up,
        })
    }

    /// The stretch that pays most on the other level, from its first to its last part, and the logarithm of the odds of
    /// the path with it.
    fn best_stretch(&self, up: &[bool], way: &Way) -> Option<(usize, usize, f64)> {
        let n = up.len();
        let now = switches(up);
        // Before the first and after the last of a stretch there is a switch where there was none, and the other way round.
        let turned = |part: usize| match part {
            0 => 0,
            part if part == n => 0,
            part if up[part - 1] == up[part] => 1,
            _ => -1,
        };
        let mut best: Option<(usize, usize, f64)> = None;
        for first in 0..n {
            let mut way = way.clone();
            for (last, &is_up) in up.iter().enumerate().skip(first) {
                way.flip(self, last, is_up);
                let switches = now.saturating_add_signed(turned(first) + turned(last + 1));
                if switches == 0 || way.information <= 0.0 {
                    continue;
                }
                let odds = odds(way.statistic(), n, switches);
                if best.is_none_or(|(.., most)| odds > most) {
                    best = Some((first, last, odds));
                }
            }
        }
        best
    }
}

impl Way {
    /// Puts a part onto the other level.
    fn flip(&mut self, parts: &Parts, part: usize, is_up: bool) {
        let sign = if is_up { -1.0 } else { 1.0 };
        let column = parts.information.column(part);
        self.score += sign * parts.score[part];
        self.information += 2.0 * sign * self.seen[part] + column[part];
        self.seen.axpy(sign, &column, 1.0);
    }

    fn statistic(&self) -> f64 {
        self.score * self.score / self.information
    }
}

impl Path {
    /// The logarithm of the odds for it.
    pub(crate) fn odds(&self) -> f64 {
        odds(self.statistic, self.up.len(), self.switches)
    }
}

/// The logarithm of the odds for a path of so many parts and switches with which the squares fall by `statistic`.
///
/// That the path is not known costs the number of ways in which as many switches could have been chosen, over that of paths
/// that do as well: a switch comes earlier or later by about as many parts as it takes to show.
fn odds(statistic: f64, parts: usize, switches: usize) -> f64 {
    let (n, often) = (parts as f64, switches as f64);
    // No further than half the way to the next one: what switches from part to part has no freedom, and is much like noise.
    let freedom = (1.0 + n / statistic).min(0.5 * n / often).max(1.0);
    // How many switches there are is not known either.
    let cost = ln_binomial(parts as u64, switches as u64) + n.ln() - often * freedom.ln();
    0.5 * statistic - cost
}

fn switches(up: &[bool]) -> usize {
    up.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;
    use rins_testing::assert_close;

    /// A telegraph in white noise of one a part, whose mean is not known.
    fn telegraph(n: usize, height: f64, seed: u64) -> (Parts, Vec<bool>) {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut state = false;
        let mut states = Vec::new();
        let mut series = DVector::zeros(n);
        for x in series.iter_mut() {
            state ^= random.random_bool(0.1);
            let white: f64 = StandardNormal.sample(&mut random);
            states.push(state);
            *x = 5.0 + white + if state { height } else { 0.0 };
        }
        let score = series.add_scalar(-series.mean());
        let information = DMatrix::identity(n, n).add_scalar(-1.0 / n as f64);
        (Parts { information, score }, states)
    }

    #[test]
    fn path_of_a_telegraph_is_found() {
        for seed in 0..10 {
            let (parts, states) = telegraph(120, 3.0, seed);
            let path = parts.path().expect("a path");
            let wrong = path.up.iter().zip(&states).filter(|(a, b)| a != b).count();
            // Which level is called the first is a matter of chance.
            let wrong = wrong.min(120 - wrong);
            assert!(wrong < 12, "{seed}: {wrong}");
            // As high as if the states were known.
            let known = DVector::from_iterator(120, states.iter().map(|up| f64::from(*up)));
            let height = known.dot(&parts.score) / known.dot(&(&parts.information * &known));
            assert_close!(path.height.abs(), height, 0.3);
            assert!(path.odds() > 20.0, "{seed}: {path:?}");
        }
    }

    /// The odds for a path are honest: of white noise they exceed 100 in one series of a hundred at most.
    #[test]
    fn white_noise_does_not_pay_for_a_path() {
        let pays = |seed: &u64| {
            let path = telegraph(60, 0.0, *seed).0.path();
            path.is_some_and(|path| path.odds() > 100.0_f64.ln())
        };
        assert!((0..300).filter(pays).count() <= 6);
    }

    /// What a path says of itself is what the matrices say of it.
    #[test]
    fn statistic_is_that_of_the_path() {
        let (parts, _) = telegraph(80, 2.0, 3);
        let path = parts.path().expect("a path");
        let along = DVector::from_iterator(80, path.up.iter().map(|up| f64::from(*up)));
        let pull = along.dot(&parts.score);
        let information = along.dot(&(&parts.information * &along));
        assert_close!(path.statistic, pull * pull / information, 1e-9 * path.statistic);
        assert_close!(path.height, pull / information, 1e-9);
        assert_eq!(path.switches, switches(&path.up));
    }

    #[test]
    fn what_is_constant_has_no_path() {
        let (parts, _) = telegraph(60, 0.0, 1);
        let nothing = Parts { score: DVector::zeros(60), ..parts };
        assert_eq!(nothing.path(), None);
        let none = Parts { information: DMatrix::zeros(0, 0), score: DVector::zeros(0) };
        assert_eq!(none.path(), None);
    }
}
