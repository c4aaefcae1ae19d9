//! The prior of an effect's amplitude: log-uniform over the typical range of its grade, with heavy tails.

use rins_bayes::ScaleMixture;
use rins_imu::ImuSpec;
use rins_terms::Term;

/// A parameter departs from its prior by so many times the stated 1σ, at least and at most.
const DEPARTS: (f64, f64) = (3.0, 100.0);

/// The prior of the scale of a term's parameter, in units of its largest typical magnitude, for an IMU with this data sheet.
pub(crate) fn magnitudes(term: &Term, parameter: usize, imu: &ImuSpec) -> ScaleMixture {
    let parameter = &term.parameters[parameter];
    let (low, high) = parameter.range(imu);
    let sigma = parameter.sigma(imu);
    ScaleMixture::between(low / sigma, high / sigma)
}

/// The prior of the scale of a departure from a stated prior, in units of its 1σ.
pub(crate) fn magnitudes_of_departure() -> ScaleMixture {
    ScaleMixture::above(DEPARTS.0, DEPARTS.1)
}
