//! Trials that were got wrong once, or that stand for a kind of trial: what is to come of each does not change.

use std::sync::atomic::{AtomicUsize, Ordering};

use rins_terms::catalogue;

use crate::answer::{Analyser, Answer};
use crate::draw::Trial;
use crate::journal::answered;
use crate::laboratory::{Length, Level, Schedule};
use crate::trouble::Trouble;
use crate::workers::at_once;

/// A trial, and what is to come of it.
#[derive(Clone, Copy, Debug)]
pub struct Frozen {
    /// What it shows.
    pub name: &'static str,
    made: Made,
    wanted: Wanted,
}

/// How a trial is made.
#[derive(Clone, Copy, Debug)]
enum Made {
    /// A short run in which these effects are hidden, under a seed.
    Hiding(&'static [(&'static str, f64)], Schedule, Level, u64),
    /// A short run with a structure outside the catalogue, so many sigmas beyond any effect, under a seed.
    Outside(f64, Schedule, Level, u64),
    /// That of a campaign: its seed and its number.
    OfCampaign(u64, u64),
}

/// What is to come of a trial.
#[derive(Clone, Copy, Debug)]
enum Wanted {
    /// Nothing is named, nothing is left.
    Adequate,
    /// The first cause may be this effect.
    First(&'static str),
    /// Each of these effects may be one of the causes.
    Each(&'static [&'static str]),
    /// The same, with no more causes than these. The first of them is hidden in the trial.
    Only(&'static [&'static str]),
    /// The same, and nothing is left.
    OnlyAndNothingLeft(&'static [&'static str]),
    /// What is hidden, by name and channel, is unexplained there.
    Unexplained(&'static str, &'static str),
    /// Something is unexplained.
    Something,
}

use Level::{Flicker, White};
use Made::{Hiding, OfCampaign, Outside};
use Schedule::{Constant, Reversal, ThreeRates};
use Wanted::{Adequate, Each, First, Only, OnlyAndNothingLeft, Something, Unexplained};

const fn frozen(name: &'static str, made: Made, wanted: Wanted) -> Frozen {
    Frozen { name, made, wanted }
}

