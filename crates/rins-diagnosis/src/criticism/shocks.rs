//! Shocks: a door that slams, a hammer next door. They are over within a fraction of a second, too soon for an epoch to show
//! them, and too few of many samples for the noise to have heavy tails.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};
use rins_bayes::ln_tail;
use rins_estimation::Fit;

use crate::case::Case;
use crate::criticism::residuals::{ABOUT_AXIS, residuals};
use crate::criticism::structure::Structure;
use crate::criticism::tails::jolted;
use crate::criticism::unexplained::Unexplained;
use crate::generic::disturbance::CHANNELS;
use crate::median::median_about;

/// Over so many samples a shock is looked for.
const WIDTHS: [usize; 3] = [16, 32, 64];

/// The spread about a stretch is that of so many on each side.
const AROUND: usize = 64;

/// Shocks stand far out: the spread that they are held against is known to a few per cent only.
const LEAST: f64 = -20.0;

/// Over a shock a table changes its rate by no more than this part of its fastest.
const STEADY: f64 = 0.02;

/// A stretch of a series that stands out of its spread, with the logarithm of the chance of that.
struct Standing {
    samples: Range<usize>,
    ln_p: f64,
}

impl Case<'_> {
    /// The sensor of a run that shows the strongest shock, if any does, and the samples of all its shocks.
    pub(crate) fn shocks(&self, fit: &Fit, run: usize) -> Option<(Unexplained, Vec<Range<usize>>)> {
        let mut all = residuals(&self.runs[run], fit, run);
        let jolts = jolted(fit, run);
        let angles = fit.linear[run].track().angles();
        for series in &mut all {
            take_turn_out(series, angles);
        }
        let turned = angles.windows(2).map(|ends| (ends[1] - ends[0]).abs());
        let fastest = turned.fold(0.0, f64::max);
        // A base that tips over, or a table that changes its rate, shakes the sensors too.
        let is_known = |one: &Standing| {
            let Range { start, end } = one.samples;
            let width = end - start;
            let (before, after) =
                (start.saturating_sub(width), (end + width).min(angles.len() - 1));
            let middle = usize::midpoint(before, after);
            let rate = |first: usize, last: usize| {
                (angles[last] - angles[first]) / (last - first).max(1) as f64
            };
            let changed = (rate(before, middle) - rate(middle, after)).abs();
            changed > STEADY * fastest
                || jolts.iter().any(|jolt| jolt.start < end && start < jolt.end)
        };
        // About its axis the encoder's noise is seen, which is no white one.
        let seen =
            |channel: &usize| *channel != ABOUT_AXIS && !self.rounding.is_coarse(run, *channel);
        let strongest = |channel: usize| {
            let mut standing = standing(&all[channel]);
            standing.retain(|one| !is_known(one));
            Some((channel, standing.first()?.ln_p, standing))
        };
        let channels = (0..all.len()).filter(seen).filter_map(strongest);
        let (channel, ln_p, standing) = channels.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let recorded = &self.runs[run].recording;
        let at = recorded.times[standing[0].samples.start] - recorded.times[0];
        let tests = (all.len() * self.runs.len()) as f64;
        let one = Unexplained {
            run,
            channel: CHANNELS[channel],
            structure: Structure::Shocks(standing.len(), at),
            of: None,
            ln_p: ln_p + tests.ln(),
            amplitude: None,
            worst: Vec::new(),
        };
        Some((one, standing.into_iter().map(|one| one.samples).collect()))
    }
}

/// Takes its mean and what comes once a turn out of a series: where the axis does not stand as it was surveyed it is no line,
/// if samples are so few that the table turns far in a stretch of them.
fn take_turn_out(series: &mut [f64], angles: &[f64]) {
    let turn = || {
        angles.windows(2).map(|ends| {
            let (sin, cos) = (0.5 * (ends[0] + ends[1])).sin_cos();
            Vector3::new(1.0, cos, sin)
        })
    };
    let (mut information, mut score) = (Matrix3::zeros(), Vector3::zeros());
    for (shape, value) in turn().zip(&*series) {
        information += shape * shape.transpose();
        score += shape * *value;
    }
    // A table that stands shows no turn.
    let Ok(found) = information.svd(true, true).solve(&score, 1e-9 * series.len() as f64) else {
        return;
    };
    for (shape, value) in turn().zip(series) {
        *value -= shape.dot(&found);
    }
}

