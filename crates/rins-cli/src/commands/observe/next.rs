//! The test that would tell a cause from what a run could not tell it from.

use nalgebra::DVector;
use rins_diagnosis::{Cause, Rival};
use rins_estimation::{Estimate, Noise, Reference, Run};
use rins_imu::ImuSpec;
use rins_terms::{Chosen, Model, Need, SettingKind, Term};

use super::chosen::Effect;
use super::library::Limits;
use super::proposal::{Goal, propose};
use super::schedule::Planned;
use super::{USUAL_ACCELERATION, USUAL_RATE};

/// The longest test that is proposed takes so many times as long as the run that could not tell.
const LONGER: f64 = 2.0;

/// Into how many directions the axis is brought at most.
const DIRECTIONS: usize = 2;

/// A schedule that tells a cause of the size that was found from another effect.
pub(crate) struct NextTest {
    /// The effect from which it tells the cause.
    pub(crate) from: &'static Term,
    /// What the table does, and for how long.
    pub(crate) words: String,
    /// By how many sigmas the two differ then.
    pub(crate) sigmas: f64,
}

/// The shortest schedule of the library that tells a cause from a rival, both beside `model`; none if none of at most
/// twice the run's length does.
///
/// # Errors
/// If a schedule cannot be simulated.
pub(crate) fn next_test(
    (run, noise): (&Run, &Noise),
    imu: &ImuSpec,
    model: &Model,
    cause: &Cause,
    rival: &Rival,
) -> anyhow::Result<Option<NextTest>> {
    let pair = [(cause.term, cause.settings.clone()), (rival.term, rival.settings.clone())];
    let is_planned = matches!(run.rig.reference, Reference::Encoder { .. });
    if !is_planned || pair.iter().any(|(term, _)| !comes_again(term)) {
        return Ok(None);
    }
    let mut imu = *imu;
    for (sheet, found) in [(&mut imu.gyro, &noise.imu.gyro), (&mut imu.accel, &noise.imu.accel)] {
        sheet.noise_density = found.white;
        sheet.bias_instability = (found.flicker > 0.0).then_some(found.flicker);
        sheet.random_walk = (found.walk > 0.0).then_some(found.walk);
    }
    let mut model = model.clone();
    for (term, settings) in &pair {
        let mut chosen = Chosen::new(term).estimated();
        chosen.settings.clone_from(settings);
        model.terms.push(chosen);
    }
    let effects = pair.each_ref().map(|(term, _)| Effect {
        asked: term.id.into(),
        ids: term.parameter_ids().collect(),
        term,
    });
    // In units of what is expected, as information is.
    let of = |parameter: usize| {
        let own = |e: &&Estimate| e.parameter.parameter == parameter;
        let value = cause.parameters.iter().find(own).map_or(0.0, |estimate| estimate.value);
        value / cause.term.parameters[parameter].sigma(&imu)
    };
    let along = DVector::from_fn(cause.term.parameters.len(), |parameter, _| of(parameter));
    let goal = Goal::Separate { effects: &effects, confused: [vec![along], Vec::new()] };
    let given = Planned::like(run, noise, imu)?;
    let fastest = given.fastest();
    let limits = Limits {
        rate: if fastest > 0.0 { fastest } else { USUAL_RATE },
        acceleration: USUAL_ACCELERATION,
        duration: LONGER * given.duration(),
        directions: DIRECTIONS,
    };
    let found = propose(&given, &model, &goal, &limits)?;
    Ok(found.enough.then(|| NextTest {
        from: rival.term,
        words: found.candidate.words.clone(),
        sigmas: found.reached,
    }))
}

/// Whether an effect would be there again in a run of its own, whatever the temperature does.
fn comes_again(term: &Term) -> bool {
    let in_time = [SettingKind::Time, SettingKind::TimeConstant, SettingKind::Frequency];
    !term.settings.iter().any(|setting| in_time.contains(&setting.kind))
        && !term.needs.contains(&Need::Temperature)
}
