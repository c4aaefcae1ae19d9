//! A sine of one frequency in some series, its frequency sought: how large it is in each, and how well all of it is known.

use nalgebra::{DMatrix, DVector};

/// How often a frequency is moved at most.
const MOST_MOVES: usize = 12;

/// A frequency stays that is off by less than this part of its sigma.
const NEARLY: f64 = 1e-3;

/// A frequency is moved by no more than this part of what a run resolves: further on, the sine is not linear in it.
const LONGEST_MOVE: f64 = 0.25;

/// One series and its noise.
pub(crate) struct Series<'a> {
    /// Means over the samples.
    pub(crate) values: &'a [f64],
    /// The standard deviation of its noise about the sine's frequency.
    pub(crate) noise: f64,
}

/// `c cos 2πft + s sin 2πft` in each of some series.
#[derive(Debug)]
pub(crate) struct Sinusoid {
    /// \[Hz\]
    pub(crate) frequency: f64,
    /// The 1σ of the frequency \[Hz\].
    pub(crate) sigma: f64,
    /// The cosine's amplitude and the sine's in each series, and their 1σ, the frequency being unknown.
    pub(crate) amplitudes: Vec<[(f64, f64); 2]>,
    /// By how much it raises the logarithm of the likelihood.
    pub(crate) gain: f64,
}

