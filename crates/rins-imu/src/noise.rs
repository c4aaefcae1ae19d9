//! The random errors of an IMU.

mod imu;
mod model;
mod normal;
mod process;
mod quantiser;
mod seed;
mod source;

pub use imu::{ImuNoise, ImuNoiseError, ImuNoiseSource};
pub use model::{NoiseError, NoiseModel, Quantisation, Span};
pub use process::{BiasProcess, BiasStep, GaussMarkov};
pub use quantiser::rounded;
pub use seed::{NormalStream, Seed, Sensor};
pub use source::TriadNoise;
