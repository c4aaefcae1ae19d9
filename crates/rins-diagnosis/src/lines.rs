//! Lines that are faster than an epoch, sample by sample.

use nalgebra::Vector3;
use rins_estimation::{Fit, Reference, Run};
use rins_terms::{Chosen, catalogue, values};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::case::Case;
use crate::diagnosis::{Cause, FALSE_ALARMS};
use crate::noise::estimate;
use crate::structure::CHANNELS;

/// The noise under a line is the median of so many frequencies on each side.
const AROUND: usize = 600;

/// What a median of exponential figures says of their mean, against what all of them would say: (ln 2)².
const MEDIAN: f64 = 0.48;

/// The part of the false alarms that fast lines may cause: they are one effect of many.
const SHARE: f64 = 0.1;

/// The gyro about the spin axis, which is seen against the encoder.
pub(crate) const ABOUT_AXIS: usize = 2;

/// The most fast lines that are looked for in a run.
const MOST: usize = 4;

impl Case<'_> {
    /// Lines that are faster than an epoch shows, with their amplitudes.
    pub(crate) fn fast_lines(&self, fit: &Fit) -> Vec<(Chosen, Cause)> {
        let mut found: Vec<(Chosen, Cause)> = Vec::new();
        for (run, recording) in self.runs.iter().enumerate() {
            for (channel, residuals) in residuals(recording, fit, run).iter().enumerate() {
                let slowest = 0.5 / fit.linear[run].mean_epoch();
                if let Some(line) = strongest(residuals, recording, slowest) {
                    let ln_p = line.ln_p + (CHANNELS as f64 * self.runs.len() as f64).ln();
                    if ln_p < (SHARE * FALSE_ALARMS).ln() {
                        found.push(cause(channel, &line, ln_p, run));
                    }
                }
            }
        }
        found.sort_by(|a, b| a.1.ln_p.total_cmp(&b.1.ln_p));
        found.truncate(MOST);
        found
    }

    /// Those of some fast lines that would be found beside what else a model holds by now.
    pub(crate) fn still_there(&self, fit: &Fit, lines: &[(Chosen, Cause)]) -> Vec<(Chosen, Cause)> {
        let mut without = fit.clone();
        for model in &mut without.models {
            model.terms.retain(|term| lines.iter().all(|(line, _)| line != term));
        }
        let again = if lines.is_empty() { Vec::new() } else { self.fast_lines(&without) };
        let is_there = |(line, _): &&(Chosen, Cause)| {
            again.iter().any(|(other, _)| {
                let apart = other.settings[0] - line.settings[0];
                other.settings[1..] == line.settings[1..] && apart.abs() * self.duration() < 1.0
            })
        };
        lines.iter().filter(is_there).cloned().collect()
    }
}

/// A line in the residuals of one sensor.
struct Line {
    frequency: f64,
    cos: f64,
    sin: f64,
    sigma: f64,
    ln_p: f64,
}

/// What the sensors read beyond what the model says, sample by sample: rates \[rad/s\] and forces \[m/s²\]. Nothing where
/// samples are missing and one is held for them.
///
/// About the spin axis it is what the gyro reads beyond the encoder: a table that turns unevenly moves both. Without an
/// encoder nothing tells them apart, and nothing is there.
pub(crate) fn residuals(run: &Run, fit: &Fit, of: usize) -> [Vec<f64>; CHANNELS] {
    let mut all: [Vec<f64>; CHANNELS] = Default::default();
    let encoder = match run.rig.reference {
        Reference::Encoder { .. } => run.recording.table_angle.as_deref(),
        _ => None,
    };
    let mut before: Option<f64> = None;
    let samples = &run.recording.increments;
    let longest = run.recording.longest_interval();
    for (index, (moment, sample)) in fit.linear[of].track().moments().zip(samples).enumerate() {
        let predicted = fit.models[of].signals(&moment);
        let rates = sample.rates();
        let mut gyro: Vector3<f64> =
            rates.angular_rate.components() - moment.rate - values(&predicted.gyro);
        gyro.z = 0.0;
        if let Some(angle) = encoder.map(|readings| readings[index] - predicted.angle.re) {
            if let Some(before) = before {
                let gain = 1.0 + fit.models[of].value("gyro.scale.z").unwrap_or_default();
                gyro.z =
                    rates.angular_rate.components().z - gain * (angle - before) / sample.interval;
            }
            before = Some(angle);
        }
        if sample.interval > longest {
            for channel in &mut all {
                channel.push(0.0);
            }
            continue;
        }
        let accel = rates.specific_force.components() - moment.force - values(&predicted.accel);
        for axis in 0..3 {
            all[axis].push(gyro[axis]);
            all[3 + axis].push(accel[axis]);
        }
    }
    all
}

