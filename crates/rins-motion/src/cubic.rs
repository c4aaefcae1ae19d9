//! The way between two instants of which rates are known.

/// The coefficients of the first three powers of the part of a stretch that has passed, in how far something has turned by
/// then: `turned` by its end, and `from` and `to` over a whole stretch at the rates of its start and of its end.
///
/// ```
/// // From rest to a rate, evenly: as the square.
/// assert_eq!(rins_motion::cubic(0.5, 0.0, 1.0), [0.0, 0.5, 0.0]);
/// ```
pub const fn cubic(turned: f64, from: f64, to: f64) -> [f64; 3] {
    [from, 3.0 * turned - 2.0 * from - to, from + to - 2.0 * turned]
}
