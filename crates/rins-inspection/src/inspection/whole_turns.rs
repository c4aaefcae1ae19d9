//! Means over whole turns of the table, in which what is fixed to the body averages out.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};

use rins_frames::SignedAxes;
use rins_motion::{Recording, median};

/// A table that goes back by more than this \[rad\] has reversed; an encoder's noise is less.
const REVERSED: f64 = 0.1;

/// The least share of gravity that stands across a tilted axis.
pub(super) const STANDS: f64 = 0.05;

/// A table that turns slower than this \[rad/s\] adds little to gravity wherever the IMU sits on it.
const SLOW: f64 = 1.0;

/// Readings over whole turns, each sample weighted by the angle through which it turned.
///
/// A vector along the body's axes with a bias, or a lever arm's force, that is the same throughout
/// has no mean along the axes of the table, at whatever rates the turn is made.
pub(super) struct WholeTurns {
    turns: Vec<Turn>,
    /// The fastest rate at which the table turns \[rad/s\].
    pub(super) fastest: f64,
    /// The white noise of a gyro's mean over all turns, 1σ \[rad/s\].
    white: f64,
    /// The median specific force of slow samples \[m/s²\].
    pub(super) force: Option<f64>,
}

/// One turn's means of the specific force, of the angular rate, and of their magnitudes.
struct Turn {
    force: Modulated,
    rate: Modulated,
    force_norm: f64,
    rate_norm: f64,
}

/// A vector's mean times the table angle's cosine, its sine, and alone.
#[derive(Clone, Copy, Default)]
struct Modulated([Vector3<f64>; 3]);

impl Modulated {
    fn add(&mut self, vector: &Vector3<f64>, angle: f64, weight: f64) {
        for (sum, factor) in self.0.iter_mut().zip([angle.cos(), angle.sin(), 1.0]) {
            *sum += vector * (factor * weight);
        }
    }

    /// The mean along the table's axes if the sensor's axes are `axes` and the table turns by `sense`.
    fn on_table(&self, axes: &SignedAxes, sense: f64) -> Vector3<f64> {
        let [cosine, sine, alone] = self.0.map(|mean| axes.apply(&mean));
        let sine = sine * sense;
        Vector3::new(cosine.x - sine.y, sine.x + cosine.y, alone.z)
    }
}

/// A turn that is not finished.
#[derive(Default)]
struct Open {
    force: Modulated,
    rate: Modulated,
    force_norm: f64,
    rate_norm: f64,
    turned: f64,
    farthest: f64,
    lasting: f64,
}

impl WholeTurns {
    /// `None` if the table makes no whole turn; `angle` is the table's at each sample.
    pub(super) fn of(recording: &Recording, angle: Option<&[f64]>) -> Option<Self> {
        let angle = angle?;
        let samples = recording.increments.get(1..)?;
        let (mut turns, mut open, mut forces) = (Vec::new(), Open::default(), Vec::new());
        let (mut fastest, mut time, mut noise) = (0.0_f64, 0.0, Vec::new());
        let mut last: Option<Vector3<f64>> = None;
        for (pair, sample) in angle.windows(2).zip(samples) {
            let (turned, middle) = (pair[1] - pair[0], f64::midpoint(pair[0], pair[1]));
            let rates = sample.rates();
            let rate = *rates.angular_rate.components();
            let force = *rates.specific_force.components();
            open.force.add(&force, middle, turned);
            open.rate.add(&rate, middle, turned);
            open.force_norm += force.norm() * turned;
            open.rate_norm += rate.norm() * turned;
            open.turned += turned;
            open.lasting += sample.interval;
            if open.turned.abs() >= open.farthest.abs() {
                open.farthest = open.turned;
            }
            if (open.farthest - open.turned).abs() > REVERSED {
                open = Open::default();
            }
            let table_rate = (turned / sample.interval).abs();
            fastest = fastest.max(table_rate);
            if table_rate < SLOW {
                forces.push(force.norm());
            }
            if let Some(last) = last {
                noise.push((rate - last).xy().norm_squared() / 4.0 * sample.interval);
            }
            last = Some(rate);
            if open.turned.abs() >= TAU {
                time += open.lasting;
                let mean = |sum: Modulated| Modulated(sum.0.map(|sum| sum / open.turned));
                turns.push(Turn {
                    force: mean(open.force),
                    rate: mean(open.rate),
                    force_norm: open.force_norm / open.turned,
                    rate_norm: open.rate_norm / open.turned,
                });
                open = Open::default();
            }
        }
        if turns.is_empty() {
            return None;
        }
        let white = (2.0 * usual_mean(noise) / time).sqrt();
        Some(Self { fastest, white, force: median(forces), turns })
    }

    /// What of the specific force and of the angular rate stands across the table's axis, as shares of
    /// their magnitudes: of what turns with the body nothing.
    pub(super) fn standing(&self) -> [f64; 2] {
        let share = |of: fn(&Turn) -> (Modulated, f64)| {
            let (mut standing, mut all) = (Vector2::zeros(), 0.0);
            for turn in &self.turns {
                let (mean, magnitude) = of(turn);
                standing += mean.on_table(&SignedAxes::IDENTITY, 1.0).xy();
                all += magnitude;
            }
            standing.norm() / all
        };
        [share(|turn| (turn.force, turn.force_norm)), share(|turn| (turn.rate, turn.rate_norm))]
    }

    /// The mean specific force along the table's axes \[m/s²\].
    pub(super) fn force(&self, axes: &SignedAxes, sense: f64) -> Vector3<f64> {
        let sum: Vector3<f64> =
            self.turns.iter().map(|turn| turn.force.on_table(axes, sense)).sum();
        sum / self.turns.len() as f64
    }

    /// The mean angular rate across the table's axis \[rad/s\], and its 1σ by what is white of the
    /// noise and by the turns' scatter; of the rate along the axis most is the table's.
    pub(super) fn rate_across(&self, axes: &SignedAxes, sense: f64) -> (Vector2<f64>, f64) {
        let n = self.turns.len();
        let across = |turn: &Turn| turn.rate.on_table(axes, sense).xy();
        let mean: Vector2<f64> = self.turns.iter().map(across).sum();
        let mean = mean / n as f64;
        let square: f64 = self.turns.iter().map(|turn| (across(turn) - mean).norm_squared()).sum();
        // One turn has none.
        let scatter = (square / (n.max(2) - 1) as f64 / n as f64).sqrt();
        (mean, scatter.max(self.white))
    }
}

/// The mean of squares of two normal deviates by the lower three quarters of them: what a table's
/// ramps add where gyros are read along wrong axes is no noise.
fn usual_mean(mut squares: Vec<f64>) -> f64 {
    squares.sort_by(f64::total_cmp);
    squares.truncate(squares.len() / 4 * 3);
    // Of an exponential distribution's lower three quarters the mean is 1 - ln(4) / 3.
    let share = 1.0 - 4.0_f64.ln() / 3.0;
    squares.iter().sum::<f64>() / squares.len().max(1) as f64 / share
}
