//! The assignment of random numbers to the sensors of a run.

use rand_pcg::Pcg64;

use super::normal::Block;
use crate::axis::{Axis, Triad};

/// The seed from which all random numbers of a run follow.
///
/// Each [`Sensor`] has a generator of its own: PCG64 (XSL-RR 128/64) on the stream
/// `256 run + code`, so that no two sensors of one campaign share a stream. Its initial state is a
/// hash of seed, run and code. The numbers do not depend on the presence of other sensors, on the order
/// of the runs, or on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Seed {
    /// The seed of the campaign.
    pub seed: u64,
    /// The index of a run in the campaign.
    pub run: u64,
}

/// A sensor with random numbers of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Sensor {
    /// A gyro or an accelerometer: codes 0 to 2 and 3 to 5.
    Inertial(Triad, Axis),
    /// The angle encoder of the table: code 6.
    Encoder,
    /// The constant errors of a unit: code 7.
    Unit,
}

impl Sensor {
    /// The number that identifies this sensor's stream; it is stable across versions.
    pub const fn code(self) -> u8 {
        match self {
            Self::Inertial(Triad::Gyro, axis) => axis as u8,
            Self::Inertial(Triad::Accel, axis) => 3 + axis as u8,
            Self::Encoder => 6,
            Self::Unit => 7,
        }
    }
}

impl Seed {
    /// The seed of the first run of a campaign.
    pub const fn new(seed: u64) -> Self {
        Self { seed, run: 0 }
    }

    /// The standard normal numbers of a sensor, from the first on.
    ///
    /// ```
    /// use rins_imu::{Seed, Sensor};
    /// let seed = Seed { seed: 42, run: 3 };
    /// let (mut one, mut same) = (seed.stream(Sensor::Encoder), seed.stream(Sensor::Encoder));
    /// assert_eq!(one.sample(), same.sample());
    /// ```
    pub fn stream(self, sensor: Sensor) -> NormalStream {
        let code = sensor.code();
        let words = [self.seed, self.run, u64::from(code)];
        let hash = words.into_iter().fold(0, |hash: u64, word| scrambled(hash.wrapping_add(word)));
        let (high, low) = (scrambled(hash), scrambled(scrambled(hash)));
        let state = u128::from(high) << 64 | u128::from(low);
        let generator = Pcg64::new(state, u128::from(self.run) << 8 | u128::from(code));
        NormalStream { generator, block: Block::spent() }
    }
}

/// One step of `SplitMix64` (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
const fn scrambled(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// Independent standard normal numbers, the same on every machine.
#[derive(Clone, Debug)]
pub struct NormalStream {
    generator: Pcg64,
    block: Block,
}

impl NormalStream {
    /// The next number, from one step of the generator.
    #[inline]
    pub fn sample(&mut self) -> f64 {
        self.block.next(&mut self.generator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_pcg::rand_core::Rng;
    use rins_testing::assert_close;
    use std::collections::HashSet;

    fn all_sensors() -> impl Iterator<Item = Sensor> {
        let of = |triad| Axis::ALL.map(|axis| Sensor::Inertial(triad, axis));
        of(Triad::Gyro).into_iter().chain(of(Triad::Accel)).chain([Sensor::Encoder])
    }

    /// The first outputs for seed 42, run 7, by independent implementations of `PCG64` and `SplitMix64` in Python
    /// from their papers (`tests/data/pcg64_reference.py`).
    #[test]
    fn bits_are_those_of_a_generator_written_apart() {
        let seed = Seed { seed: 42, run: 7 };
        let first = |sensor| seed.stream(sensor).generator.next_u64();
        assert_eq!(first(Sensor::Inertial(Triad::Gyro, Axis::X)), 0x0d55_a118_42e2_ac16);
        assert_eq!(first(Sensor::Inertial(Triad::Accel, Axis::Z)), 0x75ce_9d9b_94e4_5eea);
        assert_eq!(first(Sensor::Encoder), 0xb7cd_97f7_6724_c42d);
    }

    #[test]
    fn sensors_runs_and_seeds_have_different_numbers() {
        let mut seen = HashSet::new();
        for (seed, run) in (0..20).flat_map(|seed| (0..20).map(move |run| (seed, run))) {
            for sensor in all_sensors() {
                assert!(seen.insert(Seed { seed, run }.stream(sensor).generator.next_u64()));
            }
        }
    }

    #[test]
    fn streams_are_uncorrelated() {
        const COUNT: usize = 20_000;
        let mut streams: Vec<_> = all_sensors()
            .map(|sensor| Seed::new(1).stream(sensor))
            .chain([
                Seed::new(2).stream(Sensor::Encoder),
                Seed { seed: 1, run: 1 }.stream(Sensor::Encoder),
            ])
            .collect();
        let numbers: Vec<Vec<f64>> = streams
            .iter_mut()
            .map(|stream| (0..COUNT).map(|_| stream.sample()).collect())
            .collect();
        for (place, one) in numbers.iter().enumerate() {
            for other in &numbers[place + 1..] {
                for lag in 0..3 {
                    let pairs = one.iter().zip(&other[lag..]);
                    let correlation = pairs.map(|(a, b)| a * b).sum::<f64>() / COUNT as f64;
                    // Five sigma; 108 correlations are tested.
                    assert_close!(correlation, 0.0, 5.0 / (COUNT as f64).sqrt());
                }
            }
        }
    }
}
