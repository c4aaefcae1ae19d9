//! The consistency of estimates with their priors.

use crate::estimate::Fit;
use crate::identifiability::{Identifiability, Observable};
use crate::noise_parameters::NoiseParameters;
use crate::noise_prior::STATED;

/// The departure of an estimate from its prior, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Departure {
    /// The estimated quantity.
    pub of: Quantity,
    /// The estimate of the parameter or of the combination.
    pub value: f64,
    /// The mean of the prior.
    pub expected: f64,
    /// The 1σ of the prior; for noise the 1σ of its logarithm times the stated value.
    pub sigma: f64,
    /// The departure in units of its standard deviation from prior and data; for noise, that of the logarithm.
    pub sigmas: f64,
}

/// A quantity that is compared with its prior.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The parameter at this place, or the combination that begins with it.
    Parameter(usize),
    /// The white noise of the gyros.
    GyroNoise,
    /// The white noise of the accelerometers.
    AccelNoise,
}

impl Fit {
    /// Compares observable parameters and combinations, and the estimated white noise, with their priors and a data sheet.
    ///
    /// If the priors are correct, `sigmas` of a parameter is normal with mean 0 and variance 1 (its square is the statistic
    /// of the prior predictive check of Box, 1980). Unobservable parameters are not compared.
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
            // The estimate from the data alone has this uncertainty.
            let data = seen.data_sigma.min(sigma);
            let sigmas = (value - expected) / sigma.hypot(data);
            Some(Departure { of: Quantity::Parameter(place), value, expected, sigma, sigmas })
        };
        let of_noise = |of: Quantity, found: f64, stated: f64| {
            let sigmas = (found / stated).ln() / STATED;
            let sigma = STATED * stated;
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
