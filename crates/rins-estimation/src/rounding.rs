//! The effect of an encoder's quantization on the mean angle of an epoch.
//!
//! The error of a reading is a sawtooth function of the angle. A static table, or a table that rotates by a whole number of
//! LSBs from sample to sample, has the same error in all readings; other rates cause spectral lines. The error is not white,
//! but it is bounded: white noise represents it that is so large that the whole error is statistically
//! insignificant.

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;
use rins_inspection::{ENOUGH_ANGLES, QuantizationGrid};
use rins_motion::Recording;
use rins_terms::Track;

use crate::epoch::Epoch;

/// Quantization that adds less than this fraction to the stated variance of a reading is negligible.
const FINE: f64 = 0.05;

/// Where the table rotates by a fractional number of LSBs according to the gyro, rounded readings differ from it by at least
/// this fraction of the expected variance; the test needs at least this number of samples. The readings of a table that
/// rotates at a few constant rates have a regular spacing too, which is not due to an encoder.
const LEAST_ROUNDED: f64 = 0.25;
const FEWEST_BETWEEN: f64 = 16.0;

/// The largest relative difference between the stated and the actual LSB.
const ALIKE: f64 = 0.01;

/// The smallest rounding variance, in LSB², of a rotation that counts as a fractional number of LSBs.
const BETWEEN: f64 = 0.1;

/// The number of samples over which the gyro's bias and scale error are taken as constant.
const BLOCK: usize = 64;

/// The noise before rounding, in LSBs, above which the effect of quantization vanishes.
const MOST_BLURRED: f64 = 2.0;

/// The number of harmonics of the sawtooth: they contain all but one fourteenth of its variance.
const HARMONICS: u8 = 8;

/// The largest sum of squares (chi-square) due to the rounding in a whole run, in any direction of the parameters.
const WORTH: f64 = 2.0;

/// The quantization of an encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleSteps {
    /// The LSB: the smallest difference between readings \[rad\].
    pub step: f64,
    /// 1σ of the noise of a reading before it is rounded, in LSBs: noise reduces the effect of rounding.
    pub blur: f64,
}

impl AngleSteps {
    /// The quantization of an encoder, if it is large compared with the stated noise of a reading \[rad\].
    ///
    /// A table that rotates by a whole number of LSBs from sample to sample does not show the rounding of its encoder: then a
    /// `stated` LSB \[rad\] is used.
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
        // Where a reading lies on the edge between two values, a very small noise appears large.
        let blur = seen.blur().min(noise / step);
        (blur < MOST_BLURRED).then_some(Self { step, blur })
    }

    /// Sets the variance of the mean angle due to rounding in every epoch, as white noise so large that the rounding of the
    /// run contributes at most [`WORTH`] to the sum of squares.
    pub(crate) fn tell(&self, epochs: &mut [Epoch], track: &Track) {
        let angles = track.angles();
        let count = epochs.len() as f64;
        for epoch in epochs {
            epoch.rounding = self.rounding(count, &angles[epoch.samples.0 + 1..=epoch.samples.1]);
        }
    }

    /// The variance of the mean of readings at these angles in a run of this number of epochs \[rad²\].
    pub(crate) fn rounding(&self, epochs: f64, angles: &[f64]) -> f64 {
        epochs / WORTH * self.variance_of_mean(angles.iter().copied())
    }

    /// The variance of the mean of readings at these angles, with an unknown origin of the quantization grid \[rad²\].
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

/// The factor by which noise of `blur` LSBs reduces the variance of a harmonic of the sawtooth.
fn blurred(order: f64, blur: f64) -> f64 {
    (-(TAU * order * blur).powi(2)).exp()
}

/// The differences of successive readings, compared with the gyro along the axis.
struct Seen {
    /// Whether they are those of rounded readings.
    rounded: bool,
    /// The mean square in excess of rounding alone, in LSB²: the lower quartile over the blocks.
    excess: f64,
    /// The mean cosines of the harmonics of the rotation between samples, in LSBs.
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
                // Rounding to one of the two adjacent integers.
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

    /// The noise of the readings before rounding, in LSBs.
    ///
    /// The variance of a rounded difference with the fractional part `u` is `u (1 - u)`. Noise attenuates its Fourier series
    /// and adds its own variance.
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

    /// The variance of the mean rounding error of readings at these angles, in LSB², over all origins of the quantization
    /// grid.
    fn counted(angles: &[f64]) -> f64 {
        const PLACES: u32 = 20_000;
        let mean = |place: u32| {
            let beginning = f64::from(place) / f64::from(PLACES);
            let error = |angle: &f64| (angle + beginning).round() - (angle + beginning);
            angles.iter().map(error).sum::<f64>() / angles.len() as f64
        };
        (0..PLACES).map(|place| mean(place).powi(2)).sum::<f64>() / f64::from(PLACES)
    }

    /// The variance of one rounding error is a twelfth of the squared LSB; that of a mean depends on the fractional parts.
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
            // Eight harmonics contain all but a fourteenth of the variance of one reading, and all but a fifth of that of the
            // mean of three.
            assert!((0.79..1.001).contains(&share), "{angles:?}: {share} of {counted}");
        }
        assert!((counted(&[0.3]) * 12.0 - 1.0).abs() < 1e-3, "{}", counted(&[0.3]));
    }

    /// Noise of half an LSB removes the sawtooth; each harmonic is attenuated by its mean over a Gaussian.
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
