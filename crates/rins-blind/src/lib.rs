//! Simulation of an IMU on a rate table with hidden effects, independent of all code that analyzes the runs.
//!
//! **What it does.** [`record`] simulates an [`Experiment`] - a site, a table with a servo and a bearing, an IMU, an
//! encoder, noise, and effects - by an oversampled motion: the servo's angle, the attitude as a quaternion, rates and
//! forces by differences of attitude and position, the sensors' errors on each short step, means over samples.
//! [`write()`] writes the log and its rig file to a folder, as a laboratory would deliver them, without the hidden
//! effects.
//!
//! **What it does not do.** It uses no closed form of an increment, no derivative of an effect, and no
//! other crate of this workspace: an error common to analysis and simulation would not be repeated here.
//!
//! Effects have the ids of the catalogue, and their parameters the order of the catalogue; all is in SI units and radians.
mod campaign;
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

pub use campaign::{Campaign, CampaignRun, Variety};
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
