//! The servo of the table: the actual table angle.

use rand_distr::{Distribution, StandardNormal};

use crate::random::Random;

/// A commanded rate with its duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The rate \[rad/s\].
    pub rate: f64,
    /// The duration \[s\].
    pub duration: f64,
}

/// Cogging: the rate is multiplied by `1 + c cos nζ + s sin nζ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// The harmonic order.
    pub order: f64,
    /// `c`, a fraction of the rate.
    pub cos: f64,
    /// `s`, a fraction of the rate.
    pub sin: f64,
}

/// The motor and servo of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The commanded motion.
    pub segments: Vec<Segment>,
    /// The acceleration at changes of rate \[rad/s²\].
    pub acceleration: f64,
    /// Whether the table has its first rate before the log begins.
    pub rolling: bool,
    /// The lag of the rate behind the command \[s\].
    pub lag: f64,
    /// The 1σ of the rate due to friction, correlated over some tenths of a second \[rad/s\].
    pub shake: f64,
    /// Its cogging.
    pub ripples: Vec<Ripple>,
}

/// The correlation time of the rate due to friction \[s\].
const SHAKE_TIME: f64 = 0.3;

/// The rate below which the table counts as stationary \[rad/s\].
const STILL: f64 = 1e-9;

/// The trajectory of the table, on a grid of short steps.
#[derive(Clone, Debug)]
pub(crate) struct Way {
    /// The table angle at each point of the grid \[rad\]; zero at the start of the run.
    pub(crate) angles: Vec<f64>,
    /// The last direction of rotation; zero before the first rotation.
    pub(crate) senses: Vec<f64>,
    /// The sign of the last change of rate; zero before the first change.
    pub(crate) rises: Vec<f64>,
}

impl Drive {
    /// The duration of the commanded motion \[s\].
    pub fn duration(&self) -> f64 {
        self.segments.iter().map(|segment| segment.duration).sum()
    }

    fn command(&self, time: f64) -> f64 {
        let mut end = 0.0;
        for segment in &self.segments {
            end += segment.duration;
            if time < end {
                return segment.rate;
            }
        }
        self.segments.last().map_or(0.0, |segment| segment.rate)
    }

    fn cogging(&self, angle: f64) -> f64 {
        let of = |ripple: &Ripple| {
            let (sin, cos) = (ripple.order * angle).sin_cos();
            ripple.cos * cos + ripple.sin * sin
        };
        1.0 + self.ripples.iter().map(of).sum::<f64>()
    }

    /// The trajectory from `lead` steps before the run on, in `steps` steps of length `step` \[s\].
    pub(crate) fn way(&self, step: f64, lead: usize, steps: usize, random: &mut Random) -> Way {
        let first = if self.rolling { self.command(0.0) } else { 0.0 };
        let mut angles = vec![0.0; lead + 1];
        for place in (0..lead).rev() {
            let after: f64 = angles[place + 1];
            let guess = after - step * first * self.cogging(after);
            angles[place] = after - step * first * self.cogging(0.5 * (after + guess));
        }
        let started = if self.rolling { first.signum() } else { 0.0 };
        let mut way =
            Way { angles, senses: vec![started; lead + 1], rises: vec![started; lead + 1] };
        let (mut told, mut rate, mut friction) = (first, first, 0.0);
        let kept: f64 = (-step / SHAKE_TIME).exp();
        let mut angle = 0.0;
        for index in 0..steps.saturating_sub(lead) {
            let command = self.command((index as f64 + 0.5) * step);
            let most = self.acceleration * step;
            let change = (command - told).clamp(-most, most);
            told += change;
            rate += (told - rate) * (1.0 - (-step / self.lag).exp());
            let turning = rate.abs() > STILL;
            let normal: f64 = StandardNormal.sample(random);
            friction = kept * friction + (1.0 - kept * kept).sqrt() * self.shake * normal;
            let driven = if turning { rate + friction } else { 0.0 };
            // Half a step ahead, so that the cogging is that of the middle of the step.
            let middle = angle + 0.5 * step * driven * self.cogging(angle);
            angle += step * driven * self.cogging(middle);
            let last = way.angles.len() - 1;
            way.angles.push(angle);
            way.senses.push(if turning { rate.signum() } else { way.senses[last] });
            way.rises.push(if change.abs() > STILL { change.signum() } else { way.rises[last] });
        }
        way
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::random;

    #[test]
    fn table_arrives_where_it_was_sent() {
        let segments = vec![
            Segment { rate: 0.0, duration: 2.0 },
            Segment { rate: 0.5, duration: 8.0 },
            Segment { rate: -0.5, duration: 8.0 },
        ];
        let ripples = vec![Ripple { order: 7.0, cos: 1e-3, sin: 0.0 }];
        let drive =
            Drive { segments, acceleration: 0.5, rolling: false, lag: 0.02, shake: 0.0, ripples };
        let way = drive.way(1e-3, 500, 18_500, &mut random(1, 1));
        assert_eq!(way.angles.len(), 18_501);
        assert_eq!((way.angles[2400], way.senses[2400], way.rises[2400]), (0.0, 0.0, 0.0));
        // Trapezoids: up in 1 s, then from 0.5 to -0.5 in 2 s; the servo has a lag of 20 ms.
        let (out, back) = (way.angles[10_500], way.angles[18_500]);
        assert!((out - (3.75 - 0.01)).abs() < 2e-3, "{out}");
        assert!((back - (3.75 - 3.0 + 0.01)).abs() < 2e-3, "{back}");
        assert_eq!((way.senses[18_500], way.rises[18_500]), (-1.0, -1.0));
        // Cogging is up to a thousandth of half a radian per second, over a seventh of a turn.
        let rate = |place: usize| (way.angles[place + 1] - way.angles[place]) / 1e-3;
        let rates = (4500..10_000).map(rate);
        let (low, high) = rates.fold((1.0_f64, 0.0_f64), |(l, h), r| (l.min(r), h.max(r)));
        assert!((high - 0.5005).abs() < 1e-5 && (low - 0.4995).abs() < 1e-5, "{low} {high}");
    }
}
