//! The inverse budget: which uncertainty of each parameter holds a wanted position error.

use nalgebra::DMatrix;
use rins_design::Growth;
use rins_terms::Model;

use super::case::OfStates;
use super::figure::WantedFigure;
use super::uncertainty::Uncertainty;

/// The uncertainties that hold a wanted figure.
#[derive(Clone, Debug)]
pub(super) struct Wanted {
    pub(super) want: WantedFigure,
    /// The position error by noise and the initial attitude, which no calibration reduces \[m\].
    pub(super) fixed: f64,
    /// That with the present uncertainties, as if they were independent \[m\].
    pub(super) present: f64,
    /// That with the uncertainties that are asked for \[m\].
    pub(super) reached: f64,
    /// The same by simulation, if there was one.
    pub(super) simulated: Option<f64>,
    /// The standard deviation of each parameter that is asked for \[SI units\].
    pub(super) sigmas: Vec<f64>,
    /// The parameters that matter, the most demanding first.
    pub(super) parameters: Vec<WantedParameter>,
}

/// What is asked of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WantedParameter {
    pub(super) id: String,
    pub(super) unit: &'static str,
    /// Its present standard deviation, and the one that is asked for, in its unit.
    pub(super) present: f64,
    pub(super) asked: f64,
    /// The position error that the latter causes, 1σ \[m\].
    pub(super) share: f64,
}

impl Wanted {
    /// Every parameter that already contributes less than an equal share keeps its uncertainty; the others share equally what these leave.
    pub(super) fn of(
        want: &WantedFigure,
        (model, of): (&Model, &Uncertainty),
        growth: &Growth,
        start: &OfStates,
    ) -> Self {
        let count = of.covariance.nrows();
        let none = DMatrix::zeros(count, count);
        let fixed = Growth::radial(&growth.covariance(&none, start));
        let present = of.sigmas();
        let mut unit = vec![0.0; count];
        let gains: Vec<f64> = (0..count)
            .map(|place| {
                unit[place] = 1.0;
                let [east, north] = growth.position(&unit);
                unit[place] = 0.0;
                east.hypot(north)
            })
            .collect();
        let shares: Vec<f64> =
            gains.iter().zip(&present).map(|(gain, sigma)| gain * sigma).collect();
        let room = want.rms * want.rms - fixed * fixed;
        let share = equal_share(&shares, room);
        let sigmas: Vec<f64> = (0..count)
            .map(|place| match share {
                Some(share) if shares[place] > share => share / gains[place],
                _ => present[place],
            })
            .collect();
        let rms = |sigmas: &[f64]| {
            let squares = sigmas.iter().zip(&gains).map(|(sigma, gain)| (sigma * gain).powi(2));
            fixed.hypot(squares.sum::<f64>().sqrt())
        };
        let places: Vec<(usize, usize)> = model.places().collect();
        let mut parameters: Vec<WantedParameter> = model
            .ids()
            .enumerate()
            .map(|(place, id)| {
                let (term, parameter) = places[place];
                let unit = model.terms[term].term.parameters[parameter].unit;
                WantedParameter {
                    id,
                    unit: unit.symbol,
                    present: present[place] / unit.factor,
                    asked: sigmas[place] / unit.factor,
                    share: sigmas[place] * gains[place],
                }
            })
            .collect();
        let reduction =
            |one: &WantedParameter| if one.present > 0.0 { one.asked / one.present } else { 1.0 };
        parameters.sort_by(|a, b| {
            reduction(a).total_cmp(&reduction(b)).then(b.share.total_cmp(&a.share))
        });
        Self {
            want: want.clone(),
            fixed,
            present: rms(&present),
            reached: rms(&sigmas),
            simulated: None,
            sigmas,
            parameters,
        }
    }

    /// Whether the figure can be reached by a calibration.
    pub(super) fn is_possible(&self) -> bool {
        self.fixed < self.want.rms
    }
}

/// The largest share that each of these may keep so that the sum of squares is no more than `room`; infinite if all fit, `None` if there is
/// no room.
fn equal_share(shares: &[f64], room: f64) -> Option<f64> {
    if room <= 0.0 {
        return None;
    }
    let mut sorted = shares.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut left = room;
    for (place, share) in sorted.iter().enumerate() {
        let equal = left / (sorted.len() - place) as f64;
        if share * share > equal {
            return Some(equal.sqrt());
        }
        left -= share * share;
    }
    Some(f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_shares_fill_the_room() {
        let shares = [0.1, 3.0, 2.0, 0.5, 1.0];
        let most = equal_share(&shares, 4.0).unwrap_or_default();
        let sum: f64 = shares.iter().map(|share| share.min(most).powi(2)).sum();
        assert!((sum - 4.0).abs() < 1e-12, "{most}");
        assert_eq!(equal_share(&shares, 100.0), Some(f64::INFINITY));
        assert_eq!(equal_share(&shares, 0.0), None);
    }
}
