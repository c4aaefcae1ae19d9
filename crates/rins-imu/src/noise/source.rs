//! The random errors of three sensors, one increment after the other.

use core::array;

use nalgebra::Vector3;
use rins_frames::{Body, InFrame};

use super::model::{NoiseError, NoiseModel, Span};
use super::process::{BiasProcess, BiasStep};
use super::quantiser::Quantiser;
use super::seed::{NormalStream, Seed, Sensor};
use crate::axis::{Axis, Triad};

/// A source of the random errors of a triad.
///
/// The random biases are propagated and integrated by their exact discretization, so that the
/// statistics do not depend on the division of time into intervals.
///
/// ```
/// use rins_imu::{NoiseModel, Seed, Span, Triad, TriadNoise};
/// let model = NoiseModel::white(1e-6); // rad/s/√Hz
/// let span = Span { interval: 0.01, duration: 60.0 };
/// let mut noise = TriadNoise::new(&model, &span, Triad::Gyro, Seed::new(1))?;
///
/// let increment = noise.next(0.01);
/// assert!(increment.norm() < 1e-6); // six sigma: 1e-6 √0.01 rad an axis
/// # Ok::<(), rins_imu::NoiseError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TriadNoise {
    streams: [NormalStream; 3],
    processes: Vec<BiasProcess>,
    /// The present bias of each process on each axis.
    biases: Vec<Vector3<f64>>,
    white_variance: f64,
    quantiser: Option<Quantiser>,
    steps: Steps,
}

/// The discretization of the processes for intervals of one length.
#[derive(Clone, Debug)]
struct Steps {
    interval: f64,
    each: Vec<BiasStep>,
    /// The standard deviation of the part of an increment that the biases do not explain \[rad or m/s\].
    remainder: f64,
}

impl TriadNoise {
    /// The source for `triad` in the run of `seed`; flicker noise is approximated for times within `span`.
    ///
    /// # Errors
    /// [`NoiseError`] if a number is negative, not finite, or zero although it must be positive.
    pub fn new(
        model: &NoiseModel,
        span: &Span,
        triad: Triad,
        seed: Seed,
    ) -> Result<Self, NoiseError> {
        model.check()?;
        span.check()?;
        let processes = model.bias_processes(span);
        let mut streams = Axis::ALL.map(|axis| seed.stream(Sensor::Inertial(triad, axis)));
        let start = |process: &BiasProcess| samples(&mut streams) * process.initial_sigma();
        let biases = processes.iter().map(start).collect();
        let white_variance = model.white_density * model.white_density;
        let steps = Steps { interval: f64::NAN, each: Vec::new(), remainder: 0.0 };
        let quantiser = model.quantisation.map(Quantiser::new);
        let mut noise = Self { streams, processes, biases, white_variance, quantiser, steps };
        noise.prepare(span.interval);
        Ok(noise)
    }

    /// The integral of the noise over the next `interval` \[rad or m/s\], without quantization.
    ///
    /// The result is NaN if the interval is negative or NaN.
    pub fn next(&mut self, interval: f64) -> InFrame<Body> {
        if interval.to_bits() != self.steps.interval.to_bits() {
            self.prepare(interval);
        }
        let mut increment = samples(&mut self.streams) * self.steps.remainder;
        for (bias, step) in self.biases.iter_mut().zip(&self.steps.each) {
            let before = *bias;
            *bias = before * step.decay + samples(&mut self.streams) * step.spread;
            increment += (before + *bias) * step.weight;
        }
        InFrame::from_components(increment)
    }

    /// The output of the triad over the next `interval` \[s\], of which `increment` is the noise-free output
    /// \[rad or m/s\]: noise is added, and the sum is rounded to the resolution.
    #[must_use]
    pub fn corrupt(&mut self, increment: &InFrame<Body>, interval: f64) -> InFrame<Body> {
        let noisy = *increment + self.next(interval);
        match &mut self.quantiser {
            None => noisy,
            Some(quantiser) => {
                InFrame::from_components(quantiser.quantise(noisy.components(), interval))
            }
        }
    }

    /// The present sum of the random biases \[rad/s or m/s²\].
    pub fn wander(&self) -> InFrame<Body> {
        InFrame::from_components(self.biases.iter().sum())
    }

    /// Discretizes the processes for intervals of another length.
    fn prepare(&mut self, interval: f64) {
        self.steps.interval = interval;
        self.steps.each.clear();
        self.steps.each.extend(self.processes.iter().map(|process| process.step(interval)));
        let residuals: f64 = self.steps.each.iter().map(|step| step.residual).sum();
        self.steps.remainder = (self.white_variance * interval + residuals).sqrt();
    }
}

/// A standard normal number from each stream.
fn samples(streams: &mut [NormalStream; 3]) -> Vector3<f64> {
    Vector3::from(array::from_fn(|axis| streams[axis].sample()))
}
