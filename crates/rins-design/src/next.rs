//! The test that would separate two effects that a run could not separate.

use nalgebra::DVector;
use rins_estimation::{Noise, Reference, Run};
use rins_imu::ImuSpec;
use rins_terms::{Model, Need, SettingKind, Term, TermInstance};

use crate::effect::Effect;
use crate::error::DesignError;
use crate::library::{Limits, TYPICAL_ACCELERATION, TYPICAL_RATE};
use crate::planned::Planned;
use crate::proposal::{Goal, propose};

/// The longest test that is proposed takes so many times as long as the run that could not tell.
const LONGER: f64 = 2.0;

/// Into how many directions the axis is brought at most.
const DIRECTIONS: usize = 2;

/// An effect of the size that was found, and the alternative from which a run could not separate it.
#[derive(Clone, Copy, Debug)]
pub struct Confused<'a> {
    /// The effect, with its settings and the values that were found, in SI units.
    pub found: &'a TermInstance,
    /// The alternative, with its settings.
    pub alternative: &'a TermInstance,
}

/// A schedule that separates an effect of the size that was found from an alternative.
#[derive(Clone, Debug)]
pub struct NextTest {
    /// The effect from which it tells the cause.
    pub from: &'static Term,
    /// What the table does, and for how long.
    pub words: String,
    /// By how many sigmas the two differ then.
    pub sigmas: f64,
}

/// The shortest schedule of the library that separates an effect from an alternative, both beside `model`; none if none of at
/// most twice the run's length does.
///
/// The run is one of those that could not separate them, with the noise that was found in it.
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
    // In units of what is expected, as information is.
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

/// Whether an effect would be there again in a run of its own, whatever the temperature does.
fn comes_again(term: &Term) -> bool {
    let in_time = [SettingKind::Time, SettingKind::TimeConstant, SettingKind::Frequency];
    !term.settings.iter().any(|setting| in_time.contains(&setting.kind))
        && !term.needs.contains(&Need::Temperature)
}
