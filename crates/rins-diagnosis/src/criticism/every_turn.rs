//! What comes back every turn, and is no sine.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rins_bayes::ln_tail;

use crate::criticism::structure::{self, Find, Remainder, Structure};

/// So many orders at least make a waveform.
const SEVERAL: usize = 2;

/// So many orders of the table angle are looked at together.
const TOGETHER: u32 = 12;

/// A mixture of these orders is shown if an epoch shows this part of it in the mean: of a single one it is a half.
const LEAST_SHOWN: f64 = 0.01;

impl Remainder<'_> {
    /// What comes back with every turn and is no sine, on one sensor or on all: no order of it need stand out alone. In body axes.
    pub(crate) fn every_turn(&self) -> Option<Find> {
        self.orders()?;
        let shown = self.highest_order();
        let orders: Vec<u32> =
            (2..=TOGETHER).take_while(|order| f64::from(*order) <= shown).collect();
        let highest = *orders.last()?;
        let size = 2 * orders.len();
        let mut information = DMatrix::zeros(size, size);
        let mut score = DMatrix::zeros(size, structure::CHANNELS);
        for (innovation, angle) in self.innovations.iter().zip(&self.motion.angles) {
            let waves = orders.iter().map(|order| f64::from(*order) * angle);
            let waves = waves.flat_map(|turned| <[f64; 2]>::from(turned.sin_cos()));
            let shape = DVector::from_iterator(size, waves);
            information.ger(1.0, &shape, &shape, 1.0);
            score.ger(1.0, &shape, innovation, 1.0);
        }
        // A table that stands in a few places for most of the time shows but some mixtures of all orders.
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(information);
        let least = LEAST_SHOWN * self.innovations.len() as f64;
        let (mut squares, mut dof) = ([0.0; structure::CHANNELS], 0);
        for (value, direction) in eigenvalues.iter().zip(eigenvectors.column_iter()) {
            if *value > least {
                dof += 1;
                for (square, along) in squares.iter_mut().zip(score.tr_mul(&direction).iter()) {
                    *square += along * along / value;
                }
            }
        }
        if dof < 2 * SEVERAL {
            return None;
        }
        let alone =
            squares.iter().map(|square| ln_tail(*square, dof) + (squares.len() as f64).ln());
        let (channel, alone) = alone.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let together = ln_tail(squares.iter().sum(), dof * squares.len());
        // Two ways of looking.
        let ln_p = alone.min(together) + 2.0_f64.ln();
        Some(Find { structure: Structure::EveryTurn(highest), channel, ln_p })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;

    use super::*;
    use crate::criticism::structure::TableMotion;

    /// Half a second an epoch, at these rates; on one channel a bump of this height wherever the table comes by.
    fn found(rates: &[f64], bump: f64, seed: u64) -> Find {
        let rates: Vec<f64> =
            rates.iter().flat_map(|rate| std::iter::repeat_n(*rate, 500)).collect();
        let turned = |angle: &mut f64, rate: &f64| {
            *angle += 0.5 * rate;
            Some(*angle)
        };
        let angles: Vec<f64> = rates.iter().scan(0.0, turned).collect();
        let mut random = Pcg64::seed_from_u64(seed);
        let mut noise = || StandardNormal.sample(&mut random);
        let innovation = |angle: &f64| {
            let mut one = SVector::<f64, { structure::CHANNELS }>::from_fn(|_, _| noise());
            one[4] += bump * (8.0 * (angle.cos() - 1.0)).exp();
            one
        };
        let innovations: Vec<_> = angles.iter().map(innovation).collect();
        let left = Remainder {
            innovations: &innovations,
            motion: &TableMotion { angles, rates, epoch: 0.5 },
        };
        left.every_turn().expect("a table that turns")
    }

    const RATES: [f64; 3] = [0.1, -0.3, 0.5];

    #[test]
    fn noise_comes_back_by_chance_as_rarely_as_it_says() {
        // A table that turns, and one that stands most of the time, in a few places.
        let mut rests = vec![0.0; 20];
        (rests[4], rests[9], rests[14]) = (0.03, 0.03, 0.03);
        for rates in [&RATES[..], &rests] {
            let share = (0..200).filter(|&seed| found(rates, 0.0, seed).ln_p < 0.1_f64.ln());
            let share = share.count();
            // Two ways of looking at much the same, each of which pays for both.
            assert!((5..30).contains(&share), "{share} of 200");
        }
    }

    #[test]
    fn a_bump_is_found_on_its_sensor() {
        let Find { structure, channel, ln_p } = found(&RATES, 1.2, 1);
        assert_eq!((structure, channel), (Structure::EveryTurn(12), 4));
        assert!(ln_p < -15.0, "{ln_p}");
    }
}
