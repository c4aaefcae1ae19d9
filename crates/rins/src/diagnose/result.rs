//! A diagnosis, for a machine.

use std::collections::BTreeMap;

use rins_diagnosis::{FALSE_ALARMS, Unexplained, same_in_all_runs};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::found::{DiagnosisOutcome, Named, Shift, Verdict};
use super::measured::GainResult;
use super::structure::{size_in_words, structure_in_words};
use crate::basis::BasisResult;
use crate::calibrate::{DepartureResult, NoiseResult, departures};
use crate::consistency::ConsistencyResult;
use crate::homogeneity::{HeldOutResult, HomogeneityResult, RunComparison, VariationResult};
use crate::settings::settings_in_words;

/// The result of `rins diagnose`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DiagnoseResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `diagnose`.
    pub command: String,
    /// The rig file of the first run.
    pub rig: String,
    /// The rig files of all runs.
    pub rigs: Vec<String>,
    /// The model that the runs were taken to follow.
    pub baseline: String,
    /// `adequate`, `named`, `ambiguous` or `unexplained`.
    pub verdict: String,
    /// The causes, by the weight of their evidence.
    pub causes: Vec<CauseResult>,
    /// Residual structure that no effect of the catalogue explains, the most significant first.
    pub unexplained: Vec<UnexplainedResult>,
    /// What the causes gain on held-out data.
    pub gain: GainResult,
    /// The same at the fastest rate, with what was found at slower ones, if it was asked.
    pub transfer: Option<GainResult>,
    /// The estimates that were biased without the causes, the most biased first.
    pub shifts: Vec<ShiftResult>,
    /// The effects that these runs cannot show.
    pub not_testable: Vec<UntestableResult>,
    /// The false alarm rate in simulated runs, if it was asked.
    pub false_alarms: Option<FalseAlarmsResult>,
    /// The noise.
    pub noise: NoiseResult,
    /// What the innovations say of the extended model.
    pub consistency: ConsistencyResult,
    /// What lies more than four sigmas off what was stated beforehand, with the extended model, the furthest first.
    pub prior_consistency: Vec<DepartureResult>,
    /// Of several runs, the test of each parameter of the sensors whether it is the same in all: each run was estimated by itself with the
    /// given model.
    #[serde(default)]
    pub homogeneity: Vec<HomogeneityResult>,
    /// How parameters vary between the runs, the most significant first.
    #[serde(default)]
    pub variations: Vec<VariationResult>,
    /// The held-out run beside the estimate, if one was given and can be estimated by itself.
    #[serde(default)]
    pub held_out: Option<HeldOutResult>,
    /// The file of the extended model among the files.
    pub model: String,
    /// How long it took \[s\].
    pub seconds: f64,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// A cause: an effect that the model lacks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CauseResult {
    /// The id of the effect in the catalogue.
    pub effect: String,
    /// Its name.
    pub name: String,
    /// Its physical cause.
    pub meaning: String,
    /// Its equation.
    pub equation: String,
    /// Its settings by name.
    pub settings: BTreeMap<String, SettingResult>,
    /// The same in words.
    pub settings_in_words: String,
    /// The family-wise p-value over the catalogue; zero where it is too small for a number.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// `runs` if the effect is an error of the sensors that differs between runs; null otherwise.
    #[serde(default)]
    pub across: Option<String>,
    /// By how much the log-likelihood rises \[nats\].
    pub delta_log_likelihood: f64,
    /// How many directions of its parameters the runs show.
    pub dof: usize,
    /// How many sigmas its parameters are from zero, all together.
    pub sigmas: f64,
    /// Whether such an instrument may have it so large.
    pub plausible: bool,
    /// Its parameters.
    pub parameters: Vec<CauseParameterResult>,
    /// The posterior probability that it is this effect and none of its alternatives.
    pub probability: f64,
    /// The ids of the effects from which these runs do not distinguish it.
    pub cannot_tell_from: Vec<String>,
    /// These with their odds.
    pub alternatives: Vec<AlternativeResult>,
    /// What would distinguish it, by the catalogue.
    pub tell_apart_by: String,
    /// The run that would distinguish it from the likeliest of these.
    pub next_test: Option<NextTestResult>,
    /// Why none could be proposed.
    pub no_next_test: Option<String>,
}

