//! A measured log as `rins convert` writes it, and the spectra of its channels.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;
use std::process::Command;

use rand::RngExt;
use rins_blind::Random;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::trouble::Trouble;

/// The longest part of a log that is diagnosed, in samples.
const LONGEST: usize = 6000;

/// How many segments Welch's method averages, half of each overlapping the next.
const SEGMENTS: usize = 15;

/// A log: the rate and the specific force of each sample.
#[derive(Clone, Debug)]
pub(crate) struct MeasuredLog {
    /// The name of its rig file.
    pub(crate) name: String,
    /// The end of each sample \[s\].
    pub(crate) times: Vec<f64>,
    /// The three gyros \[rad/s\], then the three accelerometers \[m/s²\].
    pub(crate) channels: [Vec<f64>; 6],
    /// The least significant bit of the increments of each channel, if it is quantized \[rad or m/s\].
    bits: [Option<f64>; 6],
    /// The temperature, if it was measured.
    temperature: Option<Vec<f64>>,
    /// The sensor's axis that is the spin axis, if the log rotates.
    pub(crate) spin: Option<usize>,
    rig: String,
}

impl MeasuredLog {
    /// The log of a rig file, converted in `folder`.
    pub(crate) fn read(program: &Path, rig: &Path, folder: &Path) -> Result<Self, Trouble> {
        let csv = folder.join("whole.csv");
        let output = Command::new(program).arg("convert").arg(rig).arg("-o").arg(&csv).output()?;
        if !output.status.success() {
            return Err(io::Error::other(
                String::from_utf8_lossy(&output.stderr).trim().to_owned(),
            )
            .into());
        }
        let text = fs::read_to_string(&csv)?;
        let mut rows = text.lines();
        let columns = rows.next().map_or(0, |head| head.split(',').count());
        let number = |field: &str| field.parse::<f64>().map_err(io::Error::other);
        let rows: Vec<Vec<f64>> =
            rows.map(|row| row.split(',').map(number).collect()).collect::<Result<_, _>>()?;
        if rows.len() < 2 || rows.iter().any(|row| row.len() != columns || columns < 7) {
            return Err(
                io::Error::other(format!("{} has no rows of 7 columns", csv.display())).into()
            );
        }
        let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        let interval = |row: usize| times[row.max(1)] - times[row.max(1) - 1];
        // The new log holds increments.
        let channels = std::array::from_fn(|channel| {
            rows.iter().enumerate().map(|(row, all)| all[channel + 1] / interval(row)).collect()
        });
        let bits = std::array::from_fn(|channel| {
            bit(&rows.iter().map(|row| row[channel + 1]).collect::<Vec<f64>>())
        });
        let rig_text = fs::read_to_string(csv.with_extension("toml"))?;
        let spin = ["x", "y", "z"]
            .iter()
            .position(|axis| rig_text.contains(&format!("spin = \"{axis}\"")));
        Ok(Self {
            name: rig.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            temperature: (columns > 7).then(|| rows.iter().map(|row| row[7]).collect()),
            times,
            channels,
            bits,
            spin,
            rig: rig_text,
        })
    }

    /// A random part of the log, or the whole if it is short.
    pub(crate) fn window(&self, random: &mut Random) -> Self {
        let samples = self.times.len();
        let longest = if self.spin.is_some() { samples } else { LONGEST.min(samples / 4) };
        let first = if longest < samples { random.random_range(0..samples - longest) } else { 0 };
        let part = first..first + longest;
        let of = |all: &Vec<f64>| all[part.clone()].to_vec();
        Self {
            name: self.name.clone(),
            times: of(&self.times),
            channels: self.channels.each_ref().map(of),
            bits: self.bits,
            temperature: self.temperature.as_ref().map(of),
            spin: self.spin,
            rig: self.rig.clone(),
        }
    }

    /// Its duration \[s\].
    pub(crate) fn duration(&self) -> f64 {
        self.end() - self.times[0]
    }

    fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Adds `amplitude` times a signal to a channel.
    pub(crate) fn add(&mut self, channel: usize, signal: &[f64], amplitude: f64) {
        for (value, signal) in self.channels[channel].iter_mut().zip(signal) {
            *value += amplitude * signal;
        }
    }

    /// Writes `log.csv` and `rig.toml` into a folder. What was quantized is quantized again: the errors were there before the converter.
    pub(crate) fn write(&self, folder: &Path) -> Result<(), Trouble> {
        let mut text = String::from("time,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z");
        text.push_str(if self.temperature.is_some() { ",temperature\n" } else { "\n" });
        let mut left = [0.0; 6];
        for row in 0..self.times.len() {
            let interval = self.times[row.max(1)] - self.times[row.max(1) - 1];
            let _ = write!(text, "{}", self.times[row]);
            for (channel, readings) in self.channels.iter().enumerate() {
                let mut increment = readings[row] * interval;
                if let Some(bit) = self.bits[channel] {
                    // The converter keeps what it does not put out.
                    let whole = increment + left[channel];
                    increment = (whole / bit).round() * bit;
                    left[channel] = whole - increment;
                }
                let _ = write!(text, ",{increment:e}");
            }
            if let Some(temperature) = &self.temperature {
                let _ = write!(text, ",{}", temperature[row]);
            }
            text.push('\n');
        }
        fs::write(folder.join("log.csv"), text)?;
        let line = |line: &str| match line.split(" = ").next() {
            Some("path") => "path = \"log.csv\"\n".into(),
            // The part has an interval of its own.
            Some("static") => {
                format!("static = [[\"{} s\", \"{} s\"]]\n", self.times[0], self.end())
            }
            _ => format!("{line}\n"),
        };
        let rig: String = self.rig.lines().map(line).collect();
        Ok(fs::write(folder.join("rig.toml"), rig)?)
    }
}

