//! Step control and convergence of the iteration.

use nalgebra::{DMatrix, DVector};

use crate::linear::Pieces;

/// Convergence: the largest step in units of the posterior sigma.
const CONVERGED: f64 = 1e-3;

/// The cosine of the angle between a step and the reversed previous step above which the iteration oscillates.
const TURNING_BACK: f64 = 0.5;

/// Where the likelihood is not smooth, as for a dead zone, no step vanishes. An oscillating step below this many sigmas
/// converges by damping.
const ON_EDGE: f64 = 0.1;

/// A remaining distance, in sigmas, that is negligible: it increases the mean square error by one percent.
const NEGLIGIBLE: f64 = 0.1;

/// The factor by which the damping of small steps is reduced without oscillation; the reduction is smaller than the preceding
/// increase, which ensures convergence.
const BOLDER: f64 = 1.2;

/// Where the likelihood is not smooth in many places, as for several dead zones, the steps do not converge. The iteration
/// ends if for this number of successive iterations ...
const ABOUT: usize = 10;

/// ... the sums of squares differ by at most this, which is not significant.
const ROUGH: f64 = 2.0;

/// The criterion that ends an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Until {
    /// The parameters change so little that the noise can be estimated.
    NearEnough,
    /// The parameters are as near the estimate as the comparison of models needs.
    Approximate,
    /// The parameters have converged.
    Converged,
}

impl Until {
    /// The resolution of the derivatives at the end.
    pub(crate) const fn pieces(self) -> Pieces {
        match self {
            Self::NearEnough | Self::Approximate => Pieces::Coarse,
            Self::Converged => Pieces::Samples,
        }
    }
}

/// Damping of the steps. Oscillating steps are halved, since a weakly observable azimuth would otherwise oscillate; small
/// ones are halved repeatedly, which converges on a discontinuity of the gradient.
pub(crate) struct Damping {
    /// The last step, in sigmas.
    last: Option<DVector<f64>>,
    /// The fraction of it that was taken.
    part: f64,
}

/// A step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stride {
    /// The largest component of the full step, in sigmas.
    pub(crate) to_estimate: f64,
    /// The fraction of it that is taken.
    pub(crate) part: f64,
}

impl Damping {
    pub(crate) const fn none() -> Self {
        Self { last: None, part: 1.0 }
    }

    /// The damped step for a full step in sigmas.
    pub(crate) fn stride(&mut self, step: DVector<f64>) -> Stride {
        let turns_back = self
            .last
            .as_ref()
            .is_some_and(|last| step.dot(last) < -TURNING_BACK * step.norm() * last.norm());
        let to_estimate = step.amax();
        let before = if to_estimate < ON_EDGE { self.part } else { 1.0 };
        self.part = if turns_back { 0.5 * before } else { (BOLDER * before).min(1.0) };
        self.last = Some(step);
        Stride { to_estimate, part: self.part }
    }
}

impl Stride {
    /// Whether the iteration has converged.
    pub(crate) fn is_over(self) -> bool {
        let on_edge = self.to_estimate < ON_EDGE && self.part * self.to_estimate < CONVERGED;
        self.to_estimate < CONVERGED || on_edge
    }
}

/// Whether the remaining distance after the last two steps, in sigmas, is negligible. It is the sum of the geometric series
/// that they begin, limited to `steps` further steps.
pub(crate) fn leaves_little([before, last]: [f64; 2], steps: usize) -> bool {
    let ratio = last / before;
    let series = if ratio < 1.0 { ratio / (1.0 - ratio) } else { f64::INFINITY };
    last * series.min(steps as f64) < NEGLIGIBLE
}

/// The values of an iteration.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// The sum of squares of data and priors.
    pub(crate) squares: f64,
    pub(crate) values: Vec<f64>,
}

/// A flat region of a non-smooth likelihood, in which all values are equally good.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bottom {
    /// The values with the smallest sum of squares.
    pub(crate) best: Vec<f64>,
    /// The mean squared distance of the other values from them: an additional covariance of the estimate.
    pub(crate) about: DMatrix<f64>,
}

