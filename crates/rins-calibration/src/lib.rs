//! Self-calibration of a single-axis rotational inertial navigation system.
//!
//! **What it does.** [`calibrate`] runs the 12-state filter of the paper (‹nie2019›, eqs. (10)-(21), with its printed signs
//! corrected) in closed loop over a recording of an IMU that rotates on a fixed table. It estimates the gyro errors along the
//! spin axis, `M_xz`, `M_yz` and `S_z`, with their uncertainties, the combinations with gyro biases that are observable under
//! this schedule, the consistency of the innovations with the model, and the effect of the compensation on free inertial
//! navigation. The parts are public too: [`SpinAxisFilter`] processes one sample at a time, [`Consistency`] tests any
//! whitened innovations, and [`navigate_freely`] integrates any recording.
//!
//! **What it does not do.** All other sensor errors are neglected. If the data contain other effects than the three, the
//! consistency tests reject the model but do not identify the effects.
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
