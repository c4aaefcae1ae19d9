//! A bias that walks at random, which passes for ramps, warm-ups and steps as long as a sheet says nothing of it.

use rins_estimation::{NoiseKnowledge, NoiseParameters, TriadStrengths};
use rins_terms::{Term, TermInstance, catalogue};

use crate::case::Case;
use crate::cause::{Cause, Rival};
use crate::diagnosis::{Diagnosis, DiagnosisError};
use crate::noise::triad;
use crate::periodic::{is_line, strongest};
use crate::settling::RIVALS;
use crate::structure::Structure;

/// The effects of either triad that change its biases slowly.
static SLOW: [&[&Term]; 2] = [
    &[
        &catalogue::GYRO_BIAS_RAMP,
        &catalogue::GYRO_BIAS_STEP,
        &catalogue::GYRO_WARMUP,
        &catalogue::GYRO_THERMAL_BIAS,
        &catalogue::GYRO_HYSTERESIS,
        &catalogue::GYRO_BIAS_INSTABILITY,
        // What follows heat slowly goes on for long after a rest or a reversal.
        &catalogue::THERMAL_ONE_PER_TURN,
    ],
    &[
        &catalogue::ACCEL_BIAS_RAMP,
        &catalogue::ACCEL_BIAS_STEP,
        &catalogue::ACCEL_WARMUP,
        &catalogue::ACCEL_THERMAL_BIAS,
        &catalogue::ACCEL_BIAS_INSTABILITY,
    ],
];

/// A line of fewer cycles in a run is slow.
const SLOW_CYCLES: f64 = 20.0;

/// How many e-folds of odds it costs to have chosen one slow effect among all, and when it happens.
pub(crate) const CHOSEN: f64 = 5.0;

/// The search starts from a walk that over the run is so many times as far as white noise lets it be seen.
const SEEN: f64 = 3.0;

/// The same of a walk, whose strength is chosen.
const WALKED: f64 = 8.0;

/// A walk that is so many times stronger than is usual at most is none: something else wanders, such as what carries the
/// sensors.
const UNHEARD_OF: f64 = 100.0;

/// The terms of the walks of either triad.
const WALKS: [&Term; 2] = [&catalogue::GYRO_RATE_RANDOM_WALK, &catalogue::ACCEL_RATE_RANDOM_WALK];

/// The triads by what their channels begin with.
const TRIADS: [&str; 2] = ["gyro", "accel"];

/// Slow effects, and how much better a walk of the biases explains the run.
struct Instead {
    /// Which triad.
    triad: usize,
    /// The places of the slow effects among the causes.
    slow: Vec<usize>,
    /// The logarithm of the odds for the walk against them.
    odds: f64,
    /// How much of these is what was left open of the slow effects before they were found: were they expected as they are,
    /// the odds would be less by so much.
    open: f64,
}

impl Instead {
    /// Whether a walk of this triad is named among what is `walked`; if so, with those of the slow effects `found` that explain
    /// as much.
    fn told_as_walk(&self, found: &Diagnosis, walked: &mut Diagnosis) -> bool {
        let own = walked.causes.iter_mut().find(|cause| cause.term.is(WALKS[self.triad]));
        let Some(own) = own else { return false };
        // A walk has one parameter that is open, a few effects have many: that alone does not rule them out.
        let least = (self.odds - self.open).max(0.0);
        if least < RIVALS {
            for slow in self.slow.iter().map(|&place| &found.causes[place]) {
                // Several steps are one effect.
                if own.rivals.iter().all(|other| !other.term.is(slow.term)) {
                    let (term, settings) = (slow.term, slow.settings.clone());
                    own.rivals.push(Rival { term, settings, odds: -least });
                }
            }
        }
        true
    }
}