/// The strongest line above `slowest` \[Hz\], if there is any.
fn strongest(residuals: &[f64], run: &Run, slowest: f64) -> Option<Line> {
    let n = residuals.len();
    let times = &run.recording.times;
    let interval = (times[n - 1] - times[0]) / (n as f64 - 1.0);
    // From one sample to the next: what is slow, a bias or a ramp, leaks into no other frequency.
    let differences = residuals.windows(2).map(|pair| pair[1] - pair[0]);
    let mut spectrum: Vec<Complex<f64>> = differences.map(|x| Complex::new(x, 0.0)).collect();
    spectrum.resize(2 * n, Complex::new(0.0, 0.0));
    FftPlanner::new().plan_fft_forward(2 * n).process(&mut spectrum);
    // And back, so that white noise is white.
    let differenced = |bin: usize| (std::f64::consts::PI * bin as f64 / (2.0 * n as f64)).sin();
    let power: Vec<f64> =
        (0..n).map(|bin| spectrum[bin].norm_sqr() / differenced(bin.max(1)).powi(2)).collect();
    let frequency = |bin: usize| bin as f64 / (2.0 * n as f64 * interval);
    let first = (0..n).find(|&bin| frequency(bin) > slowest)?;
    let mut best: Option<(usize, f64)> = None;
    for bin in first..n.saturating_sub(1) {
        // Only a peak can be a line, and the median is dear.
        let peak = power[bin] >= power[bin - 1] && power[bin] >= power[bin + 1];
        if !peak || best.is_some_and(|(at, _)| power[bin] * 4.0 < power[at]) {
            continue;
        }
        let noise = noise_around(&power, bin, first);
        if noise == 0.0 {
            continue;
        }
        let ratio = power[bin] / noise;
        if best.is_none_or(|(_, most)| ratio > most) {
            best = Some((bin, ratio));
        }
    }
    let (bin, ratio) = best?;
    let frequency = frequency(bin);
    let phase = |time: f64| std::f64::consts::TAU * frequency * time;
    let start = times[0] - run.recording.increments[0].interval;
    let mut sums = (0.0, 0.0);
    let mean = residuals.iter().sum::<f64>() / n as f64;
    for ((residual, time), sample) in residuals.iter().zip(times).zip(&run.recording.increments) {
        let (sin, cos) = phase(time - 0.5 * sample.interval - start).sin_cos();
        sums.0 += (residual - mean) * cos;
        sums.1 += (residual - mean) * sin;
    }
    let half_turn = std::f64::consts::PI * frequency * interval;
    let gain = half_turn.sin() / half_turn * 0.5 * n as f64;
    let (cos, sin) = (sums.0 / gain, sums.1 / gain);
    // A line of this power over the noise is so many sigmas high.
    let sigma = cos.hypot(sin) / (2.0 * ratio).sqrt();
    // Twice as many frequencies as are independent; and the median of so many is not quite the noise's.
    let looks = (n - first) as f64;
    let known = MEDIAN * AROUND.min(n - first) as f64;
    let ln_p = looks.ln() + 2.0_f64.ln() - known * (ratio / known).ln_1p();
    Some(Line { frequency, cos, sin, sigma, ln_p })
}

/// The mean power of the noise about a bin.
fn noise_around(power: &[f64], bin: usize, first: usize) -> f64 {
    let low = bin.saturating_sub(AROUND).max(first);
    let mut around = power[low..(bin + AROUND).min(power.len())].to_vec();
    let middle = around.len() / 2;
    let (_, median, _) = around.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of an exponential distribution is ln 2 of its mean.
    *median / std::f64::consts::LN_2
}

fn cause(channel: usize, line: &Line, ln_p: f64, run: usize) -> (Chosen, Cause) {
    let term = &catalogue::INTERFERENCE_LINE;
    let axis = [1.0, 2.0, 3.0][channel % 3];
    let mut chosen =
        Chosen::new(term).with_setting("frequency", line.frequency).with_setting("axis", axis);
    let first = if channel < 3 { 0 } else { 2 };
    let parameters = [(first, line.cos), (first + 1, line.sin)].map(|(place, value)| {
        chosen.values[place] = value;
        estimate(term, place, Some(run), value, line.sigma)
    });
    let cause = Cause {
        term,
        settings: chosen.settings.clone(),
        sought: None,
        parameters: parameters.to_vec(),
        ln_p,
        dof: 2,
        gain: 0.5 * (line.cos.powi(2) + line.sin.powi(2)) / line.sigma.powi(2),
        rivals: Vec::new(),
    };
    (chosen, cause)
}