impl Bottom {
    /// The region in which the last iterations lie, if there is one.
    pub(crate) fn of(visited: &[Place]) -> Option<Self> {
        let last = &visited[visited.len().checked_sub(ABOUT)?..];
        let most = last.iter().map(|place| place.squares).fold(f64::NEG_INFINITY, f64::max);
        let least = last.iter().min_by(|a, b| a.squares.total_cmp(&b.squares))?;
        let best = least.values.clone();
        let mut about = DMatrix::zeros(best.len(), best.len());
        for place in last {
            let off = place.values.iter().zip(&best).map(|(other, best)| other - best);
            let off = DVector::from_iterator(best.len(), off);
            about.ger(1.0 / ABOUT as f64, &off, &off, 1.0);
        }
        (most - least.squares <= ROUGH).then_some(Self { best, about })
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn steps_that_sigmas_hide_are_few_or_small() {
        for (before, last, little) in [
            (0.004, 0.004, true),
            (0.003, 0.0045, true),
            (0.05, 0.03, true),
            (0.02, 0.0199, false),
            (0.2, 0.1, false),
            (1.0, 0.2, true),
            (0.0, 0.01, false),
            (f64::NAN, f64::NAN, false),
        ] {
            assert_eq!(leaves_little([before, last], 20), little, "{before} {last}");
        }
    }

    use super::*;
    use rins_testing::assert_close;

    /// Iterates damped steps; the result is the final value and the number of steps.
    fn ends(mut place: f64, step: impl Fn(f64) -> f64) -> Option<(f64, usize)> {
        let mut damping = Damping::none();
        for count in 1..=30 {
            let whole = step(place);
            let stride = damping.stride(DVector::from_element(1, whole));
            place += stride.part * whole;
            if stride.is_over() {
                return Some((place, count));
            }
        }
        None
    }

    #[test]
    fn steps_end_on_an_edge_that_they_go_to_and_fro_over() {
        for start in [-1.0, -0.07, 0.02, 0.4] {
            let to_other_side = |place: f64| if place > 0.013 { -0.05 } else { 0.06 };
            let (end, _) = ends(start, to_other_side).expect("it ends");
            assert_close!(end, 0.013, 2.0 * CONVERGED);
        }
    }

    #[test]
    fn steps_that_swing_too_far_end_where_they_vanish() {
        let (end, _) = ends(3.0, |place| -1.95 * place).expect("it ends");
        assert_close!(end, 0.0, CONVERGED);
    }

    #[test]
    fn steps_that_lead_straight_there_are_taken_whole() {
        assert_eq!(ends(3.0, |place| -place), Some((0.0, 2)));
    }

    #[test]
    fn a_large_step_to_and_fro_never_counts_as_an_end() {
        assert_eq!(ends(1.0, |place| if place > 0.0 { -1.0 } else { 1.0 }), None);
    }

    fn at(squares: f64, value: f64) -> Place {
        Place { squares, values: vec![value, 5.0] }
    }

    /// A descent, then an oscillation between 2 and 4 with the best value at 3.
    #[test]
    fn rough_bottom_ends_at_its_best_and_is_as_uncertain_as_wide() {
        let mut visited = vec![at(900.0, 40.0), at(300.0, 20.0)];
        visited.extend([2.0, 4.0].repeat(ABOUT / 2 - 1).into_iter().map(|value| at(101.5, value)));
        assert_eq!(Bottom::of(&visited), None, "part of the slope is among the last");
        visited.extend([at(100.0, 3.0), at(101.0, 3.0)]);
        let Bottom { best, about } = Bottom::of(&visited).expect("it goes about");
        assert_eq!(best, [3.0, 5.0]);
        assert_close!(about[(0, 0)], 0.8, 1e-12);
        assert_eq!((about[(0, 1)], about[(1, 1)]), (0.0, 0.0));
    }

    #[test]
    fn a_valley_that_still_falls_is_no_bottom() {
        let falling: Vec<Place> = (0..20_u8).map(|n| at(100.0 - f64::from(n), 1.0)).collect();
        assert_eq!(Bottom::of(&falling), None);
        assert_eq!(Bottom::of(&falling[..3]), None);
        let nowhere: Vec<Place> = (0..20_u8).map(|_| at(f64::NAN, 1.0)).collect();
        assert_eq!(Bottom::of(&nowhere), None);
    }
}
