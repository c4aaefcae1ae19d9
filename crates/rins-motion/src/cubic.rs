//! Cubic interpolation of an angle between two times with known rates.

/// The coefficients of the first three powers of the elapsed fraction of an interval in the angle of rotation. The angle over
/// the whole interval is `turned`; `from` and `to` are the angles at constant rates equal to those at its start and at its
/// end.
///
/// ```
/// // From rest at constant acceleration: quadratic.
/// assert_eq!(rins_motion::cubic(0.5, 0.0, 1.0), [0.0, 0.5, 0.0]);
/// ```
pub const fn cubic(turned: f64, from: f64, to: f64) -> [f64; 3] {
    [from, 3.0 * turned - 2.0 * from - to, from + to - 2.0 * turned]
}
