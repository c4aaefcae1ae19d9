//! Harmonics of the encoder that are higher than those that are always tried: marks of a disc, teeth of a gear.

use rins_estimation::{Fit, Reference};
use rins_terms::{SettingKind, TermInstance, catalogue};
use rustfft::num_complex::Complex;

use crate::case::Case;
use crate::criticism::residuals::{ABOUT_AXIS, residuals};
use crate::median::median_about;
use crate::proposal::candidates::{Candidate, has_room};

/// The highest that is looked for.
const HIGHEST: u32 = 96;

/// The lowest that is not always tried.
const LOWEST: u32 = 13;

/// The most that are tried at once.
const MOST: usize = 2;

/// As many neighbouring orders on each side tell the noise about one.
const AROUND: usize = 8;

/// One that stands out from these by less than so many times their median is not tried.
const LEAST: f64 = 20.0;

/// From one sample to the next an order may turn so far \[rad\]: beyond half a turn it is taken for another.
const MOST_TURNED: f64 = 2.5;

impl Case<'_> {
    /// The harmonics that stand out of what the gyro about the axis reads beyond the encoder, sample by sample: epochs are too
    /// long to show them where the table turns fast.
    pub(crate) fn high_harmonics(&self, fit: &Fit, run: usize) -> Vec<Candidate> {
        const COUNT: usize = (HIGHEST - LOWEST + 1) as usize;
        if !matches!(self.runs[run].rig.reference, Reference::Encoder { .. }) {
            return Vec::new();
        }
        let of_gyro = residuals(&self.runs[run], fit, run);
        let samples = &self.runs[run].recording.increments;
        let ends: Vec<Complex<f64>> =
            fit.linear[run].track().angles().iter().map(|angle| Complex::cis(*angle)).collect();
        let mut products = [Complex::new(0.0, 0.0); COUNT];
        let mut squares = [0.0; COUNT];
        for (ends, (residual, sample)) in
            ends.windows(2).zip(of_gyro[ABOUT_AXIS].iter().zip(samples))
        {
            let turned = (ends[1] * ends[0].conj()).arg().abs();
            let [mut begin, mut end] = [ends[0].powu(LOWEST), ends[1].powu(LOWEST)];
            for (order, (product, square)) in (LOWEST..).zip(products.iter_mut().zip(&mut squares))
            {
                if turned * f64::from(order) > MOST_TURNED {
                    break;
                }
                // What the encoder errs more at the sample's end than at its begin.
                *product += (end - begin) * *residual * sample.interval;
                *square += (end - begin).norm_sqr();
                begin *= ends[0];
                end *= ends[1];
            }
        }
        let power = |(product, square): (&Complex<f64>, &f64)| product.norm_sqr() / square;
        let powers: Vec<f64> = products.iter().zip(&squares).map(power).collect();
        let mut standing: Vec<(f64, f64)> = (LOWEST..)
            .zip(powers.iter().enumerate())
            .map(|(order, (place, power))| {
                (power / median_about(&powers, place, AROUND), f64::from(order))
            })
            .filter(|(ratio, _)| ratio.is_finite() && *ratio > LEAST)
            .collect();
        standing.sort_by(|a, b| b.0.total_cmp(&a.0));
        let duration = self.duration();
        let of = |(_, order): &(f64, f64)| Candidate::high_harmonic(*order);
        let has_room = |one: &Candidate| has_room(fit.model(), &one.chosen, duration);
        standing.iter().map(of).filter(has_room).take(MOST).collect()
    }
}

impl Candidate {
    /// A harmonic of the encoder beyond those that are always tried: looked for the more, the lower it is.
    pub(crate) fn high_harmonic(order: f64) -> Self {
        let chosen = TermInstance::new(&catalogue::ENCODER_HARMONIC).estimated();
        let all: f64 = (1..=HIGHEST).map(|order| 1.0 / f64::from(order)).sum();
        Self {
            chosen: chosen.with_setting(SettingKind::Order, order),
            looks: all * order,
            step: None,
            departs: None,
        }
    }
}
