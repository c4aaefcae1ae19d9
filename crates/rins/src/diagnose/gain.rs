//! What the causes gain on held-out data, in words.

use rins_diagnosis::{Drift, Gain, GainVerdict};
use rins_frames::units::DEG;

use super::measured::{Measured, On};
use rins_report::number::figure;
use rins_report::{Cell, Column, Item, Section, Table, Tone};

/// By which factor a drift has to grow for it to be said: it scatters, being that of a few windows.
const FURTHER: f64 = 1.5;

/// The evidence for a gain.
pub(super) fn gain_section(measured: &Measured) -> Section {
    let heading = match measured.on {
        On::Fastest => "Predictive gain at a held-out rate".to_owned(),
        On::Ends | On::Run(_) => "Predictive gain on held-out data".to_owned(),
    };
    let intro = "Both models are estimated again without the held-out data. Each held-out epoch is predicted from all earlier epochs. For a \
                 consistent model the expected mean NIS is the number of channels."
        .to_owned();
    let Ok(gain) = &measured.gain else {
        let items = vec![Item::Note(Tone::Neutral, gain_sentence(measured))];
        return Section { heading, intro, items };
    };
    let tone = match gain.verdict {
        GainVerdict::Improved if !drifts_further(gain) => Tone::Good,
        GainVerdict::Improved => Tone::Warning,
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
            format!("mean NIS, of {} channels", gain.before.nis_dof),
            [gain.before.nis_mean, gain.after.nis_mean],
        ),
    ];
    for drift in &gain.drifts {
        let over =
            format!("error after {:.0} s, RMS over {} window(s)", drift.after, drift.windows);
        rows.push(row(format!("velocity {over} [m/s]"), drift.velocity));
        rows.push(row(format!("attitude {over} [deg]"), drift.attitude.map(|angle| angle / DEG)));
    }
    let table = Table {
        caption: format!(
            "Held out: {} samples, {} revolutions or parts of a static interval",
            gain.samples, gain.blocks
        ),
        columns: vec![
            Column::text(""),
            Column::number("given model"),
            Column::number("extended model"),
        ],
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
        Err(error) => return format!("The predictive gain could not be measured: {error}."),
    };
    let scored = format!(
        "the log score {} by {} nats (95 % interval {} to {} nats)",
        if gain.rise() < 0.0 { "changes" } else { "rises" },
        figure(gain.rise(), 3),
        figure(gain.interval.0, 3),
        figure(gain.interval.1, 3)
    );
    let over = format!("On {}", held_out(measured, gain));
    let drift = gain.drifts.last().map_or_else(String::new, |drift| {
        let further = if drifts_further(gain) {
            ". Compensated navigation drifts further: after"
        } else {
            ". After"
        };
        format!("{further} {}", drifting(drift))
    });
    let check = consistency(gain);
    match gain.verdict {
        GainVerdict::Improved => {
            format!("{over}, the extended model predicts better: {scored}{drift}.{check}")
        }
        GainVerdict::NoImprovement => {
            format!("{over}, the extended model does not predict better: {scored}{drift}.{check}")
        }
    }
}

/// That a model to which no cause was added does not predict another run, if it does not.
pub(super) fn failed_prediction(measured: &Measured) -> Option<String> {
    let (On::Run(rig), Ok(gain)) = (&measured.on, &measured.gain) else { return None };
    let before = &gain.before;
    (!before.is_consistent()).then(|| {
        format!(
            "The model does not predict {rig} within the stated uncertainty: mean NIS {}, {} expected.",
            figure(before.nis_mean, 3),
            before.nis_dof
        )
    })
}

/// The absolute check of the prediction, if it fails.
fn consistency(gain: &Gain) -> String {
    let after = &gain.after;
    if after.is_consistent() {
        return String::new();
    }
    let both = if gain.before.is_consistent() {
        "The extended model does not"
    } else {
        "Neither model can"
    };
    format!(
        " {both} predict these data within the stated uncertainty: mean NIS {} with the extended model, {} with the given one, \
         {} expected.",
        figure(after.nis_mean, 3),
        figure(gain.before.nis_mean, 3),
        after.nis_dof
    )
}

/// Whether free navigation ends further off, in velocity or attitude, with what the extended model finds undone.
fn drifts_further(gain: &Gain) -> bool {
    let further = |[before, after]: [f64; 2]| after > FURTHER * before;
    gain.drifts.last().is_some_and(|drift| further(drift.velocity) || further(drift.attitude))
}

/// What was held out.
fn held_out(measured: &Measured, gain: &Gain) -> String {
    let size = format!("{} blocks, each one revolution or 10 s", gain.blocks);
    match &measured.on {
        On::Ends => {
            format!("held-out data (the last 30 % of each segment; {size})")
        }
        On::Fastest => {
            format!("held-out data (the segments at the fastest rate of the table; {size})")
        }
        On::Run(rig) => format!("held-out data (the last 30 % of each segment of {rig}; {size})"),
    }
}

fn drifting(drift: &Drift) -> String {
    let [before, after] = drift.attitude.map(|angle| figure(angle / DEG, 3));
    let [without, with] = drift.velocity.map(|velocity| figure(velocity, 3));
    format!(
        "{:.0} s of free inertial navigation the velocity error is {with} m/s (given model: {without} m/s), the \
         attitude error {after} deg (given model: {before} deg)",
        drift.after
    )
}

#[cfg(test)]
mod tests {
    use rins_diagnosis::PredictiveScore;

    use super::*;

    /// A gain of 30 nats after which the attitude is so many times as far off.
    fn measured(times: f64) -> Measured {
        let score = |log_score| PredictiveScore { log_score, nis_mean: 6.0, nis_dof: 6 };
        let drift = Drift {
            after: 60.0,
            windows: 3,
            velocity: [0.02, 0.015],
            attitude: [0.01 * DEG, times * 0.01 * DEG],
        };
        let gain = Gain {
            spans: vec![vec![0..3000]],
            samples: 3000,
            blocks: 6,
            before: score(100.0),
            after: score(130.0),
            interval: (12.0, 47.0),
            drifts: vec![drift],
            verdict: GainVerdict::Improved,
        };
        Measured { on: On::Ends, gain: Ok(gain) }
    }

    #[test]
    fn drift_that_grows_is_not_passed_over() {
        let better = gain_sentence(&measured(0.5));
        assert!(better.contains("predicts better") && !better.contains("further"), "{better}");
        let further = gain_sentence(&measured(9.0));
        assert!(further.contains(". Compensated navigation drifts further: after 60 s"));
        assert!(
            further.contains("the attitude error 0.0900 deg (given model: 0.0100 deg)"),
            "{further}"
        );
    }
}
