//! Self-calibration of a single-axis rotational inertial navigation system.
//!
//! **What it does.** [`calibrate`] runs the 12-state filter of the paper (‹nie2019›, eqs.
//! (10)-(21), with its printed signs corrected) over a recording of an IMU that turns on a fixed
//! table, closed loop: it estimates the gyro errors tied to the spin axis, `M_xz`, `M_yz` and `S_z`,
//! and tells how well, in which combination with the gyro biases this schedule shows them, whether
//! the innovations agree with the model, and what compensating the estimates does to free inertial
//! navigation. The parts are public too: [`SpinAxisFilter`] takes one sample at a time,
//! [`Consistency`] judges any whitened innovations, [`navigate_freely`] any recording.
//!
//! **What it does not do.** Any other sensor error is left where it is. Where the data hold more than
//! the three, the consistency figures say that the model does not fit, not what is missing.
//!
//! Numbers are in SI units and radians; errors are computed minus true ([`layout`]).

#![expect(
    clippy::inline_always,
    reason = "what is not inlined is compiled without the vector instructions"
)]

mod calibration;
mod consistency;
mod dense;
mod estimate;
mod factorised;
mod filter;
mod history;
mod kernel;
mod lanes;
pub mod layout;
mod navigation;
mod online;
mod parameter;
mod separability;
mod setup;
pub mod structured;
mod table_angle;

pub use calibration::{
    AttitudeSource, Calibration, CalibrationError, EstimatePoint, calibrate, likely_wobble,
};
pub use consistency::{Consistency, Verdict};
pub use estimate::{Estimate, beginning, estimate};
pub use filter::{AngleSource, Form, MEASUREMENTS, Reference, SpinAxisFilter, Start, TableReading};
pub use lanes::SpinAxisLanes;
pub use navigation::{FreeNavigation, NavigationPoint, navigate_freely};
pub use online::{RunningEstimate, navigate_online, running_estimate};
pub use parameter::{Parameter, ParameterKind, Partner};
pub use setup::{AxisAttitude, Setup, TableSpec};
pub use table_angle::table_angles;
