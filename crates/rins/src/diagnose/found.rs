//! What a diagnosis found, and what follows from it.

use std::time::Instant;

use anyhow::Context;
use nalgebra::{DMatrix, DVector};
use rins_design::{Confused, NextTest, next_test};
use rins_diagnosis::{
    Cause, DiagnosisError, FALSE_ALARMS, Limit, Overlay, Rival, Unexplained, diagnose,
    false_alarms, limits, same_in_all_runs, stuck, suppose,
};
use rins_estimation::{Alias, Estimate, Fit, Noise, Run};
use rins_imu::{ImuSpec, Seed};
use rins_inspection::Repeats;
use rins_terms::{Model, TermInstance, Unit};

use super::measured::Measured;
use super::testable::{Untestable, untestable};
use crate::calibrate::Certificate;
use crate::homogeneity::{HeldOutComparison, RunComparison};
use crate::preparation::{EstimationProblem, Prepared};
use crate::progress::Progress;

/// An amplitude beyond the largest usual one by more than this many of its sigmas is not plausible.
const BEYOND: f64 = 2.0;

/// A parameter is observed if its 1σ is less than this part of the 1σ of the data sheet.
const OBSERVED: f64 = 0.5;

/// An estimate was wrong that moves by so many sigmas of such moves by chance, and by its own sigma at least.
const MOVED: f64 = 3.0;

/// What is said of a run on the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Nothing significant is left over.
    Adequate,
    /// Each cause is distinguished from every other effect of the catalogue.
    Named,
    /// There are causes that this run cannot tell from others.
    Ambiguous,
    /// There is something that no effect of the catalogue explains.
    Unexplained,
}

/// A finished diagnosis with all that a reader is told of it.
#[derive(Debug)]
pub(crate) struct DiagnosisOutcome {
    pub(crate) verdict: Verdict,
    /// The causes, by the weight of their evidence.
    pub(crate) causes: Vec<Named>,
    /// What no effect explains, most significant first.
    pub(crate) unexplained: Vec<Unexplained>,
    /// What the causes gain on held-out data.
    pub(crate) gain: Measured,
    /// The same at the fastest rate, with what was found at slower ones, if it was asked.
    pub(crate) transfer: Option<Measured>,
    /// The estimates that were wrong without the causes, the most wrong first.
    pub(crate) shifts: Vec<Shift>,
    /// The effects of which the run could not have shown anything.
    pub(crate) untestable: Vec<Untestable>,
    /// The amplitudes that the run would have shown of what was not found.
    pub(crate) limits: Vec<Limit>,
    /// How often chance alone would have named something, if it was asked.
    pub(crate) by_chance: Option<ByChance>,
    /// What is left of each run, before and after.
    pub(crate) overlays: Vec<[Overlay; 2]>,
    /// The parameters of the sensors in each log by itself, if there are several.
    pub(crate) comparison: Option<RunComparison>,
    /// Those of the held-out run beside the estimate, if there is one.
    pub(crate) held_out: Option<HeldOutComparison>,
    /// The calibration with the extended model.
    pub(crate) certificate: Certificate,
    /// How long it took \[s\].
    pub(crate) seconds: f64,
}

/// What is asked of a diagnosis.
#[derive(Default)]
pub(crate) struct Request {
    /// The effects that are supposed to be there, if none are searched for.
    pub(crate) supposed: Option<Vec<TermInstance>>,
    /// The run on which the gain is measured, if it is another.
    pub(crate) held_out: Option<Prepared>,
    /// Whether it is measured at the fastest rate too.
    pub(crate) transfer: bool,
    /// How many runs are simulated to estimate the false alarm rate.
    pub(crate) bootstrap: Option<u32>,
}

/// How often chance alone names something.
#[derive(Debug)]
pub(crate) struct ByChance {
    pub(crate) draws: u32,
    /// In which share of them.
    pub(crate) share: f64,
}

