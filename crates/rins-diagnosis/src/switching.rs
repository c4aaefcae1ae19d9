//! Biases that switch between two levels, which pass for flicker as long as nobody asks.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{Estimate, Evidence, Fit, Indefinite};

use crate::case::{Case, WEAKER};
use crate::diagnosis::FALSE_ALARMS;
use crate::disturbance::CHANNELS;
use crate::levels::{Path, two_levels};
use crate::residuals::{ABOUT_AXIS, residuals};
use crate::structure::Structure;
use crate::unexplained::{Unexplained, worst};

/// The biases that may switch.
const BIASES: [&str; 6] =
    ["gyro.bias.x", "gyro.bias.y", "gyro.bias.z", "accel.bias.x", "accel.bias.y", "accel.bias.z"];

/// Over how many epochs rates are made of an encoder's readings.
const OVER: [usize; 4] = [2, 4, 8, 16];

impl Case<'_> {
    /// Biases that switch between two levels, where that explains more than the flicker that was found.
    ///
    /// The times come from the most likely path of what a sensor reads beyond the model, as if all noise were white; whether
    /// it explains the run is then asked of the filter, with the flicker that was found and with less.
    ///
    /// `explained` is what the logarithm of the odds has to exceed: that of the effects which may have passed for it.
    pub(crate) fn switching(
        &self,
        fit: &Fit,
        explained: f64,
    ) -> Result<Vec<Unexplained>, Indefinite> {
        let mut found = Vec::new();
        for run in 0..self.runs.len() {
            let residuals = residuals(&self.runs[run], fit, run);
            let each = residuals
                .par_iter()
                .enumerate()
                .map(|(channel, residuals)| self.switches(fit, run, channel, residuals));
            let of_run: Result<Vec<_>, Indefinite> = each.collect();
            let over = |one: &Unexplained| one.ln_p < FALSE_ALARMS.ln() - explained;
            found.extend(of_run?.into_iter().flatten().filter(over));
        }
        Ok(found)
    }

    /// The bias of one channel, if it may be one that switches.
    fn switches(
        &self,
        fit: &Fit,
        run: usize,
        channel: usize,
        residuals: &[f64],
    ) -> Result<Option<Unexplained>, Indefinite> {
        let linear = &fit.linear[run];
        let samples: Vec<Range<usize>> = linear.samples().collect();
        let path = if channel == ABOUT_AXIS {
            let increments = &self.runs[run].recording.increments;
            let turned = residuals.iter().zip(increments).map(|(rate, one)| rate * one.interval);
            about_axis(&running_sum(turned), &samples)
        } else {
            two_levels(&means(residuals, &samples))
        };
        let Some(path) = path else { return Ok(None) };
        let known = self.of_run(fit, run);
        let own = known.iter().position(|estimate| estimate.parameter.id == BIASES[channel]);
        // What does not pay even if all is white does not pay beside flicker.
        let tests = (self.runs.len() * BIASES.len()) as f64;
        let (Some(own), true) = (own, path.odds() > tests.ln() - FALSE_ALARMS.ln()) else {
            return Ok(None);
        };
        let apart = linear.in_groups(&[own], &path.states, 1);
        let mut odds = Odds::default();
        for part in WEAKER {
            let mut noise = fit.noise[run];
            let triad = if channel < 3 { &mut noise.imu.gyro } else { &mut noise.imu.accel };
            triad.flicker *= part;
            odds.ask(&Evidence::of(&apart, &noise)?, &known, own);
        }
        let ln_p = tests.ln() + path.cost(odds.statistic) - odds.gain();
        Ok(Some(Unexplained {
            run,
            channel: CHANNELS[channel],
            structure: Structure::Switching(path.switches),
            of: None,
            ln_p,
            amplitude: Some((odds.height.abs(), known[own].parameter.unit)),
            worst: worst(fit, odds.statistic),
        }))
    }
}

/// The most likely path of the gyro about the axis, of which only the angle since the start is read.
///
/// Readings of an encoder make poor rates from one epoch to the next: they are taken over several, as many as pay best.
fn about_axis(angles: &[f64], samples: &[Range<usize>]) -> Option<Path> {
    let angles = means(angles, samples);
    let over = |count: usize| {
        let blocks: Vec<f64> = angles.chunks_exact(count).map(mean).collect();
        let rates: Vec<f64> = blocks.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let path = two_levels(&rates)?;
        // From the middle of a block to the middle of the next.
        let rate_of =
            |epoch: usize| (epoch.saturating_sub(count / 2) / count).min(path.states.len() - 1);
        let states = (0..angles.len()).map(|epoch| path.states[rate_of(epoch)]).collect();
        Some(Path { states, ..path })
    };
    let paths = OVER.into_iter().filter_map(over);
    paths.max_by(|a, b| a.odds().total_cmp(&b.odds()))
}

fn running_sum(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = 0.0;
    let add = |value| {
        sum += value;
        sum
    };
    values.map(add).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The mean of each epoch's samples.
fn means(values: &[f64], samples: &[Range<usize>]) -> Vec<f64> {
    samples.iter().map(|of| mean(&values[of.clone()])).collect()
}

/// How much likelier a run is with a step of known times, each with the noise that suits it best.
struct Odds {
    without: f64,
    with: f64,
    /// Of the noise that suits best: how high the step is, in SI units, and by how much the squares fall with it.
    height: f64,
    statistic: f64,
}

impl Default for Odds {
    fn default() -> Self {
        let none = f64::NEG_INFINITY;
        Self { without: none, with: none, height: 0.0, statistic: 0.0 }
    }
}

impl Odds {
    /// Asks with one noise; the step is the last of the evidence's parameters.
    fn ask(&mut self, evidence: &Evidence, known: &[&Estimate], own: usize) {
        let n = known.len();
        let scales = DVector::from_fn(n + 1, |place, _| {
            known[if place < n { place } else { own }].parameter.sigma
        });
        let information = DMatrix::from_fn(n + 1, n + 1, |row, column| {
            evidence.information[(row, column)] * scales[row] * scales[column]
        });
        let off = DVector::from_fn(n, |place, _| {
            (known[place].value - known[place].expected) / scales[place]
        });
        let score = evidence.score.component_mul(&scales);
        let corner = information.view((0, 0), (n, n)) + DMatrix::identity(n, n);
        let Some(factor) = Cholesky::new(corner) else { return };
        let pulled = score.rows(0, n) - &off;
        let across = information.view((0, n), (n, 1)).into_owned();
        let log_det: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
        let squares = evidence.square + off.norm_squared() - pulled.dot(&factor.solve(&pulled));
        let without = -0.5 * squares - evidence.log_determinant - log_det;
        let left = information[(n, n)] - across.dot(&factor.solve(&across));
        let pull = score[n] - across.dot(&factor.solve(&pulled));
        if left <= 0.0 {
            return;
        }
        let statistic = pull * pull / left;
        self.without = self.without.max(without);
        if without + 0.5 * statistic > self.with {
            self.with = without + 0.5 * statistic;
            self.statistic = statistic;
            self.height = pull / left * scales[n];
        }
    }

    fn gain(&self) -> f64 {
        self.with - self.without
    }
}
