//! Standard normal random numbers that are the same on every machine.
//!
//! The quantile function is evaluated by additions, multiplications, divisions, a square root and
//! `libm`'s logarithm, whose rounding does not depend on the platform, unlike that of a system
//! library. One uniform number gives one normal number.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use rins_lanes::{Arch, Lane, Real, Simd, WithSimd};

/// The number of random numbers that are computed together: a multiple of the vector width of any machine.
const BLOCK: usize = 64;

/// Standard normal numbers, each from 52 random bits: their magnitude is at most 8.2.
#[derive(Clone, Debug)]
pub(super) struct Block {
    numbers: [f64; BLOCK],
    taken: usize,
}

impl Block {
    /// A block without remaining numbers.
    pub(super) const fn spent() -> Self {
        Self { numbers: [0.0; BLOCK], taken: BLOCK }
    }

    /// The next number, from one step of the generator.
    #[inline]
    pub(super) fn next(&mut self, generator: &mut Pcg64) -> f64 {
        if self.taken == BLOCK {
            self.fill(generator);
        }
        let number = self.numbers[self.taken];
        self.taken += 1;
        number
    }

    fn fill(&mut self, generator: &mut Pcg64) {
        let offsets: [f64; BLOCK] = core::array::from_fn(|_| {
            let bits = generator.next_u64() >> 12;
            // The center of one of 2⁵² equal parts of (-½, ½), without rounding.
            (bits as f64 + 0.5) * f64::EPSILON - 0.5
        });
        self.numbers = offsets;
        // Five of six are central; their quantiles are computed in SIMD lanes.
        Arch::new().dispatch(Centre(&mut self.numbers));
        for (number, &offset) in self.numbers.iter_mut().zip(&offsets) {
            if offset.abs() > CENTRAL {
                *number = tail_quantile(offset);
            }
        }
        self.taken = 0;
    }
}

/// Offsets that are replaced by their quantiles, if they are central.
struct Centre<'a>(&'a mut [f64]);

impl WithSimd for Centre<'_> {
    type Output = ();

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn with_simd<S: Simd>(self, simd: S) {
        Lane::map_slice(simd, self.0, central_quantile);
    }
}

/// The maximum offset from ½ of a central fraction.
const CENTRAL: f64 = 0.425;

/// The quantile of the normal distribution for a probability of ½ + `offset`, for |`offset`| up to 0.425
/// (Wichura, "Algorithm AS 241: the percentage points of the normal distribution", Applied Statistics
/// 37 (1988) 477-484, routine PPND16, with a relative error of about 10⁻¹⁶).
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
fn central_quantile<T: Real>(offset: T) -> T {
    offset * ratio(&CENTRE, -(offset * offset) + CENTRAL_SQUARE)
}

const CENTRAL_SQUARE: f64 = 0.180625;

/// The same for |`offset`| from 0.425 to ½.
fn tail_quantile(offset: f64) -> f64 {
    let tail = libm::log(0.5 - offset.abs());
    let root = libm::sqrt(-tail);
    let magnitude =
        if root <= 5.0 { ratio(&SHOULDER, root - 1.6) } else { ratio(&TAIL, root - 5.0) };
    magnitude.copysign(offset)
}

/// A ratio of two polynomials, with coefficients from the highest power to the constant.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
fn ratio<T: Real>((numerator, denominator): &([f64; 8], [f64; 8]), x: T) -> T {
    let (mut above, mut below) = (x.constant(numerator[0]), x.constant(denominator[0]));
    for power in 1..8 {
        above = above * x + numerator[power];
        below = below * x + denominator[power];
    }
    above / below
}

#[expect(clippy::excessive_precision, reason = "the digits of the source")]
const CENTRE: ([f64; 8], [f64; 8]) = (
    [
        2509.0809287301226727,
        33430.575583588128105,
        67265.770927008700853,
        45921.953931549871457,
        13731.693765509461125,
        1971.5909503065514427,
        133.14166789178437745,
        3.387132872796366608,
    ],
    [
        5226.495278852545925,
        28729.085735721942674,
        39307.89580009271061,
        21213.794301586595867,
        5394.1960214247511077,
        687.1870074920579083,
        42.313330701600911252,
        1.0,
    ],
);

