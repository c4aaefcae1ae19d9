//! The settings of a candidate, searched for in ever finer steps.

use rins_bayes::log_sum;
use rins_estimation::Indefinite;
use rins_terms::SettingKind;

use crate::case::Case;
use crate::evidence::{Family, Scored, Screen};
use crate::proposal::candidates::Candidate;
use crate::search::{Round, State};

/// How finely, in parts of the step between candidates.
const FINER: [f64; 3] = [0.125, 0.03, 0.0075];

impl Case<'_> {
    /// The candidate of a family with the setting that fits best, its score, and the score of the family: the integral over the
    /// setting about it, at the resolution at which it is largest.
    pub(crate) fn with_best_setting(
        &self,
        (state, round): (&State, &Round),
        dropped: &[usize],
        candidate: &Candidate,
        family: &Family,
    ) -> Result<(Candidate, Scored, f64), Indefinite> {
        let mut best = (candidate.clone(), family.best.clone());
        let mut most = family.score;
        let Round { noises, ln_priors, .. } = round;
        let density = match best.0.step {
            Some((place, _)) if best.0.chosen.term.settings[place].kind == SettingKind::Time => {
                self.duration().recip()
            }
            Some((_, step)) => (best.0.looks * step).recip(),
            None => best.0.looks.recip(),
        };
        for part in FINER {
            let mut list = best.0.neighbours(part);
            let step = best.0.step.map_or(1.0, |(_, step)| step * part);
            for one in &mut list {
                one.looks = (density * step).recip();
            }
            let survey = self.survey(&state.fit, &list, noises)?;
            let of = (&survey, self.imu, round.terms);
            let Some(screen) = Screen::of(of, ln_priors, dropped, &[]) else { break };
            let scored: Vec<Scored> = list
                .iter()
                .enumerate()
                .filter_map(|(index, one)| screen.candidate(index, one))
                .collect();
            let Some(top) = scored.iter().max_by(|a, b| a.score.total_cmp(&b.score)) else { break };
            most = most.max(log_sum(scored.iter().map(|one| one.score)));
            let found = list[top.candidate].clone();
            best = (Candidate { step: candidate.step, ..found }, top.clone());
        }
        Ok((best.0, best.1, most))
    }
}
