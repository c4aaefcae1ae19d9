//! The errors of an inertial measurement unit, and their compensation.
//!
//! **What it does.** [`ImuError`] is the deterministic part of eq. (1): measured = true + bias +
//! `(S + M)` true, for a triad of gyros and a triad of accelerometers, with its exact
//! [`Compensation`]. [`ImuNoise`] is the random part: white noise, random walk, Gauss-Markov and
//! flicker noise, and a finite resolution, from a [`Seed`] that gives the same numbers on every
//! machine. [`AllanPlan`] estimates the noise parameters over a static interval, from the Allan deviation.
//!
//! **What it does not do.** It estimates nothing but noise, models no motion, and has no errors that
//! depend on time, temperature or acceleration.
//!
//! Vectors are resolved in the body frame, in SI units and radians.
//!
//! ```
//! use rins_frames::{InFrame, units::{ARCSEC, PPM}};
//! use rins_imu::{Axis, TriadError};
//!
//! let gyro = TriadError::default()
//!     .with_scale(Axis::Z, 300.0 * PPM)
//!     .with_misalignment(Axis::X, Axis::Z, 60.0 * ARCSEC);
//! let spin = InFrame::new(0.0, 0.0, 1.0);
//!
//! let measured = gyro.measured_rate(&spin);
//! assert!((measured.components().z - 1.0003).abs() < 1e-15);
//! assert!((measured.components().x - 60.0 * ARCSEC).abs() < 1e-18);
//!
//! let undone = gyro.compensation()?.true_rate(&measured);
//! assert!((undone - spin).norm() < 1e-15);
//! # Ok::<(), rins_imu::CompensationError>(())
//! ```
mod axis;
mod preset;
mod spec;
mod triad;

mod imu;
mod noise;

mod allan;

pub use allan::{
    AllanError, AllanPlan, AllanPoint, CONFIDENCE, NoiseLaw, NoiseSeen, NoiseTerm, SpectralLine,
    take_out_lines,
};
pub use axis::{Axis, Triad};
pub use imu::{Compensation, ImuCompensationError, ImuError};
pub use noise::{
    BiasProcess, BiasStep, GaussMarkov, ImuNoise, ImuNoiseError, ImuNoiseSource, NoiseError,
    NoiseModel, NormalStream, Quantisation, Seed, Sensor, Span, TriadNoise, rounded,
};
pub use preset::{GRADES, Preset, SENSORS};
pub use spec::{ImuSpec, TriadSpec};
pub use triad::{CompensationError, TriadCompensation, TriadError};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