/// A setting of an effect, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SettingResult {
    /// The value.
    pub value: f64,
    /// Its 1σ, if it was estimated.
    pub sigma: Option<f64>,
    /// The unit.
    pub unit: String,
}

/// A parameter of a cause, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CauseParameterResult {
    /// Its id.
    pub id: String,
    /// The run to which it belongs, from 1; null if it belongs to all.
    pub run: Option<usize>,
    /// The value.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
    /// The unit.
    pub unit: String,
    /// The typical range of its magnitude.
    pub typical_range: [f64; 2],
    /// The same in samples, if it is a time.
    pub samples: Option<f64>,
}

/// An alternative to a cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AlternativeResult {
    /// The id of the effect.
    pub effect: String,
    /// Its name.
    pub name: String,
    /// The logarithm of its posterior odds against the cause.
    pub ln_posterior_odds: f64,
    /// Its posterior probability.
    pub probability: f64,
}

/// The run that would distinguish a cause from an alternative.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NextTestResult {
    /// What the table does, and for how long.
    pub schedule: String,
    /// The id of the alternative.
    pub from: String,
    /// By how many sigmas the two differ then.
    pub sigmas: f64,
}

/// Residual structure that no effect of the catalogue explains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UnexplainedResult {
    /// The run, from 1.
    pub run: usize,
    /// The channel.
    pub channel: String,
    /// What it looks like.
    pub structure: String,
    /// The effect that is not the same all along, if that is what was found.
    pub effect: Option<String>,
    /// The p-value of anything like it; zero where it is too small for a number.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// How large it is, with its unit, if it is a signal.
    pub amplitude: Option<String>,
    /// By how much it may bias the gyro errors along the spin axis at worst.
    pub worst: Vec<WorstResult>,
}

/// By how much a parameter may be biased at worst, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorstResult {
    /// The parameter.
    pub id: String,
    /// By how much.
    pub value: f64,
    /// The unit.
    pub unit: String,
}

/// An estimate that was biased without the causes, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ShiftResult {
    /// The parameter.
    pub id: String,
    /// The run to which it belongs, from 1; null if it belongs to all.
    pub run: Option<usize>,
    /// The estimate without the causes.
    pub before: f64,
    /// The estimate with them.
    pub after: f64,
    /// The unit.
    pub unit: String,
    /// The change in sigmas of the estimate before.
    pub sigmas: f64,
}

/// An effect that these runs cannot show.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UntestableResult {
    /// Its id.
    pub effect: String,
    /// Its name.
    pub name: String,
    /// What the runs would have to offer.
    pub why: String,
}

/// The false alarm rate in simulated runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FalseAlarmsResult {
    /// The number of simulated runs.
    pub draws: u32,
    /// The fraction of them in which an effect or residual structure was reported.
    pub rate: f64,
    /// The rate that is allowed.
    pub allowed: f64,
}

/// What the comparison of the runs says, if there are several.
fn of_comparison<T>(found: &DiagnosisOutcome, of: fn(&RunComparison) -> Vec<T>) -> Vec<T> {
    found.comparison.as_ref().map(of).unwrap_or_default()
}

impl DiagnoseResult {
    /// The whole of a diagnosis.
    pub(super) fn of(found: &DiagnosisOutcome, basis: BasisResult) -> Self {
        let certificate = &found.certificate;
        let names: Vec<String> =
            certificate.runs.iter().map(|run| run.prepared.name.clone()).collect();
        let not_testable = found.untestable.iter().map(|one| UntestableResult {
            effect: one.term.id.into(),
            name: one.term.name.into(),
            why: one.why.clone(),
        });
        let verdict = match found.verdict {
            Verdict::Adequate => "adequate",
            Verdict::Named => "named",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Unexplained => "unexplained",
        };
        Self {
            schema: crate::SCHEMA,
            command: "diagnose".into(),
            rig: names[0].clone(),
            rigs: names,
            baseline: certificate.model.clone(),
            verdict: verdict.into(),
            causes: found.causes.iter().map(|named| CauseResult::of(found, named)).collect(),
            unexplained: found
                .unexplained
                .iter()
                .map(|one| UnexplainedResult::of(found, one))
                .collect(),
            gain: (&found.gain).into(),
            transfer: found.transfer.as_ref().map(GainResult::from),
            shifts: found.shifts.iter().map(ShiftResult::from).collect(),
            not_testable: not_testable.collect(),
            false_alarms: found.by_chance.as_ref().map(|chance| FalseAlarmsResult {
                draws: chance.draws,
                rate: chance.share,
                allowed: FALSE_ALARMS,
            }),
            homogeneity: of_comparison(found, HomogeneityResult::all),
            variations: of_comparison(found, VariationResult::all),
            held_out: found.held_out.as_ref().map(HeldOutResult::from),
            noise: certificate.into(),
            consistency: (&certificate.consistency).into(),
            prior_consistency: departures(certificate),
            model: "model.toml".into(),
            seconds: found.seconds,
            notes: certificate.remarks.clone(),
            basis,
        }
    }
}

