//! Settings that were sought from a continuum (a frequency, a time, a time constant, an exponent): how well they are known, and what
//! that does to everything else.

use nalgebra::DVector;
use rins_estimation::{Fit, Indefinite};
use rins_terms::TermInstance;

use crate::case::Case;
use crate::diagnosis::DiagnosisError;
use crate::proposal::candidates::Candidate;

/// A setting is moved that is off by more than this part of its sigma.
const OFF: f64 = 0.2;

/// How often settings are moved at most.
const MOST_MOVES: usize = 10;

/// A step that makes things worse is tried at this part of its length, ...
const LESS: f64 = 0.3;

/// ... unless it has come to less than this part of it.
const LEAST_PART: f64 = 0.2;

/// A setting that was sought, where the model is linear in it.
pub(crate) struct Sought {
    /// Which of the effects that were found.
    pub(crate) cause: usize,
    /// Which of its settings.
    pub(crate) place: usize,
    /// Its 1σ.
    pub(crate) sigma: f64,
    /// How far it is off.
    step: f64,
    /// Whether the run changes smoothly with it; not with the time of an event.
    is_smooth: bool,
    /// How far it moves the model's parameters, per unit of it, in SI units.
    shift: DVector<f64>,
}

impl Case<'_> {
    /// The fit with every sought setting where it fits best, and its uncertainty in the covariance of all parameters.
    pub(crate) fn sharpened(
        &self,
        present: Fit,
        found: &mut [TermInstance],
    ) -> Result<(Fit, Vec<Sought>), DiagnosisError> {
        let (mut present, sought) = self.at_their_best(present, found)?;
        for one in &sought {
            present = present.with_unknown(&(&one.shift * one.sigma));
        }
        Ok((present, sought))
    }

    /// The fit with every sought setting where it fits best, as if it were known.
    pub(crate) fn at_their_best(
        &self,
        mut present: Fit,
        found: &mut [TermInstance],
    ) -> Result<(Fit, Vec<Sought>), Indefinite> {
        let mut sought = self.sought(&present, found)?;
        let mut part = 1.0;
        for _ in 0..MOST_MOVES {
            let mut moved = found.to_vec();
            for one in sought.iter().filter(|one| one.is_off()) {
                let setting = &mut moved[one.cause].settings[one.place];
                let (low, high) = found[one.cause].term.settings[one.place].within;
                *setting = (*setting + part * one.step(*setting)).clamp(low, high);
            }
            if moved == found {
                break;
            }
            let fitted = self.fit_near(&present, &moved);
            // A step that makes things worse was too long to be linear.
            let better = |fit: &Fit| fit.log_likelihood > present.log_likelihood;
            match fitted.ok().filter(better) {
                Some(fitted) => {
                    present = fitted;
                    found.clone_from_slice(&moved);
                    sought = self.sought(&present, found)?;
                    part = 1.0;
                }
                None if part < LEAST_PART => break,
                None => part *= LESS,
            }
        }
        Ok((present, sought))
    }

    /// What the runs say of every setting that was sought for these effects, the last of the model in `present`.
    fn sought(&self, present: &Fit, found: &[TermInstance]) -> Result<Vec<Sought>, Indefinite> {
        let given = present.model().terms.len() - found.len();
        let mut list = Vec::new();
        let mut asked = Vec::new();
        for (cause, chosen) in found.iter().enumerate() {
            let Some((place, apart, sigma)) = self.continuum(present, chosen) else { continue };
            asked.push((cause, place, apart, sigma));
            for by in [-apart, apart] {
                let mut chosen = chosen.clone().estimated();
                chosen.settings[place] += by;
                list.push(Candidate { chosen, looks: 1.0, step: None, departs: None });
            }
        }
        if asked.is_empty() {
            return Ok(Vec::new());
        }
        let noises = std::slice::from_ref(&present.noise);
        let survey = self.survey(present, &list, noises)?;
        let sought = asked.into_iter().enumerate().filter_map(|(index, asked)| {
            let (cause, place, apart, sigma) = asked;
            let mut weights = Vec::new();
            let own = present.parameters.iter().filter(|e| e.parameter.term == given + cause);
            for estimate in own {
                for (side, sign) in [(0, -1.0), (1, 1.0)] {
                    let places =
                        &survey.of_candidate(2 * index + side)[estimate.parameter.parameter];
                    let of_run = places[estimate.run.unwrap_or_default().min(places.len() - 1)];
                    weights.push((of_run, sign * estimate.value / (2.0 * apart)));
                }
            }
            let slope = survey.along(&weights)?;
            let information = slope.information + sigma.powi(-2);
            Some(Sought {
                cause,
                place,
                sigma: information.sqrt().recip(),
                step: slope.score / information,
                is_smooth: found[cause].term.settings[place].kind.is_smooth(),
                shift: slope.shift,
            })
        });
        Ok(sought.collect())
    }

    /// The setting of an effect that comes from a continuum, how far apart its values are that tell a derivative, and
    /// how far it may be off before it is another effect.
    fn continuum(&self, present: &Fit, chosen: &TermInstance) -> Option<(usize, f64, f64)> {
        let (duration, epoch) = (self.duration(), present.linear[0].mean_epoch());
        let settings = chosen.term.settings.iter().zip(&chosen.settings).enumerate();
        settings.into_iter().find_map(|(place, (setting, &value))| {
            let step = setting.kind.derivative_step(value, duration, epoch)?;
            Some((place, step, setting.kind.prior(value, duration)?.sigma))
        })
    }
}

impl Sought {
    fn is_off(&self) -> bool {
        self.is_smooth && self.step.abs() > OFF * self.sigma
    }

    /// How far to move the setting from where it is: no further than to half of it, or twice.
    fn step(&self, from: f64) -> f64 {
        self.step.clamp(-0.5 * from.abs(), from.abs())
    }
}
