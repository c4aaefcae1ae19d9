//! Means over whole revolutions of the table, in which vectors that are fixed to the body average out.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};

use rins_frames::SignedAxes;
use rins_motion::{Recording, median};

/// The decrease of the table angle \[rad\] from which the table has reversed; the noise of an encoder is less.
const REVERSED: f64 = 0.1;

/// The smallest fraction of gravity perpendicular to a tilted axis.
pub(super) const STANDS: f64 = 0.05;

/// The rate \[rad/s\] below which the centripetal acceleration is negligible at any position of the IMU on the table.
const SLOW: f64 = 1.0;

/// Readings over whole revolutions, each sample weighted by its angle of rotation.
///
/// A vector that is constant along the body's axes, such as a bias or the force of a lever arm, has zero mean along the axes
/// of the table, at any rates within the revolution.
pub(super) struct WholeTurns {
    turns: Vec<Turn>,
    /// The largest rate of the table \[rad/s\].
    pub(super) fastest: f64,
    /// The white noise of a gyro's mean over all revolutions, 1σ \[rad/s\].
    white: f64,
    /// The median specific force of samples at slow rates \[m/s²\].
    pub(super) force: Option<f64>,
}

/// The means over one revolution of the specific force, of the angular rate, and of their magnitudes.
struct Turn {
    force: Modulated,
    rate: Modulated,
    force_norm: f64,
    rate_norm: f64,
}

/// The means of a vector times the cosine and the sine of the table angle, and of the vector itself.
#[derive(Clone, Copy, Default)]
struct Modulated([Vector3<f64>; 3]);

impl Modulated {
    fn add(&mut self, vector: &Vector3<f64>, angle: f64, weight: f64) {
        for (sum, factor) in self.0.iter_mut().zip([angle.cos(), angle.sin(), 1.0]) {
            *sum += vector * (factor * weight);
        }
    }

    /// The mean along the table's axes if the sensor's axes are `axes` and the table rotates in the direction `sense`.
    fn on_table(&self, axes: &SignedAxes, sense: f64) -> Vector3<f64> {
        let [cosine, sine, alone] = self.0.map(|mean| axes.apply(&mean));
        let sine = sine * sense;
        Vector3::new(cosine.x - sine.y, sine.x + cosine.y, alone.z)
    }
}

/// An incomplete revolution.
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
    /// `None` if the table makes no whole revolution; `angle` is that of the table at each sample.
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

    /// The fractions of the specific force and of the angular rate that are fixed to the table perpendicular to its axis;
    /// those of a vector fixed to the body are zero.
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

    /// The mean angular rate perpendicular to the table's axis \[rad/s\], and its 1σ from white noise and from the scatter of
    /// the revolutions; the rate along the axis is mainly that of the table.
    pub(super) fn rate_across(&self, axes: &SignedAxes, sense: f64) -> (Vector2<f64>, f64) {
        let n = self.turns.len();
        let across = |turn: &Turn| turn.rate.on_table(axes, sense).xy();
        let mean: Vector2<f64> = self.turns.iter().map(across).sum();
        let mean = mean / n as f64;
        let square: f64 = self.turns.iter().map(|turn| (across(turn) - mean).norm_squared()).sum();
        // One revolution has none.
        let scatter = (square / (n.max(2) - 1) as f64 / n as f64).sqrt();
        (mean, scatter.max(self.white))
    }
}

/// The mean of squares of two normal deviates from the lower three quarters of them: the contribution of the table's ramps,
/// with wrong axes of the gyros, is not noise.
fn usual_mean(mut squares: Vec<f64>) -> f64 {
    squares.sort_by(f64::total_cmp);
    squares.truncate(squares.len() / 4 * 3);
    // The mean of the lower three quarters of an exponential distribution is 1 - ln(4) / 3.
    let share = 1.0 - 4.0_f64.ln() / 3.0;
    squares.iter().sum::<f64>() / squares.len().max(1) as f64 / share
}