impl CauseResult {
    fn of(found: &DiagnosisOutcome, named: &Named) -> Self {
        let cause = &named.cause;
        let imu = &found.certificate.runs[0].prepared.imu;
        let parameters = cause.parameters.iter().map(|estimate| {
            let unit = estimate.parameter.unit;
            let (low, high) = cause.term.parameters[estimate.parameter.parameter].range(imu);
            CauseParameterResult {
                id: estimate.parameter.id.clone(),
                run: estimate.run.map(|run| run + 1),
                value: estimate.value / unit.factor,
                sigma: estimate.sigma / unit.factor,
                unit: unit.symbol.into(),
                typical_range: [low / unit.factor, high / unit.factor],
                samples: found.in_samples(estimate),
            }
        });
        let settings = cause.term.settings.iter().zip(&cause.settings).enumerate();
        let settings = settings.map(|(place, (setting, value))| {
            let unit = setting.unit;
            let estimated = cause.sought.filter(|(of, _)| *of == place);
            let result = SettingResult {
                value: value / unit.factor,
                sigma: estimated.map(|(_, sigma)| sigma / unit.factor),
                unit: unit.symbol.into(),
            };
            (setting.name.to_owned(), result)
        });
        let rivals = cause.rivals.iter().map(|rival| AlternativeResult {
            effect: rival.term.id.into(),
            name: rival.term.name.into(),
            ln_posterior_odds: rival.odds,
            probability: cause.probability_of(rival),
        });
        Self {
            effect: cause.term.id.into(),
            name: cause.term.name.into(),
            meaning: cause.term.cause.into(),
            equation: cause.term.equation.into(),
            across: same_in_all_runs(cause.term).map(|_| "runs".into()),
            settings: settings.collect(),
            settings_in_words: settings_in_words(cause.term, &cause.settings, cause.sought),
            p_value: cause.ln_p.exp(),
            ln_p: cause.ln_p,
            delta_log_likelihood: cause.gain,
            dof: cause.dof,
            sigmas: named.sigmas,
            plausible: named.plausible,
            probability: cause.probability(),
            parameters: parameters.collect(),
            cannot_tell_from: cause.rivals.iter().map(|rival| rival.term.id.into()).collect(),
            alternatives: rivals.collect(),
            tell_apart_by: cause.term.told_apart_by.into(),
            next_test: named.next_test.as_ref().map(|test| NextTestResult {
                schedule: test.words.clone(),
                from: test.from.id.into(),
                sigmas: test.sigmas,
            }),
            no_next_test: named.no_next_test.clone(),
        }
    }
}

impl UnexplainedResult {
    fn of(found: &DiagnosisOutcome, one: &Unexplained) -> Self {
        let fit = &found.certificate.fit;
        let worst = one.worst.iter().filter_map(|(id, value)| {
            let unit = fit.parameter(id)?.parameter.unit;
            let value = value / unit.factor;
            Some(WorstResult { id: id.clone(), value, unit: unit.symbol.into() })
        });
        Self {
            run: one.run + 1,
            channel: one.channel.into(),
            structure: structure_in_words(one),
            effect: one.of.map(Into::into),
            p_value: one.ln_p.exp(),
            ln_p: one.ln_p,
            amplitude: size_in_words(one),
            worst: worst.collect(),
        }
    }
}

impl From<&Shift> for ShiftResult {
    fn from(shift: &Shift) -> Self {
        let unit = shift.before.parameter.unit;
        Self {
            id: shift.before.parameter.id.clone(),
            run: shift.before.run.map(|run| run + 1),
            before: shift.before.value / unit.factor,
            after: shift.after.value / unit.factor,
            unit: unit.symbol.into(),
            sigmas: shift.sigmas(),
        }
    }
}