/// An identified effect, with the significance and plausibility of its amplitude.
#[derive(Debug)]
pub(crate) struct Named {
    pub(crate) cause: Cause,
    /// How many sigmas its parameters are from zero, all together; where a setting was sought, as if it had been known.
    pub(crate) sigmas: f64,
    /// Whether an IMU, a table or a place like this may have it so large.
    pub(crate) plausible: bool,
    /// What would tell it from the likeliest of the others, if it is not told from all.
    pub(crate) next_test: Option<NextTest>,
    /// Why none could be looked for.
    pub(crate) no_next_test: Option<String>,
}

/// An estimate that moved when the causes joined the model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shift {
    /// Without the causes.
    pub(crate) before: Estimate,
    /// With them.
    pub(crate) after: Estimate,
}

impl Shift {
    /// By how many of the sigmas that it had claimed.
    pub(crate) fn sigmas(&self) -> f64 {
        (self.after.value - self.before.value) / self.before.sigma
    }

    /// Whether it moved by more than it would if the causes were not there, and by something that counts.
    ///
    /// With more parameters an estimate moves by chance too: with the variance that it gains (Hausman 1978).
    fn counts(&self) -> bool {
        let moved = (self.after.value - self.before.value).abs();
        let by_chance = (self.after.sigma.powi(2) - self.before.sigma.powi(2)).max(0.0).sqrt();
        moved > MOVED * by_chance && moved > self.before.sigma
    }
}

/// What is said of a hypothesis that has as many effects as the search allows.
const FULL: &str = "The search ended because the hypothesis has the largest number of effects that is tried. \
     Further effects may be hidden in the residual structure.";

impl DiagnosisOutcome {
    /// Diagnoses the runs of a case.
    pub(crate) fn of(
        mut case: EstimationProblem,
        asked: &Request,
        progress: &Progress,
    ) -> anyhow::Result<Self> {
        let started = Instant::now();
        let runs = case.given();
        let stage = progress.begin("estimating the model", None);
        let mut named: Vec<&str> = Vec::new();
        let (imu, knowledge) = (case.imu(), case.knowledge());
        let diagnosed = match &asked.supposed {
            Some(effects) => suppose(&runs, &case.model, effects, imu, knowledge),
            None => diagnose(&runs, &case.model, imu, knowledge, |id| {
                named.push(id);
                stage.at(&format!("found: {}", named.join(", ")));
            }),
        };
        let mut diagnosis = diagnosed.with_context(|| case.names())?;
        if diagnosis.is_full() {
            case.remarks.push(FULL.into());
        }
        for (run, prepared) in case.runs.iter().enumerate() {
            let all = |repeats: &Repeats| prepared.run.recording.len() + repeats.samples;
            let cause = prepared.repeats.map(|repeats| stuck(&repeats, run, all(&repeats)));
            diagnosis.causes.splice(0..0, cause);
        }
        stage.at("measuring the gain");
        let fits = (&diagnosis.before, &diagnosis.after);
        let gain = Measured::of(&case, asked.held_out.as_ref(), fits);
        let transfer = asked.transfer.then(|| Measured::at_the_fastest_rate(&case, fits));
        drop(stage);
        let (imu, axes) = (*case.imu(), diagnosis.after.axes);
        let causes: Vec<Named> = diagnosis
            .causes
            .into_iter()
            .map(|cause| {
                let next = cause.rivals.first().map_or(Ok(None), |rival| {
                    let run = (&runs[0], &diagnosis.after.noise[0]);
                    separating_test(run, &imu, &case.model, (&cause, rival))
                });
                let mut named = Named::of(cause, &diagnosis.after, &imu, next);
                named.show_sums(&diagnosis.after, &imu);
                named.cause = named.cause.along_own(&axes);
                named
            })
            .collect();
        let verdict = if !diagnosis.unexplained.is_empty() {
            Verdict::Unexplained
        } else if causes.iter().all(|named| named.cause.ln_p > FALSE_ALARMS.ln()) {
            // What was supposed is there whether it explains anything or not.
            Verdict::Adequate
        } else if causes.iter().all(|named| named.cause.rivals.is_empty()) {
            Verdict::Named
        } else {
            Verdict::Ambiguous
        };
        let shifts = shifts([&diagnosis.before, &diagnosis.after]);
        let untestable = untestable(&runs, &case.model, &diagnosis.not_testable);
        let limits = limits(&runs, &diagnosis.after, &imu).with_context(|| case.names())?;
        let by_chance = asked.bootstrap.map(|draws| {
            let stage = progress.begin("simulated runs", usize::try_from(draws).ok());
            let of = (&imu, case.knowledge());
            let seeds = (draws, Seed::new(1));
            let alarms = false_alarms(&runs, &diagnosis.after, of, seeds, |done| stage.done(done))?;
            Ok::<_, DiagnosisError>(ByChance { draws, share: f64::from(alarms) / f64::from(draws) })
        });
        let by_chance = by_chance.transpose().with_context(|| case.names())?;
        let left = |place| {
            [&diagnosis.before, &diagnosis.after].map(|fit| Overlay::of(&runs[place], fit, place))
        };
        let overlays = (0..runs.len()).map(left).collect();
        let comparison = RunComparison::of_logs(&case, progress);
        let held_out = asked.held_out.as_ref().and_then(|held_out| {
            HeldOutComparison::of(&case, &diagnosis.after, held_out, comparison.as_ref())
        });
        let mut certificate = Certificate::with(case, diagnosis.after)?;
        certificate.besides = causes.iter().filter_map(|named| no_signal(&named.cause)).collect();
        let seconds = started.elapsed().as_secs_f64();
        let unexplained = diagnosis.unexplained.iter().map(|one| one.along_own(&axes)).collect();
        Ok(Self {
            verdict,
            causes,
            unexplained,
            gain,
            transfer,
            shifts,
            untestable,
            limits,
            by_chance,
            overlays,
            comparison,
            held_out,
            certificate,
            seconds,
        })
    }

