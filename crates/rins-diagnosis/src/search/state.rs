//! A hypothesis with its fit and its score.

use rins_estimation::Fit;
use rins_terms::{Role, TermInstance};

use crate::case::Case;
use crate::evidence::{Scored, log_evidence};
use crate::hypothesis::{Effect, Hypothesis, USUAL, ln_settings};
use crate::proposal::candidates::Candidate;
use crate::proposal::dead_zone;

/// A fitted hypothesis.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// Its fit: the given terms, then the effects.
    pub(crate) fit: Fit,
    pub(crate) hypothesis: Hypothesis,
    /// Its score: the logarithm of marginal likelihood times prior, up to a constant.
    pub(crate) score: f64,
}

/// A hypothesis that was fitted, without its fit.
#[derive(Clone, Debug)]
pub(crate) struct Tried {
    pub(crate) hypothesis: Hypothesis,
    pub(crate) score: f64,
}

impl Tried {
    pub(crate) fn of(state: &State) -> Self {
        Self { hypothesis: state.hypothesis.clone(), score: state.score }
    }
}

impl Case<'_> {
    /// A fit with its score.
    pub(crate) fn state(&self, fit: Fit, hypothesis: Hypothesis, terms: usize) -> State {
        let data = log_evidence(&fit, self.given.terms.len(), &hypothesis.effects, self.imu);
        let knowledge = self.with_processes(&hypothesis.open).knowledge;
        let noise = fit.log_prior_of_noise(self.runs, knowledge, &fit.noise) + fit.ln_width;
        let score = data + noise + hypothesis.ln_prior(terms);
        State { fit, hypothesis, score }
    }

    /// A hypothesis, fitted near another one; its settings where they fit best if its score reaches `least` without that. `None` if it
    /// has no fit or no score.
    pub(crate) fn fitted(
        &self,
        (before, near): (&Fit, &State),
        mut hypothesis: Hypothesis,
        terms: usize,
        least: f64,
    ) -> Option<State> {
        let given = hypothesis.given(self.given, self.imu);
        let case = Case { given: &given, ..self.with_processes(&hypothesis.open) };
        let mut found: Vec<TermInstance> =
            hypothesis.effects.iter().map(|one| one.instance.clone()).collect();
        let fitted = case.fit_near(&near.fit, &found);
        let fitted = fitted.or_else(|_| case.fit_near(before, &found)).ok()?;
        let rough = self.state(fitted, hypothesis.clone(), terms);
        if !rough.score.is_finite() {
            return None;
        }
        if rough.score < least {
            return Some(rough);
        }
        let (fit, sought) = case.at_their_best(rough.fit, &mut found).ok()?;
        for (effect, instance) in hypothesis.effects.iter_mut().zip(found) {
            effect.instance = instance;
        }
        for one in &sought {
            let effect = &mut hypothesis.effects[one.cause];
            let kind = effect.instance.term.settings[one.place].kind;
            if !kind.is_smooth() {
                continue;
            }
            let prior = kind.prior(effect.instance.settings[one.place], self.duration())?;
            let width = one.sigma * std::f64::consts::TAU.sqrt() / prior.range;
            effect.ln_settings = width.ln().min(0.0);
        }
        Some(self.state(fit, hypothesis, terms)).filter(|state| state.score.is_finite())
    }
}

impl Candidate {
    /// The effect of a scored candidate, to be fitted: its amplitudes are held back by nothing.
    pub(crate) fn effect(&self, scored: &Scored, imu: &rins_imu::ImuSpec) -> Effect {
        /// A term of at most so many parameters is estimated whole.
        const WHOLE: usize = 9;
        let ln_settings = ln_settings(self);
        let within = |instance: &TermInstance, parameter: usize| {
            let usual = instance.term.parameters[parameter].sigma(imu);
            Role::Within(USUAL * usual * scored.amplitude.max(1.0))
        };
        if dead_zone::is_of_widths(&self.chosen) {
            let mut zone = dead_zone::of_shape(&self.chosen, &scored.parameters);
            for &gyro in &scored.parameters {
                zone.roles[gyro] = within(&zone, gyro);
            }
            return Effect { instance: zone, ln_settings };
        }
        let mut instance = self.chosen.clone();
        let n = instance.values.len();
        for parameter in 0..n {
            let is_free = n <= WHOLE || scored.parameters.contains(&parameter);
            instance.roles[parameter] =
                if is_free { within(&instance, parameter) } else { Role::Held };
        }
        Effect { instance, ln_settings }
    }
}
