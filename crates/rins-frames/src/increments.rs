//! The output of an IMU: increments over an interval, or mean rates.

use crate::frame::{Body, InFrame};

/// The integrals of angular rate and specific force over an interval, resolved in the (rotating) body frame.
///
/// ```
/// use rins_frames::{InFrame, Rates};
/// let rates = Rates {
///     angular_rate: InFrame::new(0.0, 0.0, 0.25),
///     specific_force: InFrame::new(0.0, 0.0, 9.75),
/// };
/// let increments = rates.over(0.5);
/// assert_eq!(increments.angle, InFrame::new(0.0, 0.0, 0.125));
/// assert_eq!(increments.rates(), rates);
/// ```
///
/// A rate is not an increment:
/// ```compile_fail,E0308
/// use rins_frames::{InFrame, Increments, Rates};
/// fn integrate(_: Increments) {}
/// integrate(Rates { angular_rate: InFrame::zeros(), specific_force: InFrame::zeros() });
/// ```
/// and a vector resolved in another frame is not an output of an IMU:
/// ```compile_fail,E0308
/// use rins_frames::{InFrame, Increments, Nav};
/// let gravity = InFrame::<Nav>::new(0.0, 0.0, -9.8);
/// Increments { angle: InFrame::zeros(), velocity: gravity, interval: 0.01 };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increments {
    /// `∫ ω_ib^b dt` \[rad\].
    pub angle: InFrame<Body>,
    /// `∫ f^b dt` \[m/s\].
    pub velocity: InFrame<Body>,
    /// The interval's length \[s\].
    pub interval: f64,
}

/// The means of angular rate and specific force over an interval, resolved in the (rotating) body frame.
///
/// An increment is not a rate:
/// ```compile_fail,E0308
/// use rins_frames::{InFrame, Increments, Rates};
/// fn compensate(_: Rates) {}
/// compensate(Increments { angle: InFrame::zeros(), velocity: InFrame::zeros(), interval: 0.01 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// The mean of `ω_ib^b` \[rad/s\].
    pub angular_rate: InFrame<Body>,
    /// The mean of `f^b` \[m/s²\].
    pub specific_force: InFrame<Body>,
}

impl Increments {
    /// The mean rates over the interval of these increments, finite only if the interval is not zero.
    pub fn rates(&self) -> Rates {
        Rates {
            angular_rate: self.angle * (1.0 / self.interval),
            specific_force: self.velocity * (1.0 / self.interval),
        }
    }
}

impl Rates {
    /// The increments over `interval` \[s\] at these mean rates.
    pub fn over(&self, interval: f64) -> Increments {
        Increments {
            angle: self.angular_rate * interval,
            velocity: self.specific_force * interval,
            interval,
        }
    }
}