    /// A delay in samples of the first run, in which a convention of time stamps names itself.
    pub(crate) fn in_samples(&self, estimate: &Estimate) -> Option<f64> {
        let interval = self.certificate.runs[0].prepared.run.recording.increments[0].interval;
        (estimate.parameter.unit == Unit::MILLISECOND).then(|| estimate.value / interval)
    }

    /// What the diagnosis is called.
    pub(crate) fn title(&self) -> String {
        let runs = &self.certificate.runs;
        let names: Vec<&str> = runs.iter().map(|run| run.prepared.name.as_str()).collect();
        format!("Diagnosis of {}", names.join(", "))
    }
}

impl Named {
    /// Of an error that differs between runs, shows what it is in each run: its deviation is known but for what is the same in all runs,
    /// the whole is known.
    fn show_sums(&mut self, after: &Fit, imu: &ImuSpec) {
        let Some(same) = same_in_all_runs(self.cause.term) else { return };
        let whole = |estimate: &Estimate| {
            let parameter = &self.cause.term.parameters[estimate.parameter.parameter];
            let common = format!("{}.{}", same.id, parameter.name);
            let common = after.parameters.iter().position(|one| one.parameter.id == common)?;
            let own = after.parameters.iter().position(|one| {
                one.parameter.id == estimate.parameter.id && one.run == estimate.run
            })?;
            let alias = Alias { unknown: common, coefficient: 1.0, exactly: false };
            let (value, sigma) = after.sum(own, &[alias]);
            let is_observed = sigma < OBSERVED * parameter.sigma(imu);
            is_observed.then(|| Estimate { value, sigma, ..estimate.clone() })
        };
        let wholes: Vec<Estimate> = self.cause.parameters.iter().filter_map(whole).collect();
        if !wholes.is_empty() {
            self.cause.parameters = wholes;
        }
    }