/// The squares of the discrete Fourier transform, up to the Nyquist frequency.
pub(crate) fn spectrum(signal: &[f64]) -> Vec<f64> {
    let mut buffer: Vec<Complex<f64>> =
        signal.iter().map(|re| Complex { re: *re, im: 0.0 }).collect();
    FftPlanner::new().plan_fft_forward(buffer.len()).process(&mut buffer);
    buffer[..=signal.len() / 2].iter().map(Complex::norm_sqr).collect()
}

/// The two-sided spectral density of a signal by Welch's method, as a function of the frequency \[Hz\]; constant below the
/// lowest frequency that a segment resolves.
pub(crate) fn spectral_density(signal: &[f64], interval: f64) -> impl Fn(f64) -> f64 + use<> {
    let length = (2 * signal.len() / (SEGMENTS + 1)).max(2);
    let window: Vec<f64> = (0..length)
        .map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * (k as f64 + 0.5) / length as f64).cos())
        .collect();
    let power: f64 = window.iter().map(|w| w * w).sum();
    let mut sum = vec![0.0; length / 2 + 1];
    let mut segments = 0.0;
    let mut first = 0;
    while first + length <= signal.len() {
        let part = &signal[first..first + length];
        let mean = part.iter().sum::<f64>() / length as f64;
        let windowed: Vec<f64> = part.iter().zip(&window).map(|(x, w)| (x - mean) * w).collect();
        for (sum, own) in sum.iter_mut().zip(spectrum(&windowed)) {
            *sum += own * interval / power;
        }
        segments += 1.0;
        first += length / 2;
    }
    let width = 1.0 / (length as f64 * interval);
    move |frequency: f64| {
        let place = (frequency / width).clamp(1.0, (sum.len() - 1) as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let below = (place as usize).min(sum.len() - 2);
        let part = place - below as f64;
        ((1.0 - part) * sum[below] + part * sum[below + 1]) / segments
    }
}

/// The least significant bit of increments, if they are multiples of one that is large compared with what rounding their decimals does.
fn bit(increments: &[f64]) -> Option<f64> {
    let mut sorted = increments.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let most = sorted[0].abs().max(sorted[sorted.len() - 1].abs());
    let differences = sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let bit = differences.filter(|step| *step > 1e-9 * most).min_by(f64::total_cmp)?;
    let is_multiple = |step: f64| {
        let parts = step / bit;
        (parts - parts.round()).abs() < 0.01
    };
    let coarse = sorted.windows(2).all(|pair| is_multiple(pair[1] - pair[0]));
    (coarse && is_multiple(sorted[0])).then_some(bit)
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution, StandardNormal};
    use rins_blind::random;

    use super::*;

    /// White noise of variance σ² has the two-sided density σ² Δt.
    #[test]
    fn white_noise_has_its_density() {
        let mut random = random(20261130, 0);
        let noise: Vec<f64> = (0..64_000)
            .map(|_| 3.0 * Distribution::<f64>::sample(&StandardNormal, &mut random))
            .collect();
        let density = spectral_density(&noise, 0.01);
        let bins = 1..50;
        let mean = bins.clone().map(|bin| density(f64::from(bin))).sum::<f64>() / bins.len() as f64;
        assert!((mean / 0.09 - 1.0).abs() < 0.1, "{mean}");
    }

    /// Parseval: a sinusoid of `n` samples has the square `n²/4` in its bin.
    #[test]
    fn a_sinusoid_is_in_its_bin() {
        let signal: Vec<f64> = (0..1000)
            .map(|k| (std::f64::consts::TAU * 7.0 * f64::from(k) / 1000.0).sin())
            .collect();
        let power = spectrum(&signal);
        assert!((power[7] / 250_000.0 - 1.0).abs() < 1e-9, "{}", power[7]);
        assert!(power[9] < 1e-9 * power[7], "{}", power[9]);
    }

    #[test]
    fn bit_is_that_of_whole_counts_only() {
        let counts = [-3.0, 0.0, 1.0, 2.0, 2.0, 7.0, 1.0];
        let found = bit(&counts.map(|count| count * 1.223e-3)).unwrap();
        assert!((found - 1.223e-3).abs() < 1e-12, "{found}");
        assert_eq!(bit(&counts.map(|count| count * 1.223e-3 + 0.2e-3)), None);
        assert_eq!(bit(&[0.1, 0.25, 0.37, 0.9, 1.234]), None);
    }
}
