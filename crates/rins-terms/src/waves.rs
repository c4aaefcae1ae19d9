//! Sines and cosines that are asked for again and again.

use std::cell::Cell;

/// An angle, its sine and its cosine.
type Known = (f64, (f64, f64));

thread_local! {
    /// The last two: no effect asks for more over one sample.
    static LAST: [Cell<Known>; 2] = const { [const { Cell::new((0.0, (0.0, 1.0))) }; 2] };
}

/// Sine and cosine of an angle \[rad\], as [`f64::sin_cos`] has them.
///
/// Each parameter of an effect is taken by itself, and asks for those that the one before it asked for: the last two are
/// remembered.
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    LAST.with(|[last, before]| {
        for known in [last, before] {
            let (of, known) = known.get();
            if of.to_bits() == angle.to_bits() {
                return known;
            }
        }
        let found = angle.sin_cos();
        before.set(last.get());
        last.set((angle, found));
        found
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn whatever_was_asked_before_changes_nothing(
            asked in prop::collection::vec(prop::sample::select(vec![0.0, -0.0, 0.3, -7.1, 1e9, f64::NAN]), 1..40),
        ) {
            for angle in asked {
                let (sin, cos) = sin_cos(angle);
                let (true_sin, true_cos) = angle.sin_cos();
                prop_assert_eq!(sin.to_bits(), true_sin.to_bits());
                prop_assert_eq!(cos.to_bits(), true_cos.to_bits());
            }
        }
    }
}
