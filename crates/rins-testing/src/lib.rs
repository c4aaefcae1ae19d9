//! For the workspace's own tests: strategies over physical quantities, and `assert_close!`.
#![expect(clippy::missing_panics_doc, reason = "tests are meant to panic")]

use proptest::prelude::*;

/// Asserts that two numbers differ by at most a tolerance, and prints all three if not.
///
/// A tolerance of zero fails: it would hide a comparison that was never made.
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

/// Any rotation vector of up to half a turn \[rad\].
pub fn any_rotation_vector() -> impl Strategy<Value = [f64; 3]> {
    ([-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64], 0.0..3.1_f64).prop_filter_map(
        "a direction needs a length",
        |(direction, angle)| {
            let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            (length > 1e-3).then(|| direction.map(|x| x / length * angle))
        },
    )
}

/// Any latitude that is not within a degree of a pole \[rad\].
pub fn any_latitude() -> impl Strategy<Value = f64> {
    -1.55..1.55_f64
}

/// Any roll, pitch and yaw short of gimbal lock \[rad\].
pub fn any_euler_angles() -> impl Strategy<Value = [f64; 3]> {
    [-3.1..3.1_f64, -1.5..1.5_f64, -3.1..3.1_f64]
}
