//! What a rate-integrating IMU delivers: increments over an interval, or mean rates.

use crate::frame::{Body, InFrame};

/// The integrals of angular rate and specific force over an interval, resolved in the (turning) body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increments {
    /// `∫ ω_ib^b dt` \[rad\].
    pub angle: InFrame<Body>,
    /// `∫ f^b dt` \[m/s\].
    pub velocity: InFrame<Body>,
    /// The interval's length \[s\].
    pub interval: f64,
}

/// The means of angular rate and specific force over an interval, resolved in the (turning) body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// The mean of `ω_ib^b` \[rad/s\].
    pub angular_rate: InFrame<Body>,
    /// The mean of `f^b` \[m/s²\].
    pub specific_force: InFrame<Body>,
}

impl Increments {
    /// These increments as means over their interval.
    pub fn rates(&self) -> Rates {
        Rates {
            angular_rate: self.angle * (1.0 / self.interval),
            specific_force: self.velocity * (1.0 / self.interval),
        }
    }
}

impl Rates {
    /// These means as increments over `interval` \[s\].
    pub fn over(&self, interval: f64) -> Increments {
        Increments {
            angle: self.angular_rate * interval,
            velocity: self.specific_force * interval,
            interval,
        }
    }
}
