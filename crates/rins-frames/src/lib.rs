//! Frames of reference, the rotations between them, and the WGS84 Earth.
//!
//! **What it does.** A vector has the frame in which it is resolved as its type, a rotation its two frames,
//! so that a wrong order or a forgotten transpose does not compile. The crate also contains the
//! WGS84 Earth (radii, normal gravity, Earth and transport rate) and constants of units.
//!
//! A rotation is a [`Dcm`], or a [`Quaternion`] if four numbers are preferable to nine. Trigonometric functions
//! and roots are those of the `libm` crate whatever the features, so that every machine gets the same bits.
//!
//! **What it does not do.** There are no points, positions and poses, and no types for units:
//! every number is in SI units and radians.
//!
//! ```
//! use rins_frames::{Body, Dcm, InFrame, Nav, Table};
//! let nav_from_table = Dcm::<Nav, Table>::about_x(0.3);
//! let table_from_body = Dcm::<Table, Body>::about_z(1.0);
//! let up_in_nav: InFrame<Nav> = nav_from_table * table_from_body * InFrame::<Body>::new(0.0, 0.0, 1.0);
//! assert!((up_in_nav.components().z - 0.3_f64.cos()).abs() < 1e-15);
//! ```
//!
//! Frames cannot be mixed:
//! ```compile_fail,E0277
//! use rins_frames::{Body, Dcm, InFrame, Nav, Table};
//! let nav_from_table = Dcm::<Nav, Table>::identity();
//! let wrong: InFrame<Nav> = nav_from_table * InFrame::<Body>::new(0.0, 0.0, 1.0);
//! ```
#![no_std]

mod dcm;
mod earth;
mod euler;
mod frame;
mod increments;
mod quaternion;
mod rotation_vector;
mod signed_axes;
pub mod units;

pub use dcm::{Dcm, NotARotation};
pub use earth::{EARTH_RATE, Site};
pub use euler::EulerAngles;
pub use frame::{Body, Frame, InFrame, Nav, Table};
pub use increments::{Increments, Rates};
pub use quaternion::{NotAUnitQuaternion, Quaternion};
pub use rotation_vector::cross_matrix;
pub use signed_axes::SignedAxes;

/// Compiles the README's examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
