//! Ramps between the rates of a commanded profile, from the gyro along the axis if the profile does not contain them.

use std::ops::Range;

use rins_frames::Increments;
use rins_frames::units::DEG;

/// The difference below which two rates are equal \[rad/s\].
const ALIKE: f64 = 1e-7;

/// The longest time before and after a change in which a ramp is searched for \[s\].
const LONGEST: f64 = 5.0;

/// The largest difference between the angles of rotation over a ramp and in the profile \[rad\].
const LARGEST_OFF: f64 = 0.5 * DEG;

/// The range of scale factors between the rates of the gyro and of the table.
const SCALES: Range<f64> = 0.7..1.4;

/// The ratio to the angle noise of the gyro from which an angle is attributed to a ramp.
const SHOWN: f64 = 6.0;

/// Replaces the commanded rates \[rad/s\] at changes of rate by the ramps according to the gyro along the axis, and returns
/// the number of these ramps. The commanded rates change instantly, or differently from those of the table.
///
/// The angle of rotation over a change must equal that of the profile: otherwise the table moved differently, and nothing is
/// changed. The bias and scale factor of the gyro are determined from its mean rates before and after the change.
pub fn with_ramps(rates: &mut [f64], samples: &[Increments]) -> usize {
    let plateaus = plateaus(rates);
    let mut count = 0;
    for pair in plateaus.windows(2) {
        let [(before, from), (after, to)] = [pair[0].clone(), pair[1].clone()];
        let lasting = |of: &Range<usize>| -> f64 {
            samples[of.clone()].iter().map(|sample| sample.interval).sum()
        };
        let reach = LONGEST.min(0.25 * lasting(&before)).min(0.25 * lasting(&after));
        let back = |from: usize| stretch(samples[..from].iter().rev(), reach);
        let on = |from: usize| stretch(samples[from..].iter(), reach);
        let start = before.end - back(before.end);
        let end = after.start + on(after.start);
        let ramp = Ramp {
            rates: [from, to],
            over: start..end,
            settled: [start - back(start)..start, end..end + on(end)],
        };
        if let Some(shape) = ramp.shape(rates, samples) {
            rates[ramp.over].copy_from_slice(&shape);
            count += 1;
        }
    }
    count
}

/// The spans of samples with a constant rate, and that rate; between two of them the rate changes within a sample or at its
/// end.
fn plateaus(rates: &[f64]) -> Vec<(Range<usize>, f64)> {
    let mut plateaus = Vec::new();
    let mut start = 0;
    for next in 1..=rates.len() {
        if next == rates.len() || (rates[next] - rates[next - 1]).abs() > ALIKE {
            // A sample within which the rate changes is not a plateau.
            if next - start > 2 {
                plateaus.push((start..next, rates[start]));
            }
            start = next;
        }
    }
    plateaus
}

/// The number of these samples with a total duration of at most `reach` \[s\].
fn stretch<'a>(samples: impl Iterator<Item = &'a Increments>, reach: f64) -> usize {
    let ends = samples.scan(0.0, |sum, sample| {
        *sum += sample.interval;
        Some(*sum)
    });
    ends.take_while(|end| *end <= reach).count()
}

/// A change from one commanded rate to the next.
struct Ramp {
    rates: [f64; 2],
    /// The samples that may contain the ramp.
    over: Range<usize>,
    /// The samples before and after, in which the table has the first and the second rate.
    settled: [Range<usize>; 2],
}

