//! A sensor that is noisier than the other of its kind: a data sheet has one figure for all three.

use nalgebra::SVector;
use rins_bayes::ln_tail;

use crate::criticism::structure::{CHANNELS, Find, Remainder, Structure, turned};
use crate::median::median;

/// The gyros and the accelerometers across the axis, in body axes.
const PAIRS: [[usize; 2]; 2] = [[0, 1], [3, 4]];

/// The median magnitude of normal figures over their sigma.
const OF_SIGMA: f64 = 0.674_489_75;

/// The variance of the logarithm of the median magnitude of normal figures, times how many they are: `1/(4 x² f²)`, where `x` is
/// the median and `f` the density of magnitudes there.
const SCATTER: f64 = 1.360_5;

impl Remainder<'_> {
    /// Whether the two sensors of a kind across the axis spread alike, most of the time: outliers and bursts are another matter.
    pub(crate) fn noisier(&self) -> Option<Find> {
        let in_body = self.in_body();
        let of_pair = |pair: [usize; 2]| {
            let [one, other] = pair.map(|channel| spread(&in_body, channel));
            let apart = (one / other).ln();
            let statistic = apart.powi(2) * in_body.len() as f64 / (2.0 * SCATTER);
            let ln_p = ln_tail(statistic, 1) + (PAIRS.len() as f64).ln();
            let channel = pair[usize::from(other > one)];
            let find = Find { structure: Structure::Noisier(apart.abs().exp()), channel, ln_p };
            apart.is_finite().then_some(find)
        };
        PAIRS.into_iter().filter_map(of_pair).min_by(|a, b| a.ln_p.total_cmp(&b.ln_p))
    }

    /// The innovations if each sensor across the axis had noise of its own: what one that is noisier reads is no line.
    pub(crate) fn evened(&self) -> Vec<SVector<f64, CHANNELS>> {
        let in_body = self.in_body();
        let mut even = SVector::<f64, CHANNELS>::repeat(1.0);
        for channel in PAIRS.concat() {
            let spread = spread(&in_body, channel);
            if spread > 0.0 {
                even[channel] = spread.recip();
            }
        }
        let each = in_body.iter().zip(&self.motion.angles);
        each.map(|(nu, angle)| turned(&nu.component_mul(&even), -angle)).collect()
    }
}

/// The sigma of most of the innovations of a channel.
fn spread(innovations: &[SVector<f64, CHANNELS>], channel: usize) -> f64 {
    let magnitudes: Vec<f64> = innovations.iter().map(|nu| nu[channel].abs()).collect();
    median(&magnitudes) / OF_SIGMA
}