/// All of them.
#[rustfmt::skip]
const FROZEN: &[Frozen] = &[
    frozen("nothing at a constant rate", Hiding(const { &[] }, Constant, White, 1), Adequate),
    frozen("nothing but flicker", Hiding(const { &[] }, Reversal, Flicker, 2), Adequate),
    frozen("nothing at three rates", Hiding(const { &[] }, ThreeRates, White, 3), Adequate),
    frozen("a lever arm", Hiding(const { &[(catalogue::ACCEL_LEVER_ARM.id, 20.0)] }, ThreeRates, White, 11), First(catalogue::ACCEL_LEVER_ARM.id)),
    frozen("a latency beside flicker", Hiding(const { &[(catalogue::ENCODER_LATENCY.id, 20.0)] }, ThreeRates, Flicker, 12), First(catalogue::ENCODER_LATENCY.id)),
    frozen("an asymmetry", Hiding(const { &[(catalogue::GYRO_SCALE_ASYMMETRY.id, 20.0)] }, ThreeRates, White, 13), First(catalogue::GYRO_SCALE_ASYMMETRY.id)),
    frozen("a step of a bias", Hiding(const { &[(catalogue::ACCEL_BIAS_STEP.id, 20.0)] }, Constant, White, 14), First(catalogue::ACCEL_BIAS_STEP.id)),
    frozen("a tilt ramp", Hiding(const { &[(catalogue::BASE_TILT_RAMP.id, 20.0)] }, Constant, White, 15), First(catalogue::BASE_TILT_RAMP.id)),
    frozen("an eccentricity beside flicker", Hiding(const { &[(catalogue::ENCODER_ECCENTRICITY.id, 20.0)] }, Reversal, Flicker, 16), First(catalogue::ENCODER_ECCENTRICITY.id)),
    frozen("a wobble", Hiding(const { &[(catalogue::TABLE_WOBBLE.id, 20.0)] }, Reversal, White, 17), First(catalogue::TABLE_WOBBLE.id)),
    frozen("two effects", Hiding(const { &[(catalogue::GYRO_BIAS_STEP.id, 20.0), (catalogue::ENCODER_HARMONIC.id, 20.0)] }, ThreeRates, White, 21), Each(const { &[catalogue::GYRO_BIAS_STEP.id, catalogue::ENCODER_HARMONIC.id] })),
    frozen("what no effect explains is not adequate", Outside(30.0, ThreeRates, White, 31), Something),
    // At the edges of a zone derivatives jump: its estimate converges to no point, only to points that are as good.
    frozen("a dead zone whose likelihood is not smooth", OfCampaign(24, 36), Only(const { &[catalogue::GYRO_DEAD_ZONE.id] })),
    // At one rate nothing but the table's cogging shows how late an encoder is: what it leaves is a line, of no sensor.
    frozen("cogging that comes late is no line", OfCampaign(16, 0), Only(const { &[catalogue::ENCODER_LATENCY.id] })),
    // Four microseconds are little of what latencies are, but as much as backlash that would do the same.
    frozen("what is small of its kind stays in the set", OfCampaign(17, 373), Only(const { &[catalogue::ENCODER_LATENCY.id] })),
    // Of an event between two of the times that are tried, a warm-up shows more at first.
    frozen("a step is tried at its time before a warm-up is named", OfCampaign(17, 345), Only(const { &[catalogue::ACCEL_BIAS_STEP.id] })),
    // Heat that lags far behind, with a warm-up, can be every effect of a table that turns but twice in the run.
    frozen("slow heat does not stand for an imperfect table", OfCampaign(17, 179), OnlyAndNothingLeft(const { &[catalogue::CABLE_TORQUE_TILT.id, catalogue::TABLE_WOBBLE.id, catalogue::ENCODER_ECCENTRICITY.id] })),
    // It is neither an effect of gravity nor a line on top, though both follow it.
    frozen("a bump on a table that turns back", OfCampaign(24, 278), Unexplained("pulse once per revolution", "gyro.z")),
    // What is left of a sawtooth beside a line passes for flicker, multiple by multiple, or for a walk with steps in it.
    frozen("a sawtooth on a gyro", OfCampaign(24, 638), Unexplained("sawtooth", "gyro.y")),
    frozen("a sawtooth on an accelerometer", OfCampaign(24, 262), Unexplained("sawtooth", "accel.z")),
    // Means over epochs may show outliers, and not enough to be believed: samples do.
    frozen("heavy tails that epochs hardly show", OfCampaign(25, 171), Unexplained("heavy tails", "gyro.x")),
];

/// Runs the frozen trials, so many at once. `told` gets each with what is wrong with it, if anything is.
///
/// # Errors
/// [`Trouble::Frozen`] if any is not as it was, and any other [`Trouble`] of a trial.
pub fn run_frozen(
    analyser: &Analyser,
    threads: usize,
    told: impl Fn(&Frozen, Option<&str>) + Sync,
) -> Result<(), Trouble> {
    let wrong = AtomicUsize::new(0);
    at_once(threads, FROZEN, |trial| {
        let fault = trial.fault(analyser)?;
        wrong.fetch_add(usize::from(fault.is_some()), Ordering::Relaxed);
        told(trial, fault.as_deref());
        Ok(())
    })?;
    match wrong.into_inner() {
        0 => Ok(()),
        wrong => Err(Trouble::Frozen { wrong, of: FROZEN.len() }),
    }
}

