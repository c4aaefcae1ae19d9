//! Simulation of an IMU on a single-axis rate table, from a scenario with a seed.
//!
//! **What it does.** [`simulate`] converts a [`Scenario`] - site, motion of the table, errors of the IMU, encoder, further
//! effects - to a recording like that of a log, with the [`Truth`]. The steps are true
//! motion, eq. (1) and effects, noise, resolution.
//! The same scenario gives the same run on every machine.
//!
//! **What it does not do.** It reads and writes no files. Effects are those of the catalogue of
//! [`rins_terms`], on a table with a fixed position.
//!
//! ```
//! use rins_frames::units::{DEG, DEG_PER_SECOND, PPM};
//! use rins_frames::{Dcm, Site};
//! use rins_imu::{Axis, ImuError, TriadError};
//! use rins_motion::{Profile, Segment, Station};
//! use rins_simulation::{Scenario, simulate};
//!
//! let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
//! let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 36.0 };
//! let gyro = TriadError::default().with_scale(Axis::Z, 300.0 * PPM);
//! let scenario = Scenario {
//!     imu_error: ImuError { gyro, ..ImuError::default() },
//!     ..Scenario::perfect(
//!         Station::with_normal_gravity(site),
//!         Dcm::identity(),
//!         Profile::new(&[turn], None)?,
//!         0.02,
//!     )
//! };
//!
//! let run = simulate(&scenario)?;
//! assert_eq!(run.recording.len(), 1800);
//! // One turn, the Earth's rotation, and 300 ppm of both.
//! let seen: f64 = run.recording.increments.iter().map(|k| k.angle.components().z).sum();
//! let earth = site.earth_rate().components().z * 36.0;
//! assert!((seen - 1.0003 * (360.0 * DEG + earth)).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
mod scenario;

mod check;
mod readings;
mod run;
mod temperature;

pub use check::ScenarioError;
pub use run::{Simulated, Truth, simulate};
pub use scenario::{Encoder, Scenario, TableRecord};
pub use temperature::Temperature;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
