//! What the causes gain on data that played no part, in words.

use rins_diagnosis::{Drift, Gain, GainVerdict};
use rins_frames::units::DEG;

use crate::commands::diagnose::Measured;
use crate::number::figure;

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
pub(super) fn held_out(measured: &Measured, gain: &Gain) -> String {
    let size = format!("{} revolutions or pieces of a rest", gain.blocks);
    match &measured.on {
        None => format!(
            "the last 30 % of every stretch of constant rate ({size}), which its size was not taken from"
        ),
        Some(rig) => format!(
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
