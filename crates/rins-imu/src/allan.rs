//! The Allan deviation over a static interval, and the noise parameters fitted to it.

mod covariance;
mod curve;
mod fit;
mod law;
mod line;
mod point;

pub use curve::{AllanError, AllanPlan};
pub use fit::{NoiseSeen, NoiseTerm};
pub use law::NoiseLaw;
pub use line::{SpectralLine, take_out_lines};
pub use point::{AllanPoint, CONFIDENCE};

#[cfg(test)]
mod tests;