#[expect(clippy::excessive_precision, reason = "the digits of the source")]
const SHOULDER: ([f64; 8], [f64; 8]) = (
    [
        7.7454501427834140764e-4,
        0.0227238449892691845833,
        0.24178072517745061177,
        1.27045825245236838258,
        3.64784832476320460504,
        5.7694972214606914055,
        4.6303378461565452959,
        1.42343711074968357734,
    ],
    [
        1.05075007164441684324e-9,
        5.475938084995344946e-4,
        0.0151986665636164571966,
        0.14810397642748007459,
        0.68976733498510000455,
        1.6763848301838038494,
        2.05319162663775882187,
        1.0,
    ],
);

#[expect(clippy::excessive_precision, reason = "the digits of the source")]
const TAIL: ([f64; 8], [f64; 8]) = (
    [
        2.01033439929228813265e-7,
        2.71155556874348757815e-5,
        0.0012426609473880784386,
        0.026532189526576123093,
        0.29656057182850489123,
        1.7848265399172913358,
        5.4637849111641143699,
        6.6579046435011037772,
    ],
    [
        2.04426310338993978564e-15,
        1.4215117583164458887e-7,
        1.8463183175100546818e-5,
        7.868691311456132591e-4,
        0.0148753612908506148525,
        0.13692988092273580531,
        0.59983220655588793769,
        1.0,
    ],
);

#[cfg(test)]
mod tests {
    use super::*;
    use rand_pcg::rand_core::SeedableRng;
    use rins_testing::assert_close;

    /// Offsets that are exact in binary, and their quantiles to 20 digits by
    /// mpmath 1.3 at 50 digits: `findroot(lambda x: ncdf(x) - (mpf(1)/2 + offset), x0)`.
    #[expect(clippy::excessive_precision, reason = "the digits of the source")]
    const REFERENCE: [(f64, f64); 8] = [
        (0.0009765625, 0.0024478816191106774544),
        (0.25, 0.6744897501960817432),
        (0.4, 1.2815515655446005935),
        (0.4375, 1.5341205443525463117),
        (0.49, 2.3263478740408407676),
        (0.4990234375, 3.0972690781987844624),
        (0.4999999990686774, 6.0093535655307438932),
        (0.4999999999999991, 7.9560381254815309622),
    ];

    fn quantile(offset: f64) -> f64 {
        if offset.abs() <= CENTRAL { central_quantile(offset) } else { tail_quantile(offset) }
    }

    #[test]
    fn a_number_has_the_same_bits_alone_and_in_its_block() {
        let (mut block, mut generator) = (Block::spent(), Pcg64::seed_from_u64(3));
        let mut alone = generator.clone();
        for _ in 0..5 * BLOCK {
            let bits = alone.next_u64() >> 12;
            let want = quantile((bits as f64 + 0.5) * f64::EPSILON - 0.5);
            assert_eq!(block.next(&mut generator).to_bits(), want.to_bits());
        }
    }

    #[test]
    fn quantiles_agree_with_those_of_arbitrary_precision() {
        for (offset, want) in REFERENCE {
            assert_close!(quantile(offset), want, 4e-16 * want.abs());
            assert_close!(quantile(-offset), -want, 4e-16 * want.abs());
        }
    }

    #[test]
    fn quantile_rises_across_the_joints() {
        for joint in [0.425, 0.5 - (-25.0_f64).exp()] {
            assert!(quantile(joint - 1e-13) < quantile(joint));
            assert!(quantile(joint) < quantile(joint + 1e-13));
        }
    }

    #[test]
    fn moments_are_those_of_a_standard_normal() {
        const COUNT: usize = 1_000_000;
        let (mut block, mut generator) = (Block::spent(), Pcg64::seed_from_u64(7));
        let mut moments = [0.0; 4];
        for _ in 0..COUNT {
            let x = block.next(&mut generator);
            for (power, moment) in (1..).zip(&mut moments) {
                *moment += x.powi(power) / COUNT as f64;
            }
        }
        // Five sigma of each moment: the variance of xᵏ is (E x²ᵏ - (E xᵏ)²) divided by the count.
        for (got, (want, variance)) in
            moments.iter().zip([(0.0, 1.0), (1.0, 2.0), (0.0, 15.0), (3.0, 96.0)])
        {
            let sigma: f64 = f64::sqrt(variance / COUNT as f64);
            assert_close!(*got, want, 5.0 * sigma);
        }
    }
}
