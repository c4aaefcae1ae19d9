//! Slow waves that are no sines: steps of one height that undo a drift, and multiples of a line that do not stand out one by one.

use rins_bayes::ln_tail;
use rins_estimation::{Estimate, Fit, Indefinite, NoiseKnowledge};
use rins_terms::{SettingKind, Term, TermInstance, catalogue};

use crate::case::{Case, gained};
use crate::criticism::noise::triad;
use crate::criticism::periodic::{is_line, strongest, waveforms};
use crate::criticism::structure::Structure;
use crate::criticism::unexplained::{Unexplained, worst};
use crate::diagnosis::FALSE_ALARMS;
use crate::generic::disturbance::CHANNELS;
use crate::proposal::candidates::Candidate;
use crate::verdict::cause::Cause;

/// Which of the multiples a line that was found may be: the frequency of the wave itself, or the second.
const WHICH: [u32; 2] = [1, 2];

/// The parameters of a line that are of either triad.
const OF_TRIAD: [[&str; 2]; 2] = [["gyro_cos", "gyro_sin"], ["accel_cos", "accel_sin"]];

/// What a bias of either triad may do between two steps, beside walking at random.
const DRIFTS: [[&Term; 3]; 2] = [
    [&catalogue::GYRO_BIAS_RAMP, &catalogue::GYRO_WARMUP, &catalogue::GYRO_THERMAL_BIAS],
    [&catalogue::ACCEL_BIAS_RAMP, &catalogue::ACCEL_WARMUP, &catalogue::ACCEL_THERMAL_BIAS],
];

/// Two steps are of one height if the squares of their differences in sigmas are no more than this: one pair in a hundred is not.
const ALIKE: f64 = 11.3;

/// Of one that is known to less than so many sigmas, that says little.
const KNOWN: f64 = 6.0;

/// So many multiples of a frequency are looked at together.
const MULTIPLES: u32 = 6;

