//! The Allan deviation of a rest, and the noise that it shows.

mod covariance;
mod curve;
mod fit;
mod law;
mod line;

pub use curve::{AllanError, AllanPlan, AllanPoint, CONFIDENCE};
pub use fit::{NoiseSeen, Strength};
pub use law::NoiseLaw;
pub use line::{SpectralLine, take_out_lines};

#[cfg(test)]
mod tests;
