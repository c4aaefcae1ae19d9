//! A diagnosis for a machine.

use rins_diagnosis::{FALSE_ALARMS, Unexplained};
use rins_estimation::Estimate;
use serde_json::{Map, Value, json};

use crate::commands::calibrate::{consistency_json, noise_json};
use crate::commands::diagnose::{Found, Measured, Named, Verdict};
use crate::view::{settings_in_words, size_in_words, structure_in_words};

/// The whole of a diagnosis.
pub(super) fn diagnosis(found: &Found) -> Value {
    let certificate = &found.certificate;
    let names: Vec<&str> = certificate.runs.iter().map(|run| run.prepared.name.as_str()).collect();
    let causes: Vec<Value> = found.causes.iter().map(|named| cause(found, named)).collect();
    let shifts: Vec<Value> = found
        .shifts
        .iter()
        .map(|shift| {
            let factor = shift.before.parameter.unit.factor;
            json!({
                "id": shift.before.parameter.id,
                "run": shift.before.run.map(|run| run + 1),
                "before": shift.before.value / factor,
                "after": shift.after.value / factor,
                "unit": shift.before.parameter.unit.symbol,
                "sigmas": shift.sigmas(),
            })
        })
        .collect();
    let untestable: Vec<Value> = found
        .untestable
        .iter()
        .map(|one| json!({"effect": one.term.id, "name": one.term.name, "why": one.why}))
        .collect();
    json!({
        "schema": 1,
        "command": "diagnose",
        "rig": names[0],
        "rigs": names,
        "baseline": certificate.model,
        "verdict": match found.verdict {
            Verdict::Adequate => "adequate",
            Verdict::Named => "named",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Unexplained => "unexplained",
        },
        "causes": causes,
        "unexplained": found.unexplained.iter().map(|one| unexplained(found, one)).collect::<Vec<_>>(),
        "gain": found.gain.json(),
        "transfer": found.transfer.as_ref().map(Measured::json),
        "shifts": shifts,
        "not_testable": untestable,
        "chance": found.by_chance.as_ref().map(|chance| json!({
            "draws": chance.draws,
            "named": chance.share,
            "allowed": FALSE_ALARMS,
        })),
        "noise": noise_json(certificate),
        "consistency": consistency_json(&certificate.consistency),
        "model": "model.toml",
        "seconds": found.seconds,
        "notes": certificate.remarks,
    })
}

fn cause(found: &Found, named: &Named) -> Value {
    let cause = &named.cause;
    let imu = &found.certificate.runs[0].prepared.imu;
    let parameters: Vec<Value> = cause
        .parameters
        .iter()
        .map(|estimate| {
            let unit = estimate.parameter.unit;
            let (low, high) = cause.term.parameters[estimate.parameter.parameter].range(imu);
            let mut value = value(estimate);
            value["usual"] = json!([low / unit.factor, high / unit.factor]);
            value["samples"] = found.in_samples(estimate).into();
            value
        })
        .collect();
    let rivals: Vec<Value> = cause
        .rivals
        .iter()
        .map(|rival| json!({"effect": rival.term.id, "name": rival.term.name, "ln_odds": rival.odds}))
        .collect();
    let ids: Vec<&str> = cause.rivals.iter().map(|rival| rival.term.id).collect();
    let settings: Map<String, Value> = cause
        .term
        .settings
        .iter()
        .zip(&cause.settings)
        .enumerate()
        .map(|(place, (setting, value))| {
            let unit = setting.unit;
            let sought = cause.sought.filter(|(of, _)| *of == place);
            let told = json!({
                "value": value / unit.factor,
                "sigma": sought.map(|(_, sigma)| sigma / unit.factor),
                "unit": unit.symbol,
            });
            (setting.name.to_owned(), told)
        })
        .collect();
    json!({
        "effect": cause.term.id,
        "name": cause.term.name,
        "meaning": cause.term.cause,
        "equation": cause.term.equation,
        "settings": settings,
        "settings_in_words": settings_in_words(cause.term, &cause.settings, cause.sought),
        // A probability that is too small for a number is zero; its logarithm never is.
        "p_value": cause.ln_p.exp(),
        "ln_p": cause.ln_p,
        "delta_log_likelihood": cause.gain,
        "dof": cause.dof,
        "sigmas": named.sigmas,
        "plausible": named.plausible,
        "parameters": parameters,
        "cannot_tell_from": ids,
        "rivals": rivals,
        "tell_apart_by": cause.term.told_apart_by,
        "next_test": named.next_test.as_ref().map(|test| json!({
            "schedule": test.words,
            "from": test.from.id,
            "sigmas": test.sigmas,
        })),
        "no_next_test": named.no_next_test,
    })
}

fn unexplained(found: &Found, one: &Unexplained) -> Value {
    let fit = &found.certificate.fit;
    let worst = one.worst.iter().filter_map(|(id, value)| {
        let unit = fit.parameter(id)?.parameter.unit;
        Some(json!({"id": id, "value": value / unit.factor, "unit": unit.symbol}))
    });
    json!({
        "run": one.run + 1,
        "channel": one.channel,
        "structure": structure_in_words(one),
        "effect": one.of,
        "p_value": one.ln_p.exp(),
        "ln_p": one.ln_p,
        "amplitude": size_in_words(one),
        "worst": worst.collect::<Vec<_>>(),
    })
}

fn value(estimate: &Estimate) -> Value {
    let unit = estimate.parameter.unit;
    json!({
        "id": estimate.parameter.id,
        "run": estimate.run.map(|run| run + 1),
        "value": estimate.value / unit.factor,
        "sigma": estimate.sigma / unit.factor,
        "unit": unit.symbol,
    })
}