impl Case<'_> {
    /// What comes back and is no sine, each channel once; multiples of lines that do not stand out are looked for only
    /// where nothing else is left that `is_described`.
    pub(crate) fn waves(
        &self,
        after: &Fit,
        causes: &[Cause],
        is_described: bool,
    ) -> Result<Vec<Unexplained>, Indefinite> {
        let mut all = waveforms(after, causes);
        all.extend(self.sawtooths(after, causes));
        if !is_described {
            all.extend(self.multiples(after, causes)?);
        }
        let mut waves: Vec<Unexplained> = Vec::new();
        for wave in all.into_iter().filter(|wave| wave.ln_p < FALSE_ALARMS.ln()) {
            if waves.iter().all(|one| (one.run, one.channel) != (wave.run, wave.channel)) {
                waves.push(wave);
            }
        }
        Ok(waves)
    }

    /// Steps of a triad that are of one height and one sense while its biases drift otherwise: a wave that rises slowly and falls
    /// at once.
    fn sawtooths(&self, after: &Fit, causes: &[Cause]) -> Vec<Unexplained> {
        let drifts = |which: usize| {
            let walk = |mut of| triad(&mut of, which).walk;
            let drifts = |cause: &Cause| DRIFTS[which].iter().any(|drift| drift.is(cause.term));
            walk(after.noise[0].imu) > walk(self.sheet) || causes.iter().any(drifts)
        };
        let of_triad = |which: usize| {
            let term = [&catalogue::GYRO_BIAS_STEP, &catalogue::ACCEL_BIAS_STEP][which];
            let mut steps = causes.iter().filter(|cause| cause.term.is(term));
            let (one, other) = (steps.next()?, steps.next()?);
            are_alike(&one.parameters, &other.parameters).then_some(())?;
            let size = |estimate: &&Estimate| (estimate.value / estimate.sigma).abs();
            let largest = one.parameters.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
            let time = term.setting(SettingKind::Time)?;
            let period = (one.settings[time] - other.settings[time]).abs();
            Some(Unexplained {
                run: largest.run.unwrap_or_default(),
                channel: CHANNELS[3 * which + largest.parameter.parameter],
                structure: Structure::Waveform(1.0 / period),
                of: None,
                ln_p: one.ln_p.max(other.ln_p),
                amplitude: Some((largest.value.abs(), largest.parameter.unit)),
                worst: worst(after, 2.0 * (one.gain + other.gain)),
            })
        };
        (0..DRIFTS.len()).filter(|&which| drifts(which)).filter_map(of_triad).collect()
    }

    /// Lines of which multiples are there too, or which are the second multiple of something: it comes back, and is no sine.
    fn multiples(&self, after: &Fit, causes: &[Cause]) -> Result<Vec<Unexplained>, Indefinite> {
        let lines: Vec<&Cause> = causes.iter().filter(|cause| is_line(cause)).collect();
        let mut found = Vec::new();
        for line in &lines {
            for own in WHICH {
                found.extend(self.multiples_of(after, line, (own, lines.len()))?);
            }
        }
        found.sort_by(|a: &Unexplained, b| a.ln_p.total_cmp(&b.ln_p));
        Ok(found)
    }

    /// The same of one of so many `lines`, if it is the `own` multiple.
    fn multiples_of(
        &self,
        after: &Fit,
        line: &Cause,
        (own, lines): (u32, usize),
    ) -> Result<Option<Unexplained>, Indefinite> {
        let Some((channel, estimate, height)) = strongest(line) else { return Ok(None) };
        let run = estimate.run.unwrap_or_default();
        let frequency = line.settings[0] / f64::from(own);
        let shown = 0.5 / after.linear[run].mean_epoch();
        let multiples = (1..=MULTIPLES).filter(|times| *times != own);
        let triad = estimate.parameter.parameter / 2;
        let list: Vec<Candidate> = multiples
            .map(|times| f64::from(times) * frequency)
            .filter(|multiple| *multiple < shown)
            .map(|multiple| {
                let mut chosen = TermInstance::new(line.term).estimating(&OF_TRIAD[triad]);
                chosen.settings.clone_from(&line.settings);
                chosen.settings[0] = multiple;
                Candidate { chosen, looks: 1.0, step: None, departs: None }
            })
            .collect();
        if list.is_empty() {
            return Ok(None);
        }
        let survey = self.survey(after, &list, &self.noises(after))?;
        let places: Vec<usize> =
            (0..list.len()).flat_map(|candidate| survey.of_candidate(candidate).concat()).collect();
        let (statistic, dof) = survey.largest_statistic(&places);
        if dof == 0 {
            return Ok(None);
        }
        let tests = ((WHICH.len() * lines) as f64).ln();
        let mut ln_p = ln_tail(statistic, dof) + tests;
        if let NoiseKnowledge::Likely(_) = self.knowledge
            && ln_p < FALSE_ALARMS.ln()
        {
            // What passes for multiples may be noise, which is found anew beside them.
            let mut model = self.causes_in(after).to_vec();
            model.extend(list.into_iter().map(|one| one.chosen));
            let first = after.model().terms.len();
            let Ok(with) = self.fit_near(after, &model) else { return Ok(None) };
            let (gained, dof) = gained(after, &with, first);
            ln_p = ln_tail(gained, dof) + tests;
        }
        Ok(Some(Unexplained {
            run,
            channel,
            structure: Structure::Waveform(frequency),
            of: None,
            ln_p,
            amplitude: Some((height, estimate.parameter.unit)),
            worst: worst(after, 2.0 * line.gain + statistic),
        }))
    }
}

/// Whether two steps are of one height and one sense.
fn are_alike(one: &[Estimate], other: &[Estimate]) -> bool {
    let square = |of: &[Estimate]| of.iter().map(|e| (e.value / e.sigma).powi(2)).sum::<f64>();
    let pairs = || one.iter().zip(other);
    let apart: f64 = pairs()
        .map(|(a, b)| (a.value - b.value).powi(2) / (a.sigma.powi(2) + b.sigma.powi(2)))
        .sum();
    one.len() == other.len() && apart < ALIKE && square(one).min(square(other)) > KNOWN * KNOWN
}
