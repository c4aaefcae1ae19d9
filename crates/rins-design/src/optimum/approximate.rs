//! Approximate designs: the share of each candidate in the observations, and how far it is from the best.

use nalgebra::DVector;
use rayon::prelude::*;

use super::criterion::{Criterion, Tangent};
use super::element::{Element, State, usefulness};

/// The shares of candidates in a design that is nearly optimal, with the proof.
///
/// The criterion is convex in the information, so that no design is better than the tangent at this one allows: by the equivalence theorem
/// (‹kiefer1960›, ‹pukelsheim2006›) the gap is zero for the optimum only.
#[derive(Clone, Debug, PartialEq)]
pub struct ApproximateDesign {
    /// The share of each candidate; the sum is one.
    pub weights: Vec<f64>,
    /// The value of the criterion, as [`Criterion::value`].
    pub value: f64,
    /// An upper bound of what any other design of the same candidates gains, relative to the variance, the geometric mean of variances, or
    /// the squared distance.
    pub gap: f64,
    /// The number of steps.
    pub steps: usize,
}

/// The largest number of steps.
const MOST_STEPS: usize = 1000;

/// The number of steps after which all candidates are considered again.
const STEPS_AT_A_TIME: usize = 12;

/// The number of candidates that are added then.
const NEWCOMERS: usize = 4;

/// The usefulness, relative to the mean, above which a candidate with any share is kept.
const USEFUL: f64 = 0.9;

/// The share, relative to that of an even design, below which a candidate is dropped unless it is useful.
const SLIGHT: f64 = 0.02;

/// The share below which a candidate is not part of a design.
pub(super) const NEGLIGIBLE: f64 = 1e-9;

/// The number of evaluations for the length of an exchange.
const HALVINGS: usize = 6;

/// The ratio of lengths that are tried first.
const COARSE: f64 = 8.0;

impl ApproximateDesign {
    /// The design of these candidates that minimizes a criterion, with the information `prior` (diagonal, p) in addition. That of the prior on
    /// each parameter of a group is one.
    ///
    /// A step is a multiplicative one (‹titterington1976›), which reaches the neighborhood of the optimum, and an exchange between the least
    /// and the most useful candidate (‹bohning1986›), whose length minimizes the criterion. The steps end at the gap `close`, or after a
    /// thousand of them.
    ///
    /// `None` if the candidates and the prior together leave a parameter of the criterion undetermined.
    ///
    /// ```
    /// use nalgebra::{DMatrix, DVector};
    /// use rins_design::{ApproximateDesign, Criterion, Element};
    /// // A line through readings at -1, 0 and 1: the best design has half of them at either end.
    /// let reading = |x: f64| {
    ///     let row = DVector::from_vec(vec![1.0, x]);
    ///     Element { group: 0, information: &row * row.transpose() }
    /// };
    /// let candidates = [-1.0, 0.0, 1.0].map(reading);
    /// let criterion = Criterion::Determinant(DMatrix::identity(2, 2));
    /// let design =
    ///     ApproximateDesign::of(&DVector::zeros(2), &candidates, &criterion, 3e-3).unwrap();
    /// assert!(design.gap < 0.01 && (design.weights[0] - 0.5).abs() < 0.01);
    /// ```
    pub fn of(
        prior: &DVector<f64>,
        elements: &[Element],
        criterion: &Criterion,
        close: f64,
    ) -> Option<Self> {
        let count = elements.len();
        Self::from_start(prior, elements, criterion, (vec![1.0 / count as f64; count], close))
    }

    /// The same from a start: the shares of a similar design.
    pub(super) fn from_start(
        prior: &DVector<f64>,
        elements: &[Element],
        criterion: &Criterion,
        (mut weights, close): (Vec<f64>, f64),
    ) -> Option<Self> {
        let mut steps = 0;
        loop {
            let state = State::of(prior, elements, &weights);
            let now = Sensitivities::of(criterion, &state, elements, &weights)?;
            if now.gap < close || steps >= MOST_STEPS {
                let value = criterion.value(&state.marginal()?.0)?;
                return Some(Self { weights, value, gap: now.gap, steps });
            }
            // Only the candidates in use, and the most useful others, take part in the next steps.
            let active = now.active(&weights);
            let some: Vec<Element> = active.iter().map(|&place| elements[place].clone()).collect();
            let mut shares: Vec<f64> = active.iter().map(|&place| weights[place]).collect();
            normalize(&mut shares);
            for _ in 0..STEPS_AT_A_TIME {
                steps += 1;
                let state = State::of(prior, &some, &shares);
                let now = Sensitivities::of(criterion, &state, &some, &shares)?;
                if now.gap < 0.3 * close {
                    break;
                }
                exchange(criterion, &some, &state, &mut shares, &now.each);
                let state = State::of(prior, &some, &shares);
                let now = Sensitivities::of(criterion, &state, &some, &shares)?;
                now.multiply(&mut shares, criterion);
            }
            weights.fill(0.0);
            for (&place, share) in active.iter().zip(shares) {
                weights[place] = share;
            }
        }
    }

