//! Online estimation: samples in, estimates and compensated increments out.

mod setup;

mod normal;
mod window;

mod linearized;

mod filter;

mod checkpoint;
mod estimates;

pub use self::checkpoint::{Bits, OnlineCheckpoint};
pub use self::filter::{OnlineFilter, OnlineSample, OnlineUpdate};
pub use self::setup::{OnlineError, OnlineSetup};
