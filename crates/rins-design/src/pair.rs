//! The separability of two effects in planned runs.

use nalgebra::DMatrix;
use rins_estimation::{Joint, NoiseParameters, Separation, joint, separation};
use rins_terms::Model;

use crate::effect::Effect;
use crate::error::DesignError;
use crate::planned::Planned;

/// The separation in sigmas from which two effects count as distinguishable.
pub const ENOUGH: f64 = 6.0;

/// The joint information of these planned runs of one IMU on the free parameters of `model`, which is along the sensors' own axes.
///
/// # Errors
/// [`DesignError`] if a run cannot be simulated, or the model cannot be estimated from the runs.
///
/// # Panics
/// If there are no plans.
pub fn information(planned: &[Planned], model: &Model) -> Result<Joint, DesignError> {
    let runs = planned.iter().map(Planned::run).collect::<Result<Vec<_>, _>>()?;
    let imu = &planned[0].imu;
    Ok(joint(&runs, model, imu, &NoiseParameters::of(imu))?)
}

/// The separability of two effects in planned runs.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The first effect against the second, and the second against the first.
    pub separations: [Separation; 2],
    /// The significance of the first effect, of its typical size and in its worst direction, if any amount of the second may be
    /// present; and the reverse \[sigma\].
    pub separation: [f64; 2],
}

impl Pair {
    /// The separability of two effects, with the other parameters of the model estimated too.
    pub fn of(joint: &Joint, effects: &[Effect; 2]) -> Self {
        let [first, second] = effects.each_ref().map(|effect| effect.places(joint));
        let both: Vec<usize> = first.iter().chain(&second).copied().collect();
        let information = with_priors(joint, &both);
        let separations =
            [separation(&information, &first, &second), separation(&information, &second, &first)];
        let separation = separations.each_ref().map(|separation| {
            let least = separation.directions.iter().map(|direction| direction.separation);
            if separation.directions.is_empty() { 0.0 } else { least.fold(f64::INFINITY, f64::min) }
        });
        Self { separations, separation }
    }

    /// Whether the effects are distinguishable if each has its typical size.
    pub fn is_separated(&self) -> bool {
        self.separation.iter().all(|sigmas| *sigmas >= ENOUGH)
    }
}

/// The information in units of the priors, with the priors of all parameters except those at `places` included.
pub(crate) fn with_priors(joint: &Joint, places: &[usize]) -> DMatrix<f64> {
    let mut information = joint.information();
    for place in (0..information.nrows()).filter(|place| !places.contains(place)) {
        information[(place, place)] += 1.0;
    }
    information
}