    /// The same candidates with other shares; the gap is to the same bound.
    pub(super) fn with_weights(
        &self,
        weights: Vec<f64>,
        prior: &DVector<f64>,
        elements: &[Element],
        criterion: &Criterion,
    ) -> Option<Self> {
        let (marginal, _) = State::of(prior, elements, &weights).marginal()?;
        let value = criterion.value(&marginal)?;
        let gap = criterion.gap(value, criterion.bound(self.value, self.gap));
        Some(Self { weights, value, gap, steps: self.steps })
    }
}

/// What an additional share of each candidate is worth.
struct Sensitivities {
    each: Vec<f64>,
    /// What priors and parameters of groups contribute to the multiplicative step.
    of_prior: f64,
    gap: f64,
}

impl Sensitivities {
    fn of(
        criterion: &Criterion,
        state: &State,
        elements: &[Element],
        weights: &[f64],
    ) -> Option<Self> {
        let (marginal, absorbed) = state.marginal()?;
        let Tangent { directions, scale, slack, .. } = criterion.tangent(&marginal)?;
        let worth = |element: &Element| usefulness(&directions, &absorbed, element);
        let each: Vec<f64> = elements.par_iter().with_min_len(16).map(worth).collect();
        let most = each.iter().copied().fold(0.0, f64::max);
        let mean: f64 = each.iter().zip(weights).map(|(one, weight)| one * weight).sum();
        let whole = directions.dot(&(&marginal * &directions));
        Some(Self { each, of_prior: (whole - mean).max(0.0), gap: (most - mean + slack) / scale })
    }

    /// The candidates that have a considerable share or are useful.
    fn active(&self, weights: &[f64]) -> Vec<usize> {
        let mean: f64 = self.each.iter().zip(weights).map(|(one, weight)| one * weight).sum();
        let slight = SLIGHT / weights.len() as f64;
        let is_kept = |place: &usize| {
            weights[*place] > slight || weights[*place] > 0.0 && self.each[*place] > USEFUL * mean
        };
        let (mut active, mut others): (Vec<usize>, Vec<usize>) =
            (0..weights.len()).partition(is_kept);
        others.retain(|place| self.each[*place] > mean);
        others.sort_by(|&a, &b| self.each[b].total_cmp(&self.each[a]));
        active.extend(others.into_iter().take(NEWCOMERS));
        active
    }

    /// A multiplicative step.
    fn multiply(&self, weights: &mut [f64], criterion: &Criterion) {
        let power = if matches!(criterion, Criterion::Determinant(_)) { 1.0 } else { 0.5 };
        for (weight, one) in weights.iter_mut().zip(&self.each) {
            *weight *= (one + self.of_prior).powf(power);
        }
        normalize(weights);
    }
}

fn normalize(weights: &mut [f64]) {
    let all: f64 = weights.iter().sum();
    for weight in weights.iter_mut() {
        *weight /= all;
        if *weight < NEGLIGIBLE {
            *weight = 0.0;
        }
    }
    let all: f64 = weights.iter().sum();
    for weight in weights {
        *weight /= all;
    }
}

/// Moves the share of the least useful candidate to the most useful one, as far as that improves.
fn exchange(
    criterion: &Criterion,
    elements: &[Element],
    state: &State,
    weights: &mut [f64],
    each: &[f64],
) {
    let all = || 0..each.len();
    let Some(best) = all().max_by(|&a, &b| each[a].total_cmp(&each[b])) else { return };
    let used = all().filter(|&place| weights[place] > 0.0);
    let Some(worst) = used.min_by(|&a, &b| each[a].total_cmp(&each[b])) else { return };
    if best == worst {
        return;
    }
    // The derivative by the share is negative as long as the best candidate remains more useful.
    let gains = |share: f64| {
        let mut moved = state.clone();
        moved.add(&elements[best], share);
        moved.add(&elements[worst], -share);
        moved.marginal().is_some_and(|(marginal, absorbed)| {
            criterion.tangent(&marginal).is_some_and(|Tangent { directions, .. }| {
                let [best, worst] =
                    [best, worst].map(|place| usefulness(&directions, &absorbed, &elements[place]));
                best > worst
            })
        })
    };
    let whole = weights[worst];
    let share = if gains(whole) { whole } else { between(whole, gains) };
    weights[best] += share;
    weights[worst] -= share;
    if weights[worst] < NEGLIGIBLE {
        weights[worst] = 0.0;
    }
}

