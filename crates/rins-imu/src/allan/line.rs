//! Spectral lines over a static interval, which no noise law explains.

use std::f64::consts::{LN_2, PI, TAU};
use std::ops::Range;

use nalgebra::{Matrix3, Vector2, Vector3};
use rustfft::{FftPlanner, num_complex::Complex};

/// The minimum number of cycles of a spectral line in a static interval: with fewer, a random walk looks like a line.
const FEWEST_CYCLES: usize = 20;

/// The number of frequencies on either side of a frequency whose median power is the local noise level.
const BESIDE: usize = 50;

/// A spectral line is a peak that noise exceeds in fewer than one of `e^16` intervals, over all frequencies.
const LN_IMPROBABLE: f64 = 16.0;

/// A further component near a line is a peak that noise exceeds once in a thousand intervals, over all frequencies near it.
const LN_PART: f64 = 7.0;

/// The components of a line are within this fraction of its frequency: wider ones are colored noise.
const NEAR: usize = 20;

/// The maximum number of sinusoidal components of a line: more are colored noise.
const MOST_PARTS: usize = 64;

/// The maximum number of lines of a sensor.
const MOST: usize = 8;

/// The number of blocks of an interval, in each of which a frequency is represented by an integer number of cycles.
const BLOCKS: usize = 256;

/// The maximum number of corrections of a frequency; the next constant limits each of them \[cycles over the interval\].
const STEPS: usize = 3;
const LONGEST_STEP: f64 = 0.5;

/// A spectral line: sinusoidal interference in the readings of a sensor at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralLine {
    /// Its frequency \[Hz\].
    pub frequency: f64,
    /// The 1σ of the frequency \[Hz\].
    pub frequency_sigma: f64,
    /// The amplitude of the rate or the specific force, √2 times its root mean square over the interval \[rad/s or m/s²\].
    pub amplitude: f64,
    /// The 1σ of the amplitude.
    pub amplitude_sigma: f64,
    /// The width of the uniform band with the standard deviation of the varying frequency \[Hz\]; zero for a constant frequency.
    pub width: f64,
}

/// Removes the spectral lines from increments over even intervals, and returns them, the strongest first.
///
/// A line exceeds the local noise level in the periodogram so far that noise alone would do so in fewer than one of `e^16`
/// intervals. If the frequency varies, as that of a motor or a swaying base, one sinusoid is not sufficient: the others near it
/// are removed with it, until the remainder agrees with noise (the CLEAN algorithm; ‹roberts1987›). Readings with a resolution
/// far coarser than their noise have lines of their own.
pub fn take_out_lines(increments: &mut [f64], interval: f64) -> Vec<SpectralLine> {
    let mut lines = Vec::new();
    while lines.len() < MOST
        && let Some(line) = strongest(increments, interval)
    {
        lines.push(line);
    }
    lines
}

/// One of the sinusoidal components of a line.
struct Part {
    /// Its number of cycles over the interval.
    cycles: f64,
    power: f64,
}

/// Removes the strongest line; `None` if there is none.
fn strongest(increments: &mut [f64], interval: f64) -> Option<SpectralLine> {
    let count = increments.len();
    let everywhere = FEWEST_CYCLES..count / 2;
    if everywhere.len() < 2 * BESIDE {
        return None;
    }
    let mut left = increments.to_vec();
    let mut place = above(&left, everywhere.clone(), LN_IMPROBABLE)?;
    let near = place.div_ceil(NEAR);
    let near =
        place.saturating_sub(near).max(everywhere.start)..(place + near + 1).min(everywhere.end);
    let mut parts = Vec::new();
    loop {
        parts.push(take_out(&mut left, place)?);
        if parts.len() > MOST_PARTS {
            return None;
        }
        let Some(next) = above(&left, near.clone(), LN_PART) else { break };
        place = next;
    }
    let taken = increments.iter().zip(&left).map(|(all, left)| (all - left).powi(2));
    let amplitude = (2.0 * taken.sum::<f64>() / count as f64).sqrt();
    let levels = levels_about(&periodogram(&left), near);
    let noise = (levels[levels.len() / 2] / count as f64).sqrt();
    increments.copy_from_slice(&left);

    let power: f64 = parts.iter().map(|part| part.power).sum();
    let mean = |of: &dyn Fn(&Part) -> f64| {
        parts.iter().map(|part| part.power * of(part)).sum::<f64>() / power
    };
    let first = parts[0].cycles;
    let centre = first + mean(&|part| part.cycles - first);
    let spread = mean(&|part| (part.cycles - centre).powi(2)).sqrt();
    let number = parts.len() as f64;
    let duration = count as f64 * interval;
    // The uncertainty of one sinusoid in white noise (‹rife1974›); of several, that from their scatter.
    let alone = (6.0 / count as f64).sqrt() * noise / (PI * amplitude);
    Some(SpectralLine {
        frequency: centre / duration,
        frequency_sigma: alone.hypot(spread / number.sqrt()) / duration,
        amplitude: amplitude / interval,
        amplitude_sigma: noise * (2.0 * number / count as f64).sqrt() / interval,
        width: 12.0_f64.sqrt() * spread / duration,
    })
}

