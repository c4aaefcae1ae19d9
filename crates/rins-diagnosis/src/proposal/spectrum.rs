//! The spectrum of a series sample by sample, and the line that stands highest over the noise about it.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::median::median;

/// The noise under a line is the median of so many frequencies on each side.
const AROUND: usize = 600;

/// What a median of exponential figures says of their mean, against what all of them would say: (ln 2)².
const MEDIAN: f64 = 0.48;

/// The power of a series at twice the frequencies that are independent.
pub(crate) struct Spectrum {
    /// `|Σ x exp(-2πift)|²`.
    power: Vec<f64>,
    /// The noise's, over all that is looked at.
    usual: f64,
    /// The first frequency that is looked at.
    first: usize,
    /// The step between frequencies \[Hz\].
    step: f64,
}

/// A frequency at which some series stand over their noise.
pub(crate) struct Peak {
    /// \[Hz\]
    pub(crate) frequency: f64,
    /// The power of all series there, each over its noise.
    pub(crate) ratio: f64,
    /// The logarithm of the chance that noise stands so high anywhere.
    pub(crate) ln_p: f64,
}

impl Spectrum {
    /// Of a series whose samples are `interval` \[s\] apart, above `slowest` \[Hz\]; none of a series without noise there.
    pub(crate) fn of(series: &[f64], interval: f64, slowest: f64) -> Option<Self> {
        let n = series.len();
        let step = 0.5 / (n as f64 * interval);
        let first = (1..n).find(|&bin| bin as f64 * step > slowest)?;
        // From one sample to the next: what is slow, a bias or a ramp, leaks into no other frequency.
        let differences = series.windows(2).map(|pair| pair[1] - pair[0]);
        let mut spectrum: Vec<Complex<f64>> = differences.map(|x| Complex::new(x, 0.0)).collect();
        spectrum.resize(2 * n, Complex::new(0.0, 0.0));
        FftPlanner::new().plan_fft_forward(2 * n).process(&mut spectrum);
        // And back, so that white noise is white.
        let half_turn = |bin: usize| std::f64::consts::PI * bin as f64 / (2.0 * n as f64);
        let differenced = |bin: usize| (2.0 * half_turn(bin.max(1)).sin()).powi(2);
        let power: Vec<f64> =
            (0..n).map(|bin| spectrum[bin].norm_sqr() / differenced(bin)).collect();
        let usual = mean_of_noise(&power[first..]);
        (usual > 0.0).then_some(Self { power, usual, first, step })
    }

    /// The standard deviation of white noise as strong as what is about a frequency \[Hz\].
    pub(crate) fn noise_at(&self, frequency: f64) -> f64 {
        let n = self.power.len();
        let near = (self.first..n).min_by(|a, b| {
            let off = |bin: &usize| (*bin as f64 * self.step - frequency).abs();
            off(a).total_cmp(&off(b))
        });
        (self.noise_around(near.unwrap_or(self.first)) / n as f64).sqrt()
    }

    /// The mean power of the noise about a bin.
    fn noise_around(&self, bin: usize) -> f64 {
        let low = bin.saturating_sub(AROUND).max(self.first);
        mean_of_noise(&self.power[low..(bin + AROUND).min(self.power.len())])
    }
}

/// The mean of exponential figures, from their median: a line is no noise.
fn mean_of_noise(power: &[f64]) -> f64 {
    // The median of an exponential distribution is ln 2 of its mean.
    median(power) / std::f64::consts::LN_2
}

/// Where some series of one length stand highest over their noise together, each of one sensor.
pub(crate) fn highest(spectra: &[&Spectrum]) -> Option<Peak> {
    let first = spectra.first()?.first;
    let n = spectra[0].power.len();
    let total: Vec<f64> = (0..n)
        .map(|bin| spectra.iter().map(|one| one.power[bin] / one.usual).sum::<f64>())
        .collect();
    let mut best: Option<(usize, f64)> = None;
    for bin in first..n.saturating_sub(1) {
        // Only a peak can be a line, and the median is dear.
        let is_peak = total[bin] >= total[bin - 1] && total[bin] >= total[bin + 1];
        if !is_peak || best.is_some_and(|(at, _)| total[bin] * 4.0 < total[at]) {
            continue;
        }
        let over = |one: &&Spectrum| one.power[bin] / one.noise_around(bin);
        let ratio: f64 = spectra.iter().map(over).sum();
        if ratio.is_finite() && best.is_none_or(|(_, most)| ratio > most) {
            best = Some((bin, ratio));
        }
    }
    let (bin, ratio) = best?;
    // Twice as many frequencies as are independent; and the median of so many is not quite the noise's.
    let looks = (n - first) as f64;
    let known = MEDIAN * AROUND.min(n - first) as f64;
    let exponent = known * (ratio / known).ln_1p();
    // The tail of a sum of exponential figures.
    let mut term = 1.0;
    let mut tail = 0.0;
    for count in 0..spectra.len() {
        tail += term;
        term *= exponent / (count + 1) as f64;
    }
    Some(Peak {
        frequency: bin as f64 * spectra[0].step,
        ratio,
        ln_p: looks.ln() + 2.0_f64.ln() + tail.ln() - exponent,
    })
}
