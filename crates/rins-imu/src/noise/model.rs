//! The components of the random error of a triad.

use super::process::{BiasProcess, GaussMarkov};
use crate::spec::TriadSpec;

/// The random errors of each sensor of a triad, all independent. The default is none.
///
/// A "rate" is in rad/s for gyros and in m/s² for accelerometers. Densities and coefficients are
/// those of IEEE Std 952-1997, appendix C: two-sided, so that the Allan variance of white noise is N²/τ.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NoiseModel {
    /// `N`, the noise density: the root power spectral density of white noise in the rate \[rate/√Hz\]; the same
    /// number as angle or velocity random walk \[rad/√s, m/s/√s\]. Its Allan deviation is N/√τ.
    pub white_density: f64,
    /// `K`, the root density of the white noise whose integral is added to the rate \[rate/√s\];
    /// the random walk starts at zero. Its Allan deviation is K√(τ/3).
    pub bias_random_walk: f64,
    /// Gauss-Markov biases: each starts in its stationary distribution.
    pub gauss_markov: Vec<GaussMarkov>,
    /// `B`, the bias instability \[rate\]: flicker noise of density B²/(2πf), whose Allan
    /// deviation is flat at √(2 ln 2/π) B = 0.664 B.
    pub flicker: Option<f64>,
    /// The resolution of the output.
    pub quantisation: Option<Quantisation>,
}

/// The least significant bit of a sensor's output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantisation {
    /// The LSB of an increment \[rad or m/s\]. The rounding remainder is carried to a later increment, as
    /// by a sensor that counts pulses, so that the error of sums never exceeds half a bit.
    Increment(f64),
    /// The LSB of a mean rate \[rad/s or m/s²\]. The rounding remainder is lost.
    Rate(f64),
}

impl NoiseModel {
    /// White noise of root density `density` \[rate/√Hz\] alone.
    pub fn white(density: f64) -> Self {
        Self { white_density: density, ..Self::default() }
    }

    /// The Gauss-Markov processes that approximate flicker noise, over a run of the given span.
    ///
    /// Time constants with a ratio of four, from a sixteenth of an interval to four times the duration, each of
    /// variance (ln 4/π) B²: their summed density is B²/(2πf) within 1 % between 1/duration and a
    /// tenth of half the sampling rate, and its power is 6 % lower than that at half the sampling rate.
    pub(super) fn flicker_processes(&self, span: &Span) -> Vec<GaussMarkov> {
        const RATIO: f64 = 4.0;
        const LN_RATIO: f64 = 2.0 * core::f64::consts::LN_2;
        let Some(instability) = self.flicker else { return Vec::new() };
        let sigma = instability * (LN_RATIO / core::f64::consts::PI).sqrt();
        let first = span.interval / (RATIO * RATIO);
        core::iter::successors(Some(first), |time| {
            (*time < RATIO * span.duration).then_some(time * RATIO)
        })
        .map(|correlation_time| GaussMarkov { sigma, correlation_time })
        .collect()
    }

    /// The random bias processes of one sensor, with those that approximate flicker noise over a run of the given span.
    pub fn bias_processes(&self, span: &Span) -> Vec<BiasProcess> {
        let mut processes = Vec::new();
        if self.bias_random_walk > 0.0 {
            processes.push(BiasProcess::Walk { density: self.bias_random_walk });
        }
        let forgetting = self.gauss_markov.iter().copied().chain(self.flicker_processes(span));
        let forgetting = forgetting.filter(|process| process.sigma > 0.0);
        processes.extend(forgetting.map(BiasProcess::Relaxing));
        processes
    }

    /// Whether every number is valid for noise.
    pub(super) fn check(&self) -> Result<(), NoiseError> {
        let amplitudes = [self.white_density, self.bias_random_walk, self.flicker.unwrap_or(0.0)];
        let sigmas = self.gauss_markov.iter().map(|process| process.sigma);
        for amplitude in amplitudes.into_iter().chain(sigmas) {
            if !(amplitude.is_finite() && amplitude >= 0.0) {
                return Err(NoiseError::Amplitude { amplitude });
            }
        }
        for &GaussMarkov { correlation_time, .. } in &self.gauss_markov {
            if !(correlation_time.is_finite() && correlation_time > 0.0) {
                return Err(NoiseError::CorrelationTime { correlation_time });
            }
        }
        match self.quantisation {
            Some(Quantisation::Increment(bit) | Quantisation::Rate(bit))
                if !(bit.is_finite() && bit > 0.0) =>
            {
                Err(NoiseError::Resolution { bit })
            }
            _ => Ok(()),
        }
    }
}

