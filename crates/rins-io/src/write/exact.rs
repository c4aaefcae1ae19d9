//! Numbers that give the original value when they are multiplied or divided after reading.

/// The number of neighbors of a quotient that are tried.
const NEIGHBOURS: usize = 4;

/// A number near `guess` that `read` maps to `value`; `None` if none of its neighbors is.
pub(super) fn inverted(value: f64, guess: f64, read: impl Fn(f64) -> f64) -> Option<f64> {
    let is_value = |number: &f64| read(*number).to_bits() == value.to_bits();
    let (mut up, mut down) = (guess, guess);
    std::iter::once(guess)
        .chain((0..NEIGHBOURS).flat_map(|_| {
            (up, down) = (up.next_up(), down.next_down());
            [up, down]
        }))
        .find(is_value)
}

/// A number that gives `value` when multiplied by `factor`, or the nearest to it.
pub(super) fn quotient(value: f64, factor: f64) -> f64 {
    let guess = value / factor;
    inverted(value, guess, |number| number * factor).unwrap_or(guess)
}

#[cfg(test)]
mod tests {
    use super::{inverted, quotient};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_was_a_product_is_one_again(number in -1e3..1e3_f64, factor in 1e-6..1e3_f64) {
            let value = number * factor;
            prop_assert_eq!((quotient(value, factor) * factor).to_bits(), value.to_bits());
        }
    }

    #[test]
    fn what_is_no_product_is_told() {
        // The spacing of doubles just above one, multiplied by three, exceeds the spacing just above three.
        let mut value = 3.0_f64;
        let found = (0..6).filter(|_| {
            value = value.next_up();
            inverted(value, value / 3.0, |number| number * 3.0).is_some()
        });
        assert_eq!(found.count(), 4);
    }
}
