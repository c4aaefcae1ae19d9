//! The score of a hypothesis that is given and not searched for.

use rins_estimation::Fit;
use rins_terms::{GridPoint, Role, SettingKind, TermInstance};

use crate::case::Case;
use crate::diagnosis::DiagnosisError;
use crate::evidence::Screen;
use crate::hypothesis::{Effect, Hypothesis, USUAL};
use crate::proposal::candidates::Candidate;
use crate::search::{Round, State, Tried};

impl Case<'_> {
    /// A hypothesis with these effects, the pass about it, and what is fitted without each of them.
    pub(crate) fn evaluated(
        &self,
        before: &Fit,
        effects: &[TermInstance],
    ) -> Result<(State, Round, Vec<Tried>), DiagnosisError> {
        let terms = self.families();
        let none = self.state(before.clone(), Hypothesis::default(), terms);
        // How wide the priors of the amplitudes have to be is found as in a search, one effect after the other.
        let mut rough = none.clone();
        for one in effects {
            let chosen = one.clone().estimated();
            let looks = (-self.ln_settings_of(one, before)).exp();
            let candidate = Candidate { chosen, looks, step: None, departs: None };
            let amplitude = self.amplitude(&rough, &candidate)?;
            let mut instance = candidate.chosen;
            for (role, parameter) in instance.roles.iter_mut().zip(one.term.parameters) {
                *role = Role::Within(USUAL * amplitude * parameter.sigma(self.imu));
            }
            let mut hypothesis = rough.hypothesis.clone();
            hypothesis.effects.push(Effect { instance, ln_settings: -looks.ln() });
            let instances: Vec<TermInstance> =
                hypothesis.effects.iter().map(|effect| effect.instance.clone()).collect();
            let fit = self.fit_near(&rough.fit, &instances)?;
            rough = self.state(fit, hypothesis, terms);
        }
        let effects = rough.hypothesis.effects.clone();
        let mut tried = vec![Tried::of(&none)];
        let with = |effects: Vec<Effect>| {
            let hypothesis = Hypothesis { effects, ..Hypothesis::default() };
            self.fitted((before, &none), hypothesis, terms, f64::NEG_INFINITY)
        };
        if effects.len() > 1 {
            for place in 0..effects.len() {
                let mut others = effects.clone();
                others.remove(place);
                tried.extend(with(others).as_ref().map(Tried::of));
            }
        }
        // If its settings cannot be improved, it stays as it is.
        let state = with(effects).unwrap_or(rough);
        let round = self.round(before, &state, terms)?;
        Ok((state, round, tried))
    }

    /// The largest amplitude of a candidate beside a hypothesis, in units of its largest typical magnitude, and one at least.
    fn amplitude(&self, beside: &State, candidate: &Candidate) -> Result<f64, DiagnosisError> {
        let list = std::slice::from_ref(candidate);
        let noises = self.noises(&beside.fit);
        let survey = self.survey(&beside.fit, list, &noises)?;
        let screen = Screen::of((&survey, self.imu, 1), &vec![0.0; noises.len()], &[], &[]);
        let scored = screen.and_then(|screen| screen.candidate(0, candidate));
        Ok(scored.map_or(1.0, |scored| scored.amplitude.max(1.0)))
    }

    /// The logarithm of the prior probability of an effect's settings, to within what the runs resolve.
    fn ln_settings_of(&self, effect: &TermInstance, fit: &Fit) -> f64 {
        let epoch = fit.linear[0].mean_epoch();
        let settings = effect.term.settings.iter().zip(&effect.settings);
        let each = settings.map(|(setting, &value)| match setting.kind {
            SettingKind::Time => (epoch / self.duration()).ln(),
            _ => setting.search_grid(self.duration()).map_or(0.0, |grid| {
                let grid: Vec<GridPoint> = grid.collect();
                let all: f64 = grid.iter().map(|point| point.weight).sum();
                let near = |point: &&GridPoint| (point.value - value).abs();
                let nearest = grid.iter().min_by(|a, b| near(a).total_cmp(&near(b)));
                nearest.map_or(0.0, |point| (point.weight / all).ln())
            }),
        });
        each.sum()
    }
}
