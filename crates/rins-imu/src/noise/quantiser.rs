//! Quantization: rounding to a least significant bit.

use nalgebra::Vector3;

use super::model::Quantisation;

/// A quantizer of the increments of a triad.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantiser {
    resolution: Quantisation,
    /// The part of the sensed increments that is not yet in the output \[rad or m/s\].
    carry: Vector3<f64>,
}

impl Quantiser {
    pub(super) fn new(resolution: Quantisation) -> Self {
        Self { resolution, carry: Vector3::zeros() }
    }

    /// The output for a sensed `increment` over `interval` \[s\].
    pub(super) fn quantise(&mut self, increment: &Vector3<f64>, interval: f64) -> Vector3<f64> {
        match self.resolution {
            Quantisation::Rate(bit) => increment.map(|x| rounded(x / interval, bit) * interval),
            Quantisation::Increment(bit) => {
                let sensed = self.carry + increment;
                let delivered = sensed.map(|x| rounded(x, bit));
                self.carry = sensed - delivered;
                delivered
            }
        }
    }
}

/// The multiple of `bit` nearest to `value`; `value` itself if the bit is too small for the multiple to be represented.
pub fn rounded(value: f64, bit: f64) -> f64 {
    let bits = (value / bit).round();
    if bits.is_finite() { bits * bit } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn bit_too_small_to_count_by_rounds_nothing() {
        let mut quantiser = Quantiser::new(Quantisation::Increment(5e-310));
        let increment = Vector3::new(0.25, -3.0, 0.0);
        assert_eq!(quantiser.quantise(&increment, 0.1), increment);
        assert_eq!(quantiser.quantise(&increment, 0.1), increment);
        assert!((rounded(0.24, 0.1) - 0.2).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn pulses_never_lose_more_than_half_a_bit(
            increments in prop::collection::vec(-5.0..5.0_f64, 1..200), bit in 0.01..1.0_f64,
        ) {
            let mut quantiser = Quantiser::new(Quantisation::Increment(bit));
            let (mut sensed, mut delivered) = (0.0, 0.0);
            for x in increments {
                sensed += x;
                let out = quantiser.quantise(&Vector3::new(x, -x, 0.0), 0.1);
                delivered += out.x;
                let pulses = out.x / bit;
                prop_assert!((pulses - pulses.round()).abs() < 1e-9);
                prop_assert!((delivered - sensed).abs() <= bit / 2.0 * (1.0 + 1e-9));
                prop_assert!(out.z.abs() < f64::MIN_POSITIVE);
            }
        }

        #[test]
        fn rates_are_rounded_one_by_one(rate in -5.0..5.0_f64, bit in 0.01..1.0_f64) {
            let mut quantiser = Quantiser::new(Quantisation::Rate(bit));
            let first = quantiser.quantise(&Vector3::repeat(rate * 0.1), 0.1);
            prop_assert!((first.x / 0.1 - rate).abs() <= bit / 2.0 * (1.0 + 1e-9));
            prop_assert_eq!(quantiser.quantise(&Vector3::repeat(rate * 0.1), 0.1), first);
        }
    }
}
