//! For the workspace's own tests: strategies over physical quantities, `assert_close!`, the bounds that
//! a statistic must keep, tables of cases, covariances in long numbers, and sections of files.
#![expect(clippy::missing_panics_doc, reason = "tests are meant to panic")]

mod draft;
mod long;
mod rows;
mod sections;
mod statistics;
mod strategies;

pub use draft::filled;
pub use long::LongCovariance;
pub use rows::{Fault, assert_rows, is, says};
pub use statistics::{
    assert_chi_squared, assert_standard_normal, chi_squared_mean_bounds, is_chi_squared,
    standard_normal_defect,
};
pub use strategies::{
    any_direction, any_euler_angles, any_latitude, any_matrix, any_rotation_vector,
    small_rotation_vector,
};

/// Asserts that two numbers differ by at most a tolerance, and prints all three if not.
///
/// A tolerance of zero fails: it would hide a comparison that was never made.
///
/// ```
/// rins_testing::assert_close!(0.1 + 0.2, 0.3, 1e-15);
/// ```
/// ```should_panic
/// rins_testing::assert_close!(1.0, 1.0, 0.0);
/// ```
#[macro_export]
macro_rules! assert_close {
    ($got:expr, $want:expr, $within:expr $(,)?) => {{
        let (got, want, within): (f64, f64, f64) = ($got, $want, $within);
        assert!(within > 0.0, "the tolerance must be positive");
        assert!(
            (got - want).abs() <= within,
            "got {got:e}, want {want:e} within {within:e}: off by {:e}",
            (got - want).abs(),
        );
    }};
}

/// Compiles the README's examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
