//! The test that distinguishes two effects which a run could not distinguish.

use nalgebra::DVector;
use rins_estimation::{Noise, Reference, Run};
use rins_imu::ImuSpec;
use rins_terms::{Model, Need, SettingKind, Term, TermInstance};

use crate::effect::Effect;
use crate::error::DesignError;
use crate::limits::{Limits, TYPICAL_ACCELERATION, TYPICAL_RATE};
use crate::planned::Planned;
use crate::proposal::{Goal, propose};

/// The longest duration of the proposed test, relative to that of the run.
const LONGER: f64 = 2.0;

/// The largest number of directions of the axis.
const DIRECTIONS: usize = 2;

/// An effect with its estimated size, and the alternative that a run could not exclude.
#[derive(Clone, Copy, Debug)]
pub struct Confused<'a> {
    /// The effect, with its settings and its estimated values, in SI units.
    pub found: &'a TermInstance,
    /// The alternative, with its settings.
    pub alternative: &'a TermInstance,
}

/// A schedule that distinguishes an effect of the estimated size from an alternative.
#[derive(Clone, Debug)]
pub struct NextTest {
    /// The alternative that it excludes.
    pub from: &'static Term,
    /// The description of the schedule.
    pub words: String,
    /// The separation of the two effects, in sigmas.
    pub sigmas: f64,
}

/// The shortest schedule of the library that distinguishes an effect from an alternative, with both in addition to `model`;
/// `None` if there is no such schedule of at most twice the run's duration.
///
/// The run is one of those that could not distinguish them, with the noise estimated from it.
///
/// # Errors
/// [`DesignError`] if a schedule cannot be simulated.
pub fn next_test(
    (run, noise): (&Run, &Noise),
    imu: &ImuSpec,
    model: &Model,
    Confused { found, alternative }: Confused<'_>,
) -> Result<Option<NextTest>, DesignError> {
    let pair = [found, alternative];
    let is_planned = matches!(run.rig.reference, Reference::Encoder { .. });
    if !is_planned || pair.iter().any(|chosen| !comes_again(chosen.term)) {
        return Ok(None);
    }
    let mut imu = *imu;
    for (sheet, found) in [(&mut imu.gyro, &noise.imu.gyro), (&mut imu.accel, &noise.imu.accel)] {
        sheet.noise_density = found.white;
        sheet.bias_instability = (found.flicker > 0.0).then_some(found.flicker);
        sheet.random_walk = (found.walk > 0.0).then_some(found.walk);
    }
    let mut model = model.clone();
    for TermInstance { term, settings, .. } in pair {
        let mut chosen = TermInstance::new(term).estimated();
        chosen.settings.clone_from(settings);
        model.terms.push(chosen);
    }
    let effects = pair.map(|chosen| Effect::of(chosen.term));
    // In units of the priors, as the information is.
    let parameters = found.values.iter().zip(found.term.parameters);
    let along = parameters.map(|(value, parameter)| value / parameter.sigma(&imu));
    let along = DVector::from_vec(along.collect());
    let goal = Goal::Separate { effects: &effects, confused: [vec![along], Vec::new()] };
    let given = Planned::like(run, noise, imu)?;
    let fastest = given.fastest();
    let limits = Limits {
        rate: if fastest > 0.0 { fastest } else { TYPICAL_RATE },
        acceleration: TYPICAL_ACCELERATION,
        duration: LONGER * given.duration(),
        directions: DIRECTIONS,
    };
    let proposal = propose(&given, &model, &goal, &limits, |_, _| {})?;
    Ok(proposal.enough.then(|| NextTest {
        from: alternative.term,
        words: proposal.candidate.words.clone(),
        sigmas: proposal.reached,
    }))
}

/// Whether an effect recurs in another run, independently of the temperature.
fn comes_again(term: &Term) -> bool {
    let in_time = [SettingKind::Time, SettingKind::TimeConstant, SettingKind::Frequency];
    !term.settings.iter().any(|setting| in_time.contains(&setting.kind))
        && !term.needs.contains(&Need::Temperature)
}