impl Case<'_> {
    /// What `found` is if biases may walk at random though the sheet says nothing of it: where that explains as much as the
    /// slow effects that were found, or more.
    pub(crate) fn wandering(
        &self,
        mut found: Diagnosis,
        search: impl FnOnce(&Self) -> Result<Diagnosis, DiagnosisError>,
    ) -> Result<Diagnosis, DiagnosisError> {
        let NoiseKnowledge::Likely(mut sheet) = self.knowledge else { return Ok(found) };
        let of_triads: Vec<Instead> = (0..TRIADS.len())
            .filter(|&which| triad(&mut { sheet }, which).walk == 0.0)
            .filter_map(|which| self.instead(&found, which, sheet))
            .collect();
        let mut walking = *self;
        for Instead { triad: which, .. } in of_triads.iter().filter(|one| one.odds > 0.0) {
            self.walk(triad(&mut sheet, *which));
            walking.knowledge = NoiseKnowledge::Likely(sheet);
        }
        if walking.knowledge != self.knowledge {
            let mut walked = search(&walking)?;
            let mut is_named = false;
            for one in of_triads.iter().filter(|one| one.odds > 0.0) {
                is_named |= one.told_as_walk(&found, &mut walked);
            }
            // A walk that is nothing over flicker does not explain away what is something over it.
            if is_named {
                // What it gains is over the model without a walk.
                walked.before = found.before;
                return Ok(walked);
            }
        }
        for Instead { triad: which, slow, odds, .. } in
            of_triads.iter().filter(|one| one.odds > -RIVALS)
        {
            for &place in slow {
                let (term, settings) = (WALKS[*which], Vec::new());
                found.causes[place].rivals.push(Rival { term, settings, odds: *odds });
            }
        }
        Ok(found)
    }

    /// Gives a triad a walk where the search for it may start.
    fn walk(&self, triad: &mut TriadStrengths) {
        triad.walk = SEEN * triad.white / self.duration();
    }

    /// How well a walk of one triad's biases explains what slow effects of it were found for, if there are any or
    /// anything is left of them.
    fn instead(
        &self,
        found: &Diagnosis,
        which: usize,
        mut sheet: NoiseParameters,
    ) -> Option<Instead> {
        let name = TRIADS[which];
        self.walk(triad(&mut sheet, which));
        let is_slow = |id: &str| SLOW[which].iter().any(|slow| slow.id == id);
        let is_slow_line = |one: &Cause| {
            one.settings.first().is_some_and(|frequency| frequency * self.duration() < SLOW_CYCLES)
                && strongest(one).is_some_and(|(channel, ..)| channel.starts_with(name))
        };
        let causes = found.causes.iter().enumerate();
        let slow: Vec<usize> = causes
            .filter(|(_, one)| is_slow(one.term.id) || is_line(one) && is_slow_line(one))
            .map(|(place, _)| place)
            .collect();
        let left = found.unexplained.iter().any(|one| match one.structure {
            Structure::Drift | Structure::Switching(_) => one.channel.starts_with(name),
            Structure::Line(frequency) => {
                one.channel.starts_with(name) && frequency * self.duration() < SLOW_CYCLES
            }
            Structure::Inconstant(_) => one.of.is_some_and(is_slow),
            _ => false,
        });
        if slow.is_empty() && !left {
            return None;
        }
        let is_given_up = |one: &&TermInstance| {
            let alike = |&place: &usize| {
                let slow = &found.causes[place];
                (slow.term.id, &slow.settings) == (one.term.id, &one.settings)
            };
            slow.iter().any(alike)
        };
        let causes = self.causes_in(&found.after).iter();
        let kept: Vec<TermInstance> = causes.filter(|one| !is_given_up(one)).cloned().collect();
        let other = Case { knowledge: NoiseKnowledge::Likely(sheet), ..*self };
        let walked = other.fit_near(&found.after, &kept).ok()?;
        let mut strengths = walked.noise[0].imu;
        let usual = WALKS[which].parameters[0].range(self.imu).1;
        if triad(&mut strengths, which).walk > UNHEARD_OF * usual {
            return None;
        }
        let gained = walked.log_likelihood - found.after.log_likelihood;
        let odds = gained + CHOSEN * slow.len() as f64 - WALKED;
        let of_slow = slow.iter().flat_map(|&place| &found.causes[place].parameters);
        let open = of_slow.map(|one| (one.parameter.sigma / one.sigma).ln().max(0.0)).sum();
        Some(Instead { triad: which, slow, odds, open })
    }
}
