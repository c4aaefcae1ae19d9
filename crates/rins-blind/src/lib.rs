//! Runs of an inertial measurement unit on a rate table, with hidden effects, made apart from all that analyses them.
//!
//! **What it does.** [`record`] takes an [`Experiment`] - a place, a table with a servo and a bearing, an IMU, an
//! encoder, noise, and effects - through an oversampled motion: a servo's angle, the attitude as a quaternion, rates and
//! forces by differences of attitude and place, sensors' errors on each of the short steps, means over samples.
//! [`write()`] puts the log and its rig file into a folder, as a laboratory would hand them over; what is
//! hidden is not in it.
//!
//! **What it does not do.** It knows no closed form of any increment, no derivative of any effect, and no
//! other crate of this workspace: an error that analysis and simulation share would not be shared by it.
//!
//! Effects have the catalogue's ids, their numbers the catalogue's order; all is in SI units and radians.
mod drive;
mod effect;
mod experiment;
mod files;
mod imu;
mod laws;
mod motion;
mod noise;
mod place;
mod random;
mod run;
mod temperature;
mod unknown;

pub use drive::{Drive, Ripple, Segment};
pub use effect::{Effect, LAWS, Law, Read};
pub use experiment::{Encoder, Experiment, Known, Rounding, Sensors, SensorsKnown};
pub use files::write;
pub use laws::{Instant, Pose};
pub use noise::Noise;
pub use place::Place;
pub use random::{Random, random};
pub use run::{Log, record};
pub use temperature::Temperature;
pub use unknown::{Channel, Shape, Unknown};
