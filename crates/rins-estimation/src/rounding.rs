//! What an encoder that reads in steps leaves in the mean of an epoch.
//!
//! The error of a reading is a sawtooth of the angle. A table that stands, or that turns by a whole number of steps from one
//! sample to the next, has the same error all along; at other rates it comes back in lines. It is no white noise, however
//! strong that is made, but it is bounded: white noise can be so strong that all of it is worth no more than chance is.

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;
use rins_inspection::{ENOUGH_ANGLES, QuantizationGrid};
use rins_motion::Recording;
use rins_terms::Track;

use crate::epoch::Epoch;

/// Steps whose rounding adds less than this to the variance that is stated of a reading are fine.
const FINE: f64 = 0.05;

/// Where the gyro says that a table turned by no whole number of steps, rounded readings differ from it, by this part of
/// what is expected at least; in fewer samples than so many that is not to be seen. Readings of a table that turns at a few
/// even rates stand on a comb too, and no encoder made it.
const LEAST_ROUNDED: f64 = 0.25;
const FEWEST_BETWEEN: f64 = 16.0;

/// By what part of it a step that is stated is off at most.
const ALIKE: f64 = 0.01;

/// No whole number of steps: the variance of one that is rounded to such is at least this.
const BETWEEN: f64 = 0.1;

/// Over so many samples the gyro's bias and scale are taken to be one.
const BLOCK: usize = 64;

/// What blurs a reading more than by so many steps leaves nothing of them.
const MOST_BLURRED: f64 = 2.0;

/// So many harmonics of the sawtooth are taken: all but a fourteenth of its square.
const HARMONICS: u8 = 8;

/// The squares that all rounding of a run may be worth, in whatever direction of the parameters.
const WORTH: f64 = 2.0;

/// The steps in which an encoder reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleSteps {
    /// How far apart its readings are at least \[rad\].
    pub step: f64,
    /// 1σ of what blurs a reading before it is rounded, in steps: noise rounds off what rounding does.
    pub blur: f64,
}

impl AngleSteps {
    /// The steps of an encoder, if they are coarse beside the noise that is stated of a reading \[rad\].
    ///
    /// A table that turns by whole numbers of steps from sample to sample does not show that its encoder rounds: then
    /// steps that are `stated` \[rad\] are believed.
    pub fn of(recording: &Recording, noise: f64, stated: Option<f64>) -> Option<Self> {
        let angles = recording.table_angle.as_deref()?;
        let is_coarse = |step: &f64| step * step / 12.0 >= FINE * noise * noise;
        let seen = |step| (step, Seen::of(angles, recording, step));
        let read = QuantizationGrid::of_table_angle(recording).map(|comb| comb.step);
        let shown = read.filter(is_coarse).map(seen).filter(|(_, seen)| seen.rounded);
        let (step, seen) = shown.or_else(|| {
            let stated = stated.filter(is_coarse)?;
            let is_as_stated = |read: &f64| (read / stated - 1.0).abs() < ALIKE;
            Some(seen(read.filter(is_as_stated).unwrap_or(stated)))
        })?;
        // Where a reading lies on the edge of two steps the least blur looks like much.
        let blur = seen.blur().min(noise / step);
        (blur < MOST_BLURRED).then_some(Self { step, blur })
    }

    /// Tells every epoch what rounding may leave in its mean angle: as white noise, so strong that all of it is worth
    /// [`WORTH`] squares.
    pub(crate) fn tell(&self, epochs: &mut [Epoch], track: &Track) {
        let angles = track.angles();
        let times = epochs.len() as f64 / WORTH;
        for epoch in epochs {
            let ends = angles[epoch.samples.0 + 1..=epoch.samples.1].iter();
            epoch.rounding = times * self.variance_of_mean(ends.copied());
        }
    }

    /// The variance of the mean of readings at these angles, wherever the steps begin \[rad²\].
    fn variance_of_mean(&self, angles: impl Iterator<Item = f64>) -> f64 {
        let mut sums = [Complex::ZERO; HARMONICS as usize];
        let mut count = 0.0;
        for angle in angles {
            let first = Complex::cis(TAU * (angle / self.step).fract());
            let mut power = Complex::ONE;
            for sum in &mut sums {
                power *= first;
                *sum += power;
            }
            count += 1.0;
        }
        let of = |(sum, order): (&Complex<f64>, u8)| {
            let order = f64::from(order);
            (sum / count).norm_sqr() * blurred(order, self.blur) / (order * order)
        };
        let variance: f64 = sums.iter().zip(1..).map(of).sum();
        variance * self.step * self.step / (2.0 * PI * PI)
    }
}

/// What is left of the square of a harmonic of the sawtooth if readings are blurred by so many steps.
fn blurred(order: f64, blur: f64) -> f64 {
    (-(TAU * order * blur).powi(2)).exp()
}

/// By how much neighbouring readings differ from what the gyro about the axis says.
struct Seen {
    /// Whether they do so as rounding makes them.
    rounded: bool,
    /// The mean square beyond what rounding alone makes of it, in steps: of the quarter of all blocks where it is least.
    excess: f64,
    /// The mean cosines of the harmonics of by how much a table turns from one sample to the next, in steps.
    cosines: [f64; HARMONICS as usize],
}