/// The index with the highest power relative to the local noise, if noise exceeds it in fewer than one of `e^improbable`
/// intervals.
fn above(readings: &[f64], places: Range<usize>, improbable: f64) -> Option<usize> {
    let powers = periodogram(readings);
    let levels = levels_about(&powers, places.clone());
    let least = (places.len() as f64).ln() + improbable;
    let (excess, place) = places
        .zip(levels)
        .map(|(place, level)| (powers[place] / level, place))
        .max_by(|one, other| one.0.total_cmp(&other.0))?;
    (excess > least).then_some(place)
}

/// Removes the sinusoid near this number of cycles from readings, by least squares in its cosine, its sine and its frequency.
fn take_out(readings: &mut [f64], place: usize) -> Option<Part> {
    let count = readings.len();
    let mut cycles = refined(readings, place);
    // The first fit has a fixed frequency: cosine and sine only.
    let mut found = least_squares(readings, cycles, Vector3::zeros())?;
    for _ in 0..STEPS {
        found = least_squares(readings, cycles, found)?;
        cycles += found.z.clamp(-LONGEST_STEP, LONGEST_STEP);
    }
    found = least_squares(readings, cycles, Vector3::zeros())?;
    for (sample, reading) in readings.iter_mut().enumerate() {
        let (sin, cos) = phase(sample, cycles, count).sin_cos();
        *reading -= found.x * cos + found.y * sin;
    }
    Some(Part { cycles, power: found.xy().norm_squared() })
}

/// The amplitudes of cosine and sine at this number of cycles, and the correction of the number of cycles, with `about` as
/// previous solution.
fn least_squares(readings: &[f64], cycles: f64, about: Vector3<f64>) -> Option<Vector3<f64>> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (sample, reading) in readings.iter().enumerate() {
        let (sin, cos) = phase(sample, cycles, readings.len()).sin_cos();
        let along = TAU * sample as f64 / readings.len() as f64;
        let row = Vector3::new(cos, sin, along * (about.y * cos - about.x * sin));
        normal += row * row.transpose();
        right += row * *reading;
    }
    if about.xy() == Vector2::zeros() {
        normal[(2, 2)] = 1.0;
    }
    normal.cholesky().map(|factor| factor.solve(&right))
}

fn phase(sample: usize, cycles: f64, count: usize) -> f64 {
    TAU * (cycles * sample as f64 / count as f64).fract()
}

/// The squared magnitude of the Fourier transform at integer numbers of cycles, up to half the number of readings.
fn periodogram(readings: &[f64]) -> Vec<f64> {
    let mut values: Vec<Complex<f64>> =
        readings.iter().map(|reading| Complex::new(*reading, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(values.len()).process(&mut values);
    values[..readings.len() / 2].iter().map(Complex::norm_sqr).collect()
}

/// The mean noise power at each of these indices, from the median of the powers on either side.
fn levels_about(powers: &[f64], places: Range<usize>) -> Vec<f64> {
    let level = |place: usize| {
        let from = place.saturating_sub(BESIDE).max(1);
        let mut beside = powers[from..(place + BESIDE + 1).min(powers.len())].to_vec();
        let middle = beside.len() / 2;
        beside.select_nth_unstable_by(middle, f64::total_cmp);
        beside[middle] / LN_2
    };
    places.map(level).collect()
}

/// The number of cycles near `place` with the highest power, by golden-section search.
fn refined(readings: &[f64], place: usize) -> f64 {
    let count = readings.len();
    let block = count.div_ceil(BLOCKS);
    let sums: Vec<Complex<f64>> = readings
        .chunks(block)
        .enumerate()
        .map(|(chunk, readings)| {
            let about = |(sample, reading): (usize, &f64)| {
                let turned = phase(chunk * block + sample, place as f64, count);
                Complex::from_polar(*reading, -turned)
            };
            readings.iter().enumerate().map(about).sum()
        })
        .collect();
    let power = |beyond: f64| {
        let turn = |chunk: usize| phase(chunk * block, beyond, count);
        let turned = sums.iter().enumerate();
        let sum: Complex<f64> =
            turned.map(|(chunk, sum)| sum * Complex::from_polar(1.0, -turn(chunk))).sum();
        sum.norm_sqr()
    };
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (-0.75_f64, 0.75_f64);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut of_left, mut of_right) = (power(left), power(right));
    while high - low > 1e-3 {
        if of_left > of_right {
            (high, right, of_right) = (right, left, of_left);
            left = high - golden * (high - low);
            of_left = power(left);
        } else {
            (low, left, of_left) = (left, right, of_right);
            right = low + golden * (high - low);
            of_right = power(right);
        }
    }
    place as f64 + 0.5 * (low + high)
}
