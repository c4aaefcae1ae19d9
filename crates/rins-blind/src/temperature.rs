//! How warm the IMU is.

use std::f64::consts::TAU;

/// A temperature that settles and goes up and down \[°C\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperature {
    /// At the start of the run \[°C\].
    pub start: f64,
    /// By how much it settles in the end \[K\].
    pub rise: f64,
    /// Over what time \[s\].
    pub settling: f64,
    /// Half the swing of what heats and cools the room \[K\].
    pub swing: f64,
    /// The period of that \[s\].
    pub period: f64,
}

impl Temperature {
    /// At this time of the run.
    pub(crate) fn at(&self, time: f64) -> f64 {
        // Before the run it is what it was at its start.
        let time = time.max(0.0);
        let settled = self.rise * (1.0 - (-time / self.settling).exp());
        self.start + settled + self.swing * (TAU * time / self.period).sin()
    }
}
