//! The same rotations one by one and in SIMD lanes, with identical bits.
#![expect(clippy::print_stdout, reason = "an example prints")]

use rins_lanes::{Arch, Lane, Real, Simd, Vector, WithSimd, rotation};

/// The number of rotations of each vector.
const TURNS: usize = 1000;

fn turned<T: Real>(turn: &Vector<T>) -> T {
    let mut vector = Vector::constant(turn[0], [1.0, 0.0, 0.0]);
    for _ in 0..TURNS {
        vector = rotation::exp(turn) * vector;
    }
    vector[0]
}

struct SideBySide;

impl WithSimd for SideBySide {
    type Output = Vec<f64>;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
        let angle = Lane::splat(simd, 0.0).each(|lane| 0.001 * lane as f64);
        let zero = angle.constant(0.0);
        let vector = turned(&Vector([zero, zero, angle]));
        (0..vector.lanes()).map(|lane| vector.lane(lane)).collect()
    }
}

fn main() {
    let lanes = Arch::new().dispatch(SideBySide);
    println!("{} lanes", lanes.len());
    for (lane, side_by_side) in lanes.into_iter().enumerate() {
        let alone = turned(&Vector([0.0, 0.0, 0.001 * lane as f64]));
        println!("run {lane}: {alone}, {side_by_side}");
        assert_eq!(alone.to_bits(), side_by_side.to_bits());
    }
}