impl Frozen {
    /// What is wrong with what the program says of it; nothing if it is as wanted.
    ///
    /// # Errors
    /// [`Trouble`] if the trial cannot be made or the program cannot be started.
    pub fn fault(&self, analyser: &Analyser) -> Result<Option<String>, Trouble> {
        let trial = match self.made {
            Hiding(effects, schedule, level, seed) => {
                Trial::hiding(effects, schedule, level, seed)?
            }
            Outside(remainder, schedule, level, seed) => {
                Trial::outside(remainder, schedule, level, seed)?
            }
            OfCampaign(seed, index) => Trial::draw(seed, index, Length::Drawn)?,
        };
        if let Some(other) = self.is_another(&trial) {
            return Ok(Some(other));
        }
        let (_, answer) = answered(&trial, analyser)?;
        let right = answer.failure.is_none() && self.wanted.is_met(&answer);
        Ok((!right).then(|| format!("wanted {:?}, got {answer:?}", self.wanted)))
    }

    /// Whether the trial that was drawn is no longer the one that was frozen.
    fn is_another(&self, trial: &Trial) -> Option<String> {
        let wanted: Vec<&str> = match (self.made, self.wanted) {
            (Hiding(effects, ..), _) => effects.iter().map(|(id, _)| *id).collect(),
            (_, Only(ids) | OnlyAndNothingLeft(ids)) => ids[..1].to_vec(),
            (_, Unexplained(name, channel)) => vec![name, channel],
            _ => return None,
        };
        let outside = trial.outside.iter().flat_map(|one| [one.name.as_str(), &one.channel]);
        let hidden = trial.hidden.iter().map(|one| one.id.as_str()).chain(outside);
        let hidden: Vec<&str> = hidden.take(wanted.len()).collect();
        (hidden != wanted).then(|| format!("hides {hidden:?}, not {wanted:?}"))
    }
}

impl Wanted {
    fn is_met(self, answer: &Answer) -> bool {
        let each =
            |ids: &[&str]| ids.iter().all(|id| answer.causes.iter().any(|one| one.may_be(id)));
        let only = |ids: &[&str]| each(ids) && answer.causes.len() == ids.len();
        match self {
            Adequate => {
                answer.verdict == "adequate"
                    && answer.causes.is_empty()
                    && answer.unexplained.is_empty()
            }
            First(id) => answer.causes.first().is_some_and(|first| first.may_be(id)),
            Each(ids) => each(ids),
            Only(ids) => only(ids),
            OnlyAndNothingLeft(ids) => only(ids) && answer.unexplained.is_empty(),
            Unexplained(_, channel) => {
                answer.unexplained.iter().any(|one| one.starts_with(channel))
            }
            Something => !answer.unexplained.is_empty(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::Named;

    fn answer(verdict: &str, causes: &[&str], unexplained: &[&str]) -> Answer {
        let named = |id: &&str| Named { effect: (*id).into(), ..Named::default() };
        Answer {
            verdict: verdict.into(),
            causes: causes.iter().map(named).collect(),
            unexplained: unexplained.iter().map(|one| (*one).into()).collect(),
            ..Answer::default()
        }
    }

    #[test]
    fn an_answer_that_is_not_wanted_is_seen() {
        let clean = answer("adequate", &[], &[]);
        let named = answer("effects", &["a", "b"], &["gyro.x: a sawtooth"]);
        for (wanted, of_clean, of_named) in [
            (Adequate, true, false),
            (First("a"), false, true),
            (First("b"), false, false),
            (Each(&["b", "a"]), false, true),
            (Each(&["a", "c"]), false, false),
            (Only(&["a", "b"]), false, true),
            (Only(&["a"]), false, false),
            (OnlyAndNothingLeft(&["a", "b"]), false, false),
            (Unexplained("sawtooth", "gyro.x"), false, true),
            (Unexplained("sawtooth", "gyro.y"), false, false),
            (Something, false, true),
        ] {
            assert_eq!(wanted.is_met(&clean), of_clean, "{wanted:?}");
            assert_eq!(wanted.is_met(&named), of_named, "{wanted:?}");
        }
    }
}