/// The most likely sine near a frequency \[Hz\]. `times` are the middles of the samples \[s\], which are means over
/// `interval` \[s\]; of a sample without a time nothing is known.
///
/// A phase is counted from the time zero, so that an error of the frequency turns it: that is in its sigma.
pub(crate) fn sinusoid(
    series: &[Series<'_>],
    times: &[Option<f64>],
    interval: f64,
    near: f64,
) -> Option<Sinusoid> {
    let duration = times.iter().flatten().last()? - times.iter().flatten().next()?;
    let means: Vec<f64> = series.iter().map(|one| mean(one.values, times)).collect();
    let mut frequency = near;
    let mut amplitudes = vec![[0.0; 2]; series.len()];
    for _ in 0..MOST_MOVES {
        let normal = Normal::of(series, &means, times, interval, (frequency, &amplitudes));
        amplitudes = normal.amplitudes()?;
        let normal = Normal::of(series, &means, times, interval, (frequency, &amplitudes));
        let (solution, covariance) = normal.solved()?;
        let last = 2 * series.len();
        let sigma = covariance[(last, last)].sqrt();
        let moved = solution[last];
        if moved.abs() < NEARLY * sigma {
            let known = |place: usize| covariance[(place, place)].sqrt();
            let pair = |(k, [cos, sin]): (usize, &[f64; 2])| {
                [(*cos, known(2 * k)), (*sin, known(2 * k + 1))]
            };
            return Some(Sinusoid {
                frequency,
                sigma,
                amplitudes: amplitudes.iter().enumerate().map(pair).collect(),
                gain: normal.gain(&amplitudes),
            });
        }
        let most = LONGEST_MOVE / duration;
        frequency += moved.clamp(-most, most);
        if (frequency - near).abs() * duration > 1.0 {
            return None;
        }
    }
    None
}

/// The mean of a series where something is known of it.
fn mean(values: &[f64], times: &[Option<f64>]) -> f64 {
    let known = || times.iter().zip(values).filter(|(time, _)| time.is_some());
    known().map(|(_, value)| value).sum::<f64>() / known().count() as f64
}

/// Normal equations of the amplitudes, two for each series, and of the frequency.
struct Normal {
    matrix: DMatrix<f64>,
    vector: DVector<f64>,
}

impl Normal {
    /// About a frequency and amplitudes; the right side holds the series themselves for the amplitudes, and what they leave
    /// for the frequency.
    fn of(
        series: &[Series<'_>],
        means: &[f64],
        times: &[Option<f64>],
        interval: f64,
        (frequency, amplitudes): (f64, &[[f64; 2]]),
    ) -> Self {
        let last = 2 * series.len();
        let mut matrix = DMatrix::zeros(last + 1, last + 1);
        let mut vector = DVector::zeros(last + 1);
        let half_turn = std::f64::consts::PI * frequency * interval;
        let averaged = half_turn.sin() / half_turn;
        for (sample, time) in times.iter().enumerate() {
            let Some(time) = time else { continue };
            let (sin, cos) = (std::f64::consts::TAU * frequency * time).sin_cos();
            for (k, one) in series.iter().enumerate() {
                let weight = one.noise.powi(-2);
                let [of_cos, of_sin] = amplitudes[k];
                let along = averaged * std::f64::consts::TAU * time * (of_sin * cos - of_cos * sin);
                let columns = [(2 * k, averaged * cos), (2 * k + 1, averaged * sin), (last, along)];
                let value = one.values[sample] - means[k];
                let left = value - averaged * (of_cos * cos + of_sin * sin);
                for (row, by_row) in columns {
                    let of_row = if row == last { left } else { value };
                    vector[row] += weight * by_row * of_row;
                    for (column, by_column) in columns {
                        matrix[(row, column)] += weight * by_row * by_column;
                    }
                }
            }
        }
        Self { matrix, vector }
    }

    /// The amplitudes at this frequency.
    fn amplitudes(&self) -> Option<Vec<[f64; 2]>> {
        let n = self.vector.len() - 1;
        let corner = self.matrix.view((0, 0), (n, n)).into_owned();
        let solved = corner.cholesky()?.solve(&self.vector.rows(0, n).into_owned());
        Some(solved.as_slice().chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect())
    }

    /// By how far the frequency is off, with the covariance of all.
    ///
    /// At the best amplitudes nothing pulls at them: what is left pulls at the frequency alone.
    fn solved(&self) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let covariance = self.matrix.clone().cholesky()?.inverse();
        let n = self.vector.len() - 1;
        let mut pull = DVector::zeros(n + 1);
        pull[n] = self.vector[n];
        Some((&covariance * pull, covariance))
    }

    fn gain(&self, amplitudes: &[[f64; 2]]) -> f64 {
        let flat = amplitudes.iter().flatten();
        0.5 * flat.zip(self.vector.iter()).map(|(amplitude, with)| amplitude * with).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;

    const INTERVAL: f64 = 0.05;
    const FREQUENCY: f64 = 3.217;

    /// Two series with their sines, as means over samples, in noise.
    fn noisy(seed: u64, truth: [[f64; 2]; 2]) -> ([Vec<f64>; 2], Vec<Option<f64>>) {
        let mut random = Pcg64::seed_from_u64(seed);
        let turn = std::f64::consts::TAU * FREQUENCY;
        // The mean over a sample, from the integral of the sine.
        let integral =
            |[c, s]: [f64; 2], t: f64| (c * (turn * t).sin() - s * (turn * t).cos()) / turn;
        let mut both = [Vec::new(), Vec::new()];
        let mut times = Vec::new();
        for sample in 0..4000 {
            let begin = f64::from(sample) * INTERVAL;
            let end = begin + INTERVAL;
            for (values, of) in both.iter_mut().zip(truth) {
                let noise: f64 = StandardNormal.sample(&mut random);
                values.push((integral(of, end) - integral(of, begin)) / INTERVAL + noise + 0.3);
            }
            times.push((sample % 50 != 7).then_some(begin + 0.5 * INTERVAL));
        }
        (both, times)
    }

    /// Off by their sigmas and no more: every amplitude, and the frequency.
    #[test]
    fn sigmas_hold_what_the_frequency_does_to_the_phase() {
        const RUNS: u64 = 60;
        let truth = [[0.3, -0.1], [0.0, 0.2]];
        let mut squares = [0.0; 5];
        for seed in 0..RUNS {
            let (both, times) = noisy(seed, truth);
            let series = both.each_ref().map(|values| Series { values, noise: 1.0 });
            // As far off as a spectrum's frequencies are apart.
            let found = sinusoid(&series, &times, INTERVAL, FREQUENCY + 1e-3).unwrap();
            squares[4] += ((found.frequency - FREQUENCY) / found.sigma).powi(2);
            for (place, (value, sigma)) in found.amplitudes.iter().flatten().enumerate() {
                squares[place] += ((value - truth[place / 2][place % 2]) / sigma).powi(2);
            }
        }
        // Chi-square of 60 degrees: four sigma of its mean.
        let bound = 4.0 * (2.0 / RUNS as f64).sqrt();
        for square in squares {
            let mean = square / RUNS as f64;
            assert!((mean - 1.0).abs() < bound, "{squares:?}");
        }
    }
}
