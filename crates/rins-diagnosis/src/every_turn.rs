//! What comes back every turn, and is no sine: effects that are its parts, and that nothing tells apart from it.

use std::f64::consts::TAU;

use rins_estimation::{Estimate, Fit};
use rins_terms::{Chosen, Term, catalogue};

use crate::case::Case;
use crate::diagnosis::Cause;
use crate::disturbance::{CHANNELS, IN_ANGLE};
use crate::structure::Structure;
use crate::trial::UNKNOWN;
use crate::unexplained::{Unexplained, worst};
use crate::wander::CHOSEN;

/// Rates of a table that differ by less, as a part of them, are one.
const ALIKE: f64 = 0.01;

/// The gyro about the axis, which is seen against the encoder.
const ABOUT_AXIS: usize = 2;

/// Effects that the gyro about the axis or the encoder show every turn, and in which orders of the table angle; harmonics
/// of the encoder have each their own.
const PARTS: [(&Term, &[f64]); 5] = [
    (&catalogue::ENCODER_ECCENTRICITY, &[1.0]),
    (&catalogue::GYRO_G_SENSITIVITY, &[1.0]),
    (&catalogue::GYRO_MAGNETIC, &[1.0]),
    (&catalogue::THERMAL_ONE_PER_TURN, &[1.0]),
    (&catalogue::GYRO_G2_SENSITIVITY, &[1.0, 2.0]),
];

impl Case<'_> {
    /// Several effects in several orders of the turn, where one waveform on the gyro about the axis does as well: at one
    /// rate an encoder's error and a gyro's are one.
    pub(crate) fn of_every_turn(&self, after: &Fit, causes: &[Cause]) -> Option<Unexplained> {
        let parts: Vec<&Cause> =
            causes.iter().filter(|cause| !orders(cause.term, &cause.settings).is_empty()).collect();
        let saved = CHOSEN * parts.len() as f64 - UNKNOWN;
        if saved <= 0.0 {
            return None;
        }
        let run = parts[0].parameters.first().and_then(|estimate| estimate.run).unwrap_or_default();
        let frequency = turns(after, run)?;
        let beyond = &after.model().terms[self.given.terms.len()..];
        let (own, mut model): (Vec<Chosen>, Vec<Chosen>) =
            beyond.iter().cloned().partition(|one| !orders(one.term, &one.settings).is_empty());
        let mut orders: Vec<f64> =
            own.iter().flat_map(|one| orders(one.term, &one.settings)).collect();
        orders.sort_by(f64::total_cmp);
        orders.dedup();
        let wave = |order: &f64| {
            let order = Chosen::new(&IN_ANGLE).with_setting("order", *order);
            order.estimating(&IN_ANGLE_ABOUT_AXIS)
        };
        model.extend(orders.iter().map(wave));
        let as_one = self.fit_near(after, &model).ok()?;
        if as_one.log_likelihood - after.log_likelihood + saved < 0.0 {
            return None;
        }
        let is_wave = |estimate: &&Estimate| {
            estimate.parameter.id.starts_with(IN_ANGLE.id)
                && estimate.run.is_none_or(|of| of == run)
        };
        let waves = as_one.parameters.iter().filter(is_wave);
        let square: f64 = waves.map(|estimate| estimate.value.powi(2)).sum();
        let gain: f64 = parts.iter().map(|part| part.gain).sum();
        Some(Unexplained {
            run,
            channel: CHANNELS[ABOUT_AXIS],
            structure: Structure::Waveform(frequency),
            of: None,
            ln_p: parts.iter().map(|part| part.ln_p).fold(f64::NEG_INFINITY, f64::max),
            amplitude: Some((square.sqrt(), IN_ANGLE.parameters[2 * ABOUT_AXIS].unit)),
            worst: worst(after, 2.0 * gain),
        })
    }
}

/// The parameters of a disturbance that are the gyro's about the axis.
const IN_ANGLE_ABOUT_AXIS: [&str; 2] = ["gyro_z_cos", "gyro_z_sin"];

/// The orders of the table angle in which an effect shows about the axis every turn, if it does.
fn orders(term: &Term, settings: &[f64]) -> Vec<f64> {
    if term.id == catalogue::ENCODER_HARMONIC.id {
        return vec![settings[0].abs()];
    }
    let part = PARTS.iter().find(|(part, _)| part.id == term.id);
    part.map_or_else(Vec::new, |(_, orders)| orders.to_vec())
}

/// How often the table turns \[Hz\], if it does at one rate most of the time.
pub(crate) fn turns(after: &Fit, run: usize) -> Option<f64> {
    let motion = after.linear[run].motion();
    let mut turns: Vec<f64> = motion.iter().map(|(_, rate)| rate.abs() / TAU).collect();
    let middle = turns.len() / 2;
    turns.get(middle)?;
    let (_, &mut turn, _) = turns.select_nth_unstable_by(middle, f64::total_cmp);
    let alike = turns.iter().filter(|other| (*other - turn).abs() < ALIKE * turn).count();
    (2 * alike > turns.len()).then_some(turn)
}
