//! The temperature of the IMU.

use std::f64::consts::TAU;

/// A temperature with an exponential transient and a periodic variation \[°C\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperature {
    /// The temperature at the start of the run \[°C\].
    pub start: f64,
    /// The total change of the transient \[K\].
    pub rise: f64,
    /// The time constant of the transient \[s\].
    pub settling: f64,
    /// The amplitude of the periodic variation of the room \[K\].
    pub swing: f64,
    /// The period of the variation \[s\].
    pub period: f64,
}

impl Temperature {
    /// The temperature at this time of the run.
    pub(crate) fn at(&self, time: f64) -> f64 {
        // Before the run it is constant.
        let time = time.max(0.0);
        let settled = self.rise * (1.0 - (-time / self.settling).exp());
        self.start + settled + self.swing * (TAU * time / self.period).sin()
    }
}
