//! The observability of the three parameters.

use rins_calibration::{Parameter, Partner};

use crate::identifiability::{OBSERVABLE, Summand, only_in, sum_in_words};

/// What the three estimates also carry, from accelerometer errors that the model does not have.
pub(super) const SYSTEMATIC_NOTE: &str = "Accelerometer biases also affect the zero-velocity updates \
and are not in this model. A bias of 200 ug causes errors of up to 0.03 arcsec in the misalignments and 0.1 ppm in \
the scale error. The sigmas do not include these errors, which are proportional to the bias.";

/// The observability of a parameter, as a person reads it, and what its combination was found to be if it is in one.
pub(super) fn meaning(parameter: &Parameter) -> String {
    if parameter.identifiable() {
        return OBSERVABLE.into();
    }
    let factor = parameter.kind.factor();
    let found = (parameter.value / factor, parameter.sigma / factor, parameter.kind.unit());
    let summand = |partner: &Partner| Summand {
        coefficient: partner.share * partner.kind.factor() / parameter.kind.factor(),
        unit: partner.kind.unit(),
        name: partner.id.clone(),
    };
    let summands = parameter.partners.iter().map(summand);
    only_in(&sum_in_words(&parameter.id, parameter.kind.unit(), summands), Some(found))
}
