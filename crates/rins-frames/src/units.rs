//! Units as factors: `0.05 * DEG_PER_HOUR` is in SI units.
//!
//! ```
//! use rins_frames::{EARTH_RATE, units::DEG_PER_HOUR};
//! assert!((EARTH_RATE / DEG_PER_HOUR - 15.041).abs() < 1e-3);
//! ```

use core::f64::consts::PI;

/// One degree \[rad\].
pub const DEG: f64 = PI / 180.0;
/// One minute of arc \[rad\].
pub const ARCMIN: f64 = DEG / 60.0;
/// One second of arc \[rad\].
pub const ARCSEC: f64 = DEG / 3600.0;
/// One degree per second \[rad/s\].
pub const DEG_PER_SECOND: f64 = DEG;
/// One degree per hour \[rad/s\].
pub const DEG_PER_HOUR: f64 = DEG / 3600.0;
/// One degree per root hour, as an angle random walk \[rad/√s\].
pub const DEG_PER_ROOT_HOUR: f64 = DEG / 60.0;
/// One degree per hour per root hertz, as a rate noise density \[rad/s/√Hz\].
pub const DEG_PER_HOUR_PER_ROOT_HZ: f64 = DEG_PER_HOUR;
/// One part in a million.
pub const PPM: f64 = 1e-6;
/// Standard gravity, the unit "g" of a data sheet \[m/s²\] (CGPM 1901).
pub const STANDARD_GRAVITY: f64 = 9.80665;
/// One thousandth of [`STANDARD_GRAVITY`] \[m/s²\].
pub const MILLI_G: f64 = 1e-3 * STANDARD_GRAVITY;
/// One millionth of [`STANDARD_GRAVITY`] \[m/s²\].
pub const MICRO_G: f64 = 1e-6 * STANDARD_GRAVITY;
/// One micro-g per root hertz, as an acceleration noise density \[m/s²/√Hz\].
pub const MICRO_G_PER_ROOT_HZ: f64 = MICRO_G;