/// The stretches of a series whose squares stand out of those about them, strongest first, each once; a single large value is
/// no shock.
fn standing(series: &[f64]) -> Vec<Standing> {
    let mut found: Vec<Standing> = Vec::new();
    for width in WIDTHS {
        let step = width / 2;
        let squares: Vec<f64> = series.windows(width).step_by(step).map(squares).collect();
        let tests = ((squares.len() * WIDTHS.len()) as f64).ln();
        let dof = width - 3;
        // The median of a chi-square, by Wilson and Hilferty.
        let middle = dof as f64 * (1.0 - 2.0 / (9.0 * dof as f64)).powi(3);
        for (place, square) in squares.iter().enumerate() {
            let usual = median_about(&squares, place, AROUND) / middle;
            if usual.is_nan() || usual <= 0.0 || *square < 2.0 * middle * usual {
                continue;
            }
            let ln_p = ln_tail(square / usual, dof) + tests;
            if ln_p < LEAST {
                let first = place * step;
                found.push(Standing { samples: first..first + width, ln_p });
            }
        }
    }
    found.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
    let mut apart: Vec<Standing> = Vec::new();
    for one in found {
        let reach = 2 * (one.samples.end - one.samples.start);
        let is_beside = |other: &Standing| {
            other.samples.start < one.samples.end + reach
                && one.samples.start < other.samples.end + reach
        };
        if !apart.iter().any(is_beside) {
            apart.push(one);
        }
    }
    apart
}

/// The squares of some values about a line through them, for what turns with the table is left in them, but for the one that
/// is farthest from the others'.
fn squares(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let mean = values.iter().sum::<f64>() / n;
    let places = || (0..values.len()).map(|place| place as f64 - middle);
    let along: f64 = places().zip(values).map(|(place, value)| place * value).sum();
    let spread = n * (n * n - 1.0) / 12.0;
    let (mut sum, mut most) = (0.0, 0.0_f64);
    for (place, value) in places().zip(values) {
        let square = (value - mean - along / spread * place).powi(2);
        sum += square;
        // What the sum loses without it, the line being through the others.
        most = most.max(square / (1.0 - 1.0 / n - place * place / spread));
    }
    sum - most
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal, StudentT};
    use rand_pcg::Pcg64;

    fn noise(distribution: impl Distribution<f64>, seed: u64) -> Vec<f64> {
        distribution.sample_iter(Pcg64::seed_from_u64(seed)).take(40_000).collect()
    }

    #[test]
    fn noise_holds_no_shock() {
        for seed in 0..20 {
            let mut drifting = noise(StandardNormal, seed);
            for (place, value) in drifting.iter_mut().enumerate() {
                // Louder by and by, on what goes up and down, from the middle on faster.
                let part = place as f64 / 40_000.0;
                let cycles = if place < 20_000 { 30.0 } else { 110.0 };
                *value = *value * (1.0 + 3.0 * part)
                    + 5.0 * (std::f64::consts::TAU * cycles * part).sin();
            }
            assert!(standing(&drifting).is_empty(), "{seed}");
        }
        let mut knocked = noise(StandardNormal, 20);
        knocked[7_000] += 40.0;
        assert!(standing(&knocked).is_empty());
        assert!(standing(&noise(StudentT::new(6.0).unwrap(), 21)).is_empty());
        assert!(standing(&[0.0; 1000]).is_empty());
    }

    /// Readings so slow that a stretch of them is half a turn, of an axis that leans; then the table hurries.
    #[test]
    fn what_comes_once_a_turn_is_no_shock() {
        let angle =
            |place: i32| 0.01 * f64::from(place) + 0.04 * f64::from((place - 20_000).max(0));
        let angles: Vec<f64> = (0..=40_000).map(angle).collect();
        let mut leaning = noise(StandardNormal, 3);
        for (value, angle) in leaning.iter_mut().zip(&angles) {
            *value += 9.0 * (angle + 0.4).sin();
        }
        assert!(!standing(&leaning).is_empty());
        take_turn_out(&mut leaning, &angles);
        assert!(standing(&leaning).is_empty());
        let mut at_rest = noise(StandardNormal, 4);
        take_turn_out(&mut at_rest, &vec![1.3; 40_001]);
        let mean = at_rest.iter().sum::<f64>() / 40_000.0;
        let square = at_rest.iter().map(|value| value * value).sum::<f64>() / 40_000.0;
        assert!(mean.abs() < 1e-9 && (square - 1.0).abs() < 0.05, "{mean} {square}");
    }

    #[test]
    fn shocks_are_found_where_they_are() {
        let mut slammed = noise(StandardNormal, 1);
        for (at, size) in [(9_000, 7.0), (30_000, 9.0)] {
            for (place, value) in slammed[at..at + 60].iter_mut().enumerate() {
                let time = place as f64;
                *value += size * (-time / 15.0).exp() * (0.75 * time).sin();
            }
        }
        let found = standing(&slammed);
        let at: Vec<usize> = found.iter().map(|one| one.samples.start).collect();
        assert_eq!(at.len(), 2, "{at:?}");
        assert!(at[0].abs_diff(30_000) < 32 && at[1].abs_diff(9_000) < 32, "{at:?}");
    }
}
