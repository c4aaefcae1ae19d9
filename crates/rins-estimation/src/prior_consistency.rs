//! Estimates held against what was known of them before.

use crate::estimate::Fit;
use crate::identifiability::{Identifiability, Observable};
use crate::likely::WHITE;
use crate::noise_parameters::NoiseParameters;

/// What was found of a parameter or of the noise, and what was known of it before, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Departure {
    /// What it is of.
    pub of: Quantity,
    /// The estimate; of a combination that of the combination.
    pub value: f64,
    /// What was expected.
    pub expected: f64,
    /// The stated 1σ of what was expected; of noise that of its logarithm, as a part of what was expected.
    pub sigma: f64,
    /// How far the estimate is off, in standard deviations of the prior and of the data together; of noise, of its logarithm.
    pub sigmas: f64,
}

/// What is held against what was known of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The parameter at this place, or the combination that it leads.
    Parameter(usize),
    /// The white noise of the gyros.
    GyroNoise,
    /// The white noise of the accelerometers.
    AccelNoise,
}

impl Fit {
    /// What the data show, parameters and combinations, and the white noise that was found, against priors and a data sheet.
    ///
    /// Under the priors `sigmas` of a parameter is normal with mean 0 and variance 1 (the squares are those of the prior
    /// predictive check of Box, 1980). What is not observable departs from nothing.
    pub fn prior_departures(
        &self,
        identifiability: &Identifiability,
        sheet: &NoiseParameters,
    ) -> Vec<Departure> {
        let of_parameter = |place: usize| {
            let seen = &identifiability.parameters[place];
            if !(seen.identifiable || seen.shown == Observable::Combination) {
                return None;
            }
            let (value, _) = self.sum(place, &seen.aliases);
            let prior = |place: usize| &self.parameters[place];
            let others =
                || seen.aliases.iter().map(|alias| (alias.coefficient, prior(alias.unknown)));
            let expected =
                others().map(|(c, of)| c * of.expected).sum::<f64>() + prior(place).expected;
            let variance = |c: f64, sigma: f64| (c * sigma).powi(2);
            let sigma = others()
                .map(|(c, of)| variance(c, of.parameter.sigma))
                .fold(variance(1.0, prior(place).parameter.sigma), |sum, next| sum + next)
                .sqrt();
            // The data's own estimate would be off by its sigma too.
            let data = seen.data_sigma.min(sigma);
            let sigmas = (value - expected) / sigma.hypot(data);
            Some(Departure { of: Quantity::Parameter(place), value, expected, sigma, sigmas })
        };
        let of_noise = |of: Quantity, found: f64, stated: f64| {
            let sigmas = (found / stated).ln() / WHITE;
            let sigma = WHITE * stated;
            sigmas.is_finite().then_some(Departure {
                of,
                value: found,
                expected: stated,
                sigma,
                sigmas,
            })
        };
        let found = &self.noise[0].imu;
        (0..self.parameters.len())
            .filter_map(of_parameter)
            .chain(of_noise(Quantity::GyroNoise, found.gyro.white, sheet.gyro.white))
            .chain(of_noise(Quantity::AccelNoise, found.accel.white, sheet.accel.white))
            .collect()
    }
}