/// The share below `whole` up to which an exchange gains, on a logarithmic scale: where a prior is weak, a share of a millionth may count.
fn between(whole: f64, gains: impl Fn(f64) -> bool) -> f64 {
    let mut high = whole;
    let mut low = whole / COARSE;
    while !gains(low) {
        high = low;
        low /= COARSE;
        if low < NEGLIGIBLE {
            return 0.0;
        }
    }
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if gains(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use rins_testing::assert_close;

    use nalgebra::DMatrix;

    use super::*;

    fn polynomial(degree: i32, grid: i32) -> (Vec<f64>, Vec<Element>) {
        let points: Vec<f64> =
            (-grid..=grid).map(|step| f64::from(step) / f64::from(grid)).collect();
        let reading = |x: &f64| {
            let row = DVector::from_iterator(
                usize::try_from(degree + 1).unwrap(),
                (0..=degree).map(|power| x.powi(power)),
            );
            Element { group: 0, information: &row * row.transpose() }
        };
        let elements = points.iter().map(reading).collect();
        (points, elements)
    }

    fn shares(points: &[f64], weights: &[f64], at: &[f64], within: f64) -> Vec<f64> {
        let near = |center: &f64| {
            let of = points.iter().zip(weights).filter(|(x, _)| (**x - center).abs() < within);
            of.map(|(_, weight)| weight).sum()
        };
        at.iter().map(near).collect()
    }

    /// The D-optimal design for a polynomial has equal shares at the zeros of `(1 - x²) P'ₙ(x)` (Guest 1958, Hoel 1958).
    #[test]
    fn polynomials_are_read_at_the_zeros_of_legendre() {
        for (degree, support) in [
            (2, vec![-1.0, 0.0, 1.0]),
            (3, vec![-1.0, -(0.2_f64.sqrt()), 0.2_f64.sqrt(), 1.0]),
            (4, vec![-1.0, -((3.0 / 7.0_f64).sqrt()), 0.0, (3.0 / 7.0_f64).sqrt(), 1.0]),
        ] {
            let (points, elements) = polynomial(degree, 100);
            let size = support.len();
            let criterion = Criterion::Determinant(DMatrix::identity(size, size));
            let design =
                ApproximateDesign::of(&DVector::zeros(size), &elements, &criterion, 1e-3).unwrap();
            assert!(design.gap < 0.002, "{degree}: {}", design.gap);
            for share in shares(&points, &design.weights, &support, 0.04) {
                assert_close!(share, 1.0 / size as f64, 0.01);
            }
        }
    }

    /// The c-optimal design for the slope of a cubic's extrapolation at 2 is that of Chebyshev's points (Hoel & Levine 1964).
    #[test]
    fn extrapolation_is_from_the_points_of_chebyshev() {
        let (points, elements) = polynomial(2, 100);
        let at = DMatrix::from_column_slice(3, 1, &[1.0, 2.0, 4.0]);
        let design =
            ApproximateDesign::of(&DVector::zeros(3), &elements, &Criterion::Variance(at), 1e-3)
                .unwrap();
        assert!(design.gap < 0.005, "{}", design.gap);
        // Shares are proportional to the Lagrange polynomials at 2, which are 1, -3 and 3.
        let got = shares(&points, &design.weights, &[-1.0, 0.0, 1.0], 0.04);
        for (got, want) in got.iter().zip([1.0 / 7.0, 3.0 / 7.0, 3.0 / 7.0]) {
            assert_close!(*got, want, 0.01);
        }
        assert_close!(design.value, 49.0, 0.3); // the square of the Chebyshev polynomial T₂(2) = 7
    }

    #[test]
    fn gap_of_a_bad_design_bounds_the_best() {
        let (_, elements) = polynomial(2, 10);
        let signature = |place: usize| (vec![place], DVector::from_element(1, 1.0));
        for criterion in [
            Criterion::Variance(DMatrix::identity(3, 3)),
            Criterion::Determinant(DMatrix::identity(3, 3)),
            Criterion::Distance(vec![signature(0), signature(2)]),
        ] {
            let prior = DVector::from_element(3, 0.1);
            let best = ApproximateDesign::of(&prior, &elements, &criterion, 1e-3).unwrap();
            assert!(best.gap < 0.02, "{criterion:?}: {}", best.gap);
            let even = vec![1.0 / 21.0; 21];
            let state = State::of(&prior, &elements, &even);
            let bad = Sensitivities::of(&criterion, &state, &elements, &even).unwrap();
            let value = criterion.value(&state.marginal().unwrap().0).unwrap();
            assert!(bad.gap > 0.1, "{criterion:?}: {}", bad.gap);
            assert!(best.value < value, "{criterion:?}");
            assert!(criterion.bound(value, bad.gap) <= best.value, "{criterion:?}");
            let efficiency = criterion.efficiency(value, best.value);
            assert!((0.2..0.99).contains(&efficiency), "{criterion:?}: {efficiency}");
        }
    }
}
