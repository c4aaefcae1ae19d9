//! Random numbers, with one stream for each random quantity.

use rand_pcg::Pcg64;

/// The generator of random numbers.
pub type Random = Pcg64;

/// The numbers of `stream` under `seed`: different streams are independent.
pub fn random(seed: u64, stream: u64) -> Random {
    Pcg64::new(u128::from(seed) << 64 | 0x9e37_79b9_7f4a_7c15, u128::from(stream))
}