    /// A test that cannot be proposed takes nothing from what was found.
    fn of(
        cause: Cause,
        after: &Fit,
        imu: &ImuSpec,
        next: anyhow::Result<Option<NextTest>>,
    ) -> Self {
        // What is not known of a setting that was sought says nothing against there being an effect.
        let sought = if cause.sought.is_some() { (2.0 * cause.gain).sqrt() } else { 0.0 };
        let sigmas = distance(&cause.parameters, after).max(sought);
        let plausible = cause.parameters.iter().all(|estimate| {
            let parameter = &cause.term.parameters[estimate.parameter.parameter];
            estimate.value.abs() - BEYOND * estimate.sigma <= parameter.range(imu).1
        });
        let (next_test, no_next_test) = match next {
            Ok(test) => (test, None),
            Err(why) => (None, Some(format!("{why:#}"))),
        };
        Self { cause, sigmas, plausible, next_test, no_next_test }
    }
}

/// A cause as a term with the values that were found.
fn with_values(cause: &Cause) -> TermInstance {
    let mut chosen = TermInstance::new(cause.term);
    chosen.settings.clone_from(&cause.settings);
    for estimate in &cause.parameters {
        chosen.values[estimate.parameter.parameter] = estimate.value;
    }
    chosen
}

/// The same, if it is noise, or what a logger does.
fn no_signal(cause: &Cause) -> Option<TermInstance> {
    (!cause.term.is_signal()).then(|| with_values(cause))
}

/// The test that would separate a cause from an alternative.
fn separating_test(
    run: (&Run, &Noise),
    imu: &ImuSpec,
    model: &Model,
    (cause, rival): (&Cause, &Rival),
) -> anyhow::Result<Option<NextTest>> {
    let found = with_values(cause);
    let mut alternative = TermInstance::new(rival.term);
    alternative.settings.clone_from(&rival.settings);
    let pair = Confused { found: &found, alternative: &alternative };
    Ok(next_test(run, imu, model, pair)?)
}

/// How many sigmas these of a fit's parameters are from zero, all together.
fn distance(parameters: &[Estimate], fit: &Fit) -> f64 {
    let places: Vec<usize> = parameters
        .iter()
        .filter_map(|own| fit.parameters.iter().position(|estimate| same(own, estimate)))
        .collect();
    let n = places.len();
    if n < parameters.len() {
        // The strength of a noise is found beside the fit.
        return parameters.iter().map(|own| (own.value / own.sigma).powi(2)).sum::<f64>().sqrt();
    }
    let covariance =
        DMatrix::from_fn(n, n, |row, column| fit.covariance[(places[row], places[column])]);
    let values = DVector::from_iterator(n, places.iter().map(|&p| fit.parameters[p].value));
    covariance.cholesky().map_or(0.0, |factor| values.dot(&factor.solve(&values)).max(0.0).sqrt())
}

fn same(a: &Estimate, b: &Estimate) -> bool {
    a.parameter.id == b.parameter.id && a.run == b.run
}

/// The estimates that were wrong, along the sensors' own axes, most of their sigmas first.
fn shifts(of: [&Fit; 2]) -> Vec<Shift> {
    let mut shifts: Vec<Shift> = of[0]
        .parameters
        .iter()
        .filter_map(|before| {
            let after = of[1].parameters.iter().find(|after| same(before, after))?;
            let shift = Shift { before: before.clone(), after: after.clone() };
            shift.counts().then(|| {
                let own = |estimate: &Estimate, fit: &Fit| {
                    let chosen = &fit.model().terms[estimate.parameter.term];
                    estimate.along_own(chosen, &fit.axes)
                };
                Shift { before: own(before, of[0]), after: own(after, of[1]) }
            })
        })
        .collect();
    shifts.sort_by(|a, b| b.sigmas().abs().total_cmp(&a.sigmas().abs()));
    shifts
}
