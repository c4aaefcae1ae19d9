//! What the causes gain on data that played no part, in words.

use rins_diagnosis::{Drift, Gain, GainVerdict};
use rins_frames::units::DEG;

use crate::commands::diagnose::{Measured, On};
use crate::number::figure;
use crate::report::{Cell, Column, Item, Section, Table, Tone};

/// The evidence for a gain.
pub(super) fn gain_section(measured: &Measured) -> Section {
    let heading = match measured.on {
        On::Fastest => "What it gains at a rate that played no part".to_owned(),
        On::Ends | On::Run(_) => "What it gains on data that played no part".to_owned(),
    };
    let intro = "Both models were estimated anew without what is held out, and then foretold every epoch of it from all before. NIS is \
                 the mean of the squared innovations of an epoch: as many as there are figures, if the model is right."
        .to_owned();
    let Ok(gain) = &measured.gain else {
        let items = vec![Item::Note(Tone::Neutral, gain_sentence(measured))];
        return Section { heading, intro, items };
    };
    let tone = match gain.verdict {
        GainVerdict::Improved => Tone::Good,
        GainVerdict::NoImprovement => Tone::Neutral,
    };
    let row = |name: String, [before, after]: [f64; 2]| {
        vec![Cell::text(name), Cell::text(figure(before, 4)), Cell::text(figure(after, 4))]
    };
    let per_sample = |score: f64| score / gain.samples as f64;
    let mut rows = vec![
        row(
            "log score of a sample [nats]".into(),
            [per_sample(gain.before.log_score), per_sample(gain.after.log_score)],
        ),
        row(
            format!("mean NIS, of {} figures", gain.before.nis_dof),
            [gain.before.nis_mean, gain.after.nis_mean],
        ),
    ];
    for drift in &gain.drifts {
        let over = format!("after {:.0} s, rms of {} window(s)", drift.after, drift.windows);
        rows.push(row(format!("velocity {over} [m/s]"), drift.velocity));
        rows.push(row(format!("attitude {over} [deg]"), drift.attitude.map(|angle| angle / DEG)));
    }
    let table = Table {
        caption: format!(
            "Held out: {} samples, {} revolutions or pieces of a rest",
            gain.samples, gain.blocks
        ),
        columns: vec![Column::text(""), Column::number("before"), Column::number("after")],
        rows,
    };
    Section {
        heading,
        intro,
        items: vec![Item::Note(tone, gain_sentence(measured)), Item::Table(table)],
    }
}

/// What came of it, with the figures.
pub(super) fn gain_sentence(measured: &Measured) -> String {
    let gain = match &measured.gain {
        Ok(gain) => gain,
        Err(error) => return format!("What this gains could not be measured: {error}."),
    };
    let scored = format!(
        "the log score goes up by {} nats (95 %: {} to {})",
        figure(gain.rise(), 3),
        figure(gain.interval.0, 3),
        figure(gain.interval.1, 3)
    );
    let over = format!("Foretelling {}", held_out(measured, gain));
    let drift =
        gain.drifts.last().map_or_else(String::new, |drift| format!("; {}", drifting(drift)));
    match gain.verdict {
        GainVerdict::Improved => {
            format!("{over}, the extended model does better: {scored}{drift}.")
        }
        GainVerdict::NoImprovement => {
            format!("{over}, the extended model does not do better: {scored}{drift}.")
        }
    }
}

/// What was held out.
fn held_out(measured: &Measured, gain: &Gain) -> String {
    let size = format!("{} revolutions or pieces of a rest", gain.blocks);
    match &measured.on {
        On::Ends => format!(
            "the last 30 % of every stretch of constant rate ({size}), which its size was not taken from"
        ),
        On::Fastest => format!(
            "the stretches at the table's fastest rate ({size}), its size taken from the slower ones"
        ),
        On::Run(rig) => format!(
            "the last 30 % of every stretch of {rig} ({size}), which played no part in finding it"
        ),
    }
}

fn drifting(drift: &Drift) -> String {
    let [before, after] = drift.attitude.map(|angle| figure(angle / DEG, 3));
    let [without, with] = drift.velocity.map(|velocity| figure(velocity, 3));
    format!(
        "after {:.0} s of free inertial navigation the velocity is off by {with} m/s instead of {without}, the attitude by \
         {after} deg instead of {before}",
        drift.after
    )
}