impl Seen {
    fn of(angles: &[f64], recording: &Recording, step: f64) -> Self {
        let longest = recording.longest_interval();
        let turned: Vec<(f64, f64)> = angles[..angles.len().min(ENOUGH_ANGLES)]
            .windows(2)
            .zip(&recording.increments[1..])
            .filter(|(_, sample)| sample.interval < longest)
            .map(|(pair, sample)| ((pair[1] - pair[0]) / step, sample.angle.components().z / step))
            .collect();
        let mut cosines = [0.0; HARMONICS as usize];
        let [mut between, mut square_between, mut sharp_between] = [0.0; 3];
        let n = BLOCK as f64;
        let of_block = |block: &[(f64, f64)]| {
            let offset = block.iter().map(|(read, gyro)| read - gyro).sum::<f64>() / n;
            let [mut square, mut sharp] = [0.0; 2];
            for (read, gyro) in block {
                let turned = gyro + offset;
                let beyond = turned - turned.floor();
                // One of the two whole numbers next to it.
                let (off, expected) = ((read - turned).powi(2), beyond * (1.0 - beyond));
                square += off / (n - 1.0);
                sharp += expected / n;
                if expected > BETWEEN {
                    between += 1.0;
                    square_between += off;
                    sharp_between += expected;
                }
                for (cosine, order) in cosines.iter_mut().zip(1_u8..) {
                    *cosine += (TAU * f64::from(order) * turned).cos();
                }
            }
            square - sharp
        };
        let mut excesses: Vec<f64> = turned.chunks_exact(BLOCK).map(of_block).collect();
        let (blocks, quarter) = (excesses.len(), excesses.len() / 4);
        let rounded = between >= FEWEST_BETWEEN && square_between > LEAST_ROUNDED * sharp_between;
        if excesses.is_empty() {
            return Self { rounded: false, excess: 0.0, cosines };
        }
        let excess = *excesses.select_nth_unstable_by(quarter, f64::total_cmp).1;
        Self { rounded, excess, cosines: cosines.map(|cosine| cosine / (n * blocks as f64)) }
    }

    /// By how many steps readings are blurred.
    ///
    /// The variance of a rounded difference whose part beyond a whole number is `u` is `u (1 - u)`; blur leaves little of the
    /// Fourier series of that, and adds its own.
    fn blur(&self) -> f64 {
        let expected = |blur: f64| {
            let of = |(cosine, order): (&f64, u8)| {
                let order = f64::from(order);
                cosine * (1.0 - blurred(order, blur)) / (PI * order).powi(2)
            };
            self.cosines.iter().zip(1..).map(of).sum::<f64>() + 2.0 * blur * blur
        };
        let (mut low, mut high) = (0.0, MOST_BLURRED);
        for _ in 0..30 {
            let middle = f64::midpoint(low, high);
            *(if expected(middle) < self.excess { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The variance of the mean of what rounding does to readings at these angles, in steps, over all places where the
    /// steps may begin.
    fn counted(angles: &[f64]) -> f64 {
        const PLACES: u32 = 20_000;
        let mean = |place: u32| {
            let beginning = f64::from(place) / f64::from(PLACES);
            let error = |angle: &f64| (angle + beginning).round() - (angle + beginning);
            angles.iter().map(error).sum::<f64>() / angles.len() as f64
        };
        (0..PLACES).map(|place| mean(place).powi(2)).sum::<f64>() / f64::from(PLACES)
    }

    /// One reading is a twelfth of a step's square off; of several, what their places in a step leave of it.
    #[test]
    fn rounding_of_a_mean_has_the_variance_that_is_counted() {
        let step = 3e-6;
        let steps = AngleSteps { step, blur: 0.0 };
        for angles in
            [&[0.3][..], &[0.1, 1.1, 7.1], &[0.0, 0.5], &[0.0, 0.3, 0.6], &[0.2, 0.25, 0.3, 0.35]]
        {
            let counted = counted(angles);
            let found = steps.variance_of_mean(angles.iter().map(|angle| angle * step));
            let share = found / (counted * step * step);
            // Eight harmonics hold all but a fourteenth of the square of one reading, all but a fifth of what is left of three.
            assert!((0.79..1.001).contains(&share), "{angles:?}: {share} of {counted}");
        }
        assert!((counted(&[0.3]) * 12.0 - 1.0).abs() < 1e-3, "{}", counted(&[0.3]));
    }

    /// Blur of half a step takes the sawtooth away: each harmonic by its own part, as the mean over a Gaussian has it.
    #[test]
    fn blur_takes_harmonics_away() {
        const DRAWS: i32 = 4000;
        const SIGMAS: f64 = 6.0;
        for (order, blur) in [(1.0, 0.05), (1.0, 0.2), (3.0, 0.1)] {
            let [mut cosine, mut weights] = [0.0; 2];
            for draw in -DRAWS..=DRAWS {
                let sigmas = SIGMAS * f64::from(draw) / f64::from(DRAWS);
                let weight = (-0.5 * sigmas * sigmas).exp();
                cosine += weight * (TAU * order * blur * sigmas).cos();
                weights += weight;
            }
            let left = (cosine / weights).powi(2);
            assert!((blurred(order, blur) - left).abs() < 1e-6, "{order}, {blur}: {left}");
        }
    }
}