impl Ramp {
    /// The rates over the change according to the gyro, if there is a significant ramp \[rad/s\].
    fn shape(&self, commanded: &[f64], samples: &[Increments]) -> Option<Vec<f64>> {
        let gyro = |sample: &Increments| sample.angle.components().z / sample.interval;
        let mean = |of: &Range<usize>| {
            let all = &samples[of.clone()];
            (!all.is_empty()).then(|| all.iter().map(gyro).sum::<f64>() / all.len() as f64)
        };
        let means = [mean(&self.settled[0])?, mean(&self.settled[1])?];
        let scale = (self.rates[1] - self.rates[0]) / (means[1] - means[0]);
        if !SCALES.contains(&scale) {
            return None;
        }
        let over = &samples[self.over.clone()];
        let mut shape: Vec<f64> =
            over.iter().map(|sample| self.rates[0] + scale * (gyro(sample) - means[0])).collect();
        let (mut off, mut most, mut time) = (0.0, 0.0_f64, 0.0);
        for ((rate, commanded), sample) in shape.iter().zip(&commanded[self.over.clone()]).zip(over)
        {
            off += (rate - commanded) * sample.interval;
            time += sample.interval;
            most = most.max(off.abs());
        }
        let squares: f64 = (0..2)
            .flat_map(|which| samples[self.settled[which].clone()].iter().map(move |s| (which, s)))
            .map(|(which, sample)| ((gyro(sample) - means[which]) * sample.interval).powi(2))
            .sum();
        let settled = self.settled[0].len() + self.settled[1].len();
        let noise = (squares / settled as f64 * over.len() as f64).sqrt();
        if off.abs() > LARGEST_OFF || most < SHOWN * noise {
            return None;
        }
        for rate in &mut shape {
            *rate -= off / time;
        }
        Some(shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_frames::{Body, InFrame};
    use rins_testing::assert_close;
    use std::f64::consts::PI;

    const INTERVAL: f64 = 0.02;
    const SAMPLES: usize = 3000;
    const NOISE: f64 = 1e-5;

    /// A table that accelerates from rest to 0.2 rad/s within `ramp` around 30 s, with a sinusoidal rate, measured by a noisy
    /// gyro with a bias and a scale error.
    fn samples(ramp: f64) -> (Vec<f64>, Vec<Increments>) {
        let rate = |time: f64| {
            let part = ((time - 30.0) / ramp).clamp(-0.5, 0.5);
            0.1 * (1.0 + (PI * part).sin())
        };
        let true_rates: Vec<f64> =
            (0..SAMPLES).map(|sample| rate((sample as f64 + 0.5) * INTERVAL)).collect();
        let reading = |(sample, rate): (usize, &f64)| {
            let noise = NOISE * (sample as f64 * 2.4).sin();
            Increments {
                angle: InFrame::<Body>::new(0.0, 0.0, (1.002 * rate + 1e-4 + noise) * INTERVAL),
                velocity: InFrame::zeros(),
                interval: INTERVAL,
            }
        };
        let samples = true_rates.iter().enumerate().map(reading).collect();
        (true_rates, samples)
    }

    /// The profile with a step at this time.
    fn jump(at: f64) -> Vec<f64> {
        let time = |sample: usize| (sample as f64 + 0.5) * INTERVAL;
        (0..SAMPLES).map(|sample| if time(sample) < at { 0.0 } else { 0.2 }).collect()
    }

    #[test]
    fn ramp_is_as_the_gyro_shows_it() {
        let (truth, samples) = samples(2.0);
        let mut rates = jump(30.0);
        assert_eq!(with_ramps(&mut rates, &samples), 1);
        for (rate, truth) in rates.iter().zip(&truth) {
            assert_close!(*rate, *truth, 2.0 * NOISE);
        }
        let turned = |rates: &[f64]| rates.iter().sum::<f64>() * INTERVAL;
        assert_close!(turned(&rates), turned(&jump(30.0)), 1e-9);
    }

    /// The table rotated for a second less than stated: this is not a ramp.
    #[test]
    fn table_that_moved_at_another_time_stays_as_commanded() {
        let (_, samples) = samples(2.0);
        let mut rates = jump(29.0);
        assert_eq!(with_ramps(&mut rates, &samples), 0);
        assert_eq!(rates, jump(29.0));
    }

    #[test]
    fn table_that_jumps_stays_as_commanded() {
        let (_, samples) = samples(1e-6);
        let mut rates = jump(30.0);
        assert_eq!(with_ramps(&mut rates, &samples), 0);
        assert_eq!(rates, jump(30.0));
    }
}