/// A data sheet's noise density, random walk and bias instability.
///
/// Its resolution is omitted, because a data sheet does not state whether it refers to rates or increments.
impl From<&TriadSpec> for NoiseModel {
    fn from(spec: &TriadSpec) -> Self {
        Self {
            white_density: spec.noise_density,
            bias_random_walk: spec.random_walk.unwrap_or(0.0),
            flicker: spec.bias_instability,
            ..Self::default()
        }
    }
}

/// The times for which flicker noise is approximated: those of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The interval between samples \[s\].
    pub interval: f64,
    /// The length of the run \[s\].
    pub duration: f64,
}

impl Span {
    pub(super) fn check(&self) -> Result<(), NoiseError> {
        let Self { interval, duration } = *self;
        if interval.is_normal() && interval > 0.0 && duration.is_finite() && duration >= interval {
            Ok(())
        } else {
            Err(NoiseError::Span { interval, duration })
        }
    }
}

/// The reason why a noise model is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoiseError {
    /// A density, standard deviation or instability is negative or not finite.
    #[error("a noise amplitude of {amplitude} is not a finite number of at least zero")]
    Amplitude {
        /// The amplitude, in the unit of its field.
        amplitude: f64,
    },
    /// A correlation time is not positive.
    #[error("a correlation time of {correlation_time} s is not a finite number above zero")]
    CorrelationTime {
        /// The correlation time \[s\].
        correlation_time: f64,
    },
    /// A least significant bit is not positive.
    #[error("an LSB of {bit} is not a finite number above zero; leave it out for none")]
    Resolution {
        /// The bit, in the unit of its variant.
        bit: f64,
    },
    /// The duration of the run is not positive, or shorter than one interval.
    #[error("a run of {duration} s in intervals of {interval} s holds no sample")]
    Span {
        /// The interval \[s\].
        interval: f64,
        /// The duration \[s\].
        duration: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    /// The two-sided density at `frequency` of a sum of Gauss-Markov processes.
    fn density(processes: &[GaussMarkov], frequency: f64) -> f64 {
        let of = |p: &GaussMarkov| {
            let phase = std::f64::consts::TAU * frequency * p.correlation_time;
            2.0 * p.sigma * p.sigma * p.correlation_time / (1.0 + phase * phase)
        };
        processes.iter().map(of).sum()
    }

    #[test]
    fn flicker_density_falls_as_one_over_frequency() {
        const INSTABILITY: f64 = 0.3;
        let span = Span { interval: 0.02, duration: 3600.0 };
        let model = NoiseModel { flicker: Some(INSTABILITY), ..NoiseModel::default() };
        let processes = model.flicker_processes(&span);
        let relative = |frequency: f64| {
            let theory = INSTABILITY * INSTABILITY / (std::f64::consts::TAU * frequency);
            density(&processes, frequency) / theory
        };
        let (slowest, fastest) = (2.0 / span.duration, 0.05 / span.interval);
        for step in 0..=200 {
            let frequency = slowest * (fastest / slowest).powf(f64::from(step) / 200.0);
            assert_close!(relative(frequency), 1.0, 0.01);
        }
        assert_close!(relative(1.0 / span.duration), 1.0, 0.02);
        assert_close!(relative(0.5 / span.interval), 0.94, 0.01);
    }

    #[test]
    fn impossible_models_are_refused_with_their_figure() {
        let markov = |sigma, correlation_time| NoiseModel {
            gauss_markov: vec![GaussMarkov { sigma, correlation_time }],
            ..NoiseModel::default()
        };
        let bit =
            |quantisation| NoiseModel { quantisation: Some(quantisation), ..NoiseModel::default() };
        let flicker = NoiseModel { flicker: Some(f64::INFINITY), ..NoiseModel::default() };
        let cases = [
            (NoiseModel::white(-1.0), NoiseError::Amplitude { amplitude: -1.0 }),
            (flicker, NoiseError::Amplitude { amplitude: f64::INFINITY }),
            (markov(-2.0, 1.0), NoiseError::Amplitude { amplitude: -2.0 }),
            (markov(1.0, 0.0), NoiseError::CorrelationTime { correlation_time: 0.0 }),
            (bit(Quantisation::Rate(0.0)), NoiseError::Resolution { bit: 0.0 }),
            (bit(Quantisation::Increment(-1.0)), NoiseError::Resolution { bit: -1.0 }),
        ];
        for (model, error) in cases {
            assert_eq!(model.check(), Err(error));
        }
        assert!(NoiseModel::white(f64::NAN).check().is_err());
        let span = Span { interval: 0.1, duration: 0.05 };
        assert_eq!(span.check(), Err(NoiseError::Span { interval: 0.1, duration: 0.05 }));
    }
}
