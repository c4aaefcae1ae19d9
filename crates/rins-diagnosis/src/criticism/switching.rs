//! Biases that switch between two levels, which pass for flicker as long as nobody asks.

use rayon::prelude::*;
use rins_estimation::{Evidence, Fit, Indefinite};
use rins_terms::{Term, catalogue};

use crate::case::Case;
use crate::criticism::levels::{Parts, Path};
use crate::criticism::noise::triad;
use crate::criticism::structure::Structure;
use crate::criticism::unexplained::{Unexplained, worst};
use crate::diagnosis::FALSE_ALARMS;
use crate::evidence::survey::Survey;
use crate::generic::disturbance::CHANNELS;

/// The biases that may switch, of three channels each.
static BIASES: [&Term; 2] = [&catalogue::GYRO_BIAS, &catalogue::ACCEL_BIAS];

/// How many channels these are.
const SWITCHES: usize = 6;

/// Into how many parts a run is divided, in each of which a bias is on one level.
const PARTS: usize = 96;

/// What is left of flicker, as parts of what was found, if it was a bias that switches.
const WITHOUT: [f64; 4] = [1.0, 0.5, 0.25, 0.02];

/// Of how many epochs a part is at least.
const LEAST_EPOCHS: usize = 2;

impl Case<'_> {
    /// Biases that switch between two levels, where that explains more than the flicker that was found.
    ///
    /// Whether it does is asked of the filter, with the flicker that was found and with less: what it says of a bias that may be
    /// another in each part of the run holds for every path.
    ///
    /// `explained` is what the logarithm of the odds has to exceed: that of the effects which may have passed for it.
    pub(crate) fn switching(
        &self,
        fit: &Fit,
        explained: f64,
    ) -> Result<Vec<Unexplained>, Indefinite> {
        let places: Vec<(usize, usize)> = (0..self.runs.len())
            .flat_map(|run| (0..SWITCHES).map(move |channel| (run, channel)))
            .collect();
        let each = places.into_par_iter().map(|(run, channel)| self.switches(fit, run, channel));
        let found: Result<Vec<_>, Indefinite> = each.collect();
        let over = |one: &Unexplained| one.ln_p < FALSE_ALARMS.ln() - explained;
        Ok(found?.into_iter().flatten().filter(over).collect())
    }

    /// The bias of one channel, if it may be one that switches.
    fn switches(
        &self,
        fit: &Fit,
        run: usize,
        channel: usize,
    ) -> Result<Option<Unexplained>, Indefinite> {
        let linear = &fit.linear[run];
        let known = self.of_run(fit, run);
        let own = known.iter().position(|estimate| {
            let (term, parameter) = (estimate.parameter.term, estimate.parameter.parameter);
            fit.models[run].terms[term].term.is(BIASES[channel / 3]) && parameter == channel % 3
        });
        let epochs = linear.ends().len();
        let parts = PARTS.min(epochs / LEAST_EPOCHS);
        let Some(own) = own.filter(|_| parts > 1) else { return Ok(None) };
        let part_of: Vec<usize> = (0..epochs).map(|epoch| 1 + epoch * parts / epochs).collect();
        let apart = linear.in_groups(&[own], &part_of, parts);
        let mut without = f64::NEG_INFINITY;
        let mut best: Option<(f64, Path)> = None;
        for part in WITHOUT {
            let mut noise = fit.noise[run];
            let flicker = &mut triad(&mut noise.imu, channel / 3).flicker;
            if part < 1.0 && *flicker == 0.0 {
                break;
            }
            *flicker *= part;
            // Each part in units of the prior's sigma of the bias itself.
            let scales = std::iter::repeat_n(known[own].parameter.sigma, parts);
            let survey = Survey::of_evidence(&Evidence::of(&apart, &noise)?, &known, scales);
            let Some(left) = survey.left(0, &[], &[]) else { continue };
            let parts = Parts { information: left.all(), score: left.score };
            without = without.max(left.log_likelihood);
            if let Some(path) = parts.path() {
                let with = left.log_likelihood + path.odds();
                if best.as_ref().is_none_or(|(most, _)| with > *most) {
                    best = Some((with, path));
                }
            }
        }
        let tests = (self.runs.len() * SWITCHES) as f64;
        Ok(best.map(|(with, path)| {
            let parameter = &known[own].parameter;
            Unexplained {
                run,
                channel: CHANNELS[channel],
                structure: Structure::Switching(path.switches),
                of: None,
                ln_p: tests.ln() - (with - without),
                amplitude: Some((path.height.abs() * parameter.sigma, parameter.unit)),
                worst: worst(fit, path.statistic),
            }
        }))
    }
}
