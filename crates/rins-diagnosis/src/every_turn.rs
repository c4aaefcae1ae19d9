//! What comes back every turn, and is no sine: effects that are its parts, and that nothing tells apart from it.

use rins_estimation::{Estimate, Fit};
use rins_terms::{Chosen, Term, catalogue};

use crate::case::Case;
use crate::diagnosis::Cause;
use crate::disturbance::{CHANNELS, IN_ANGLE};
use crate::periodic::turn_frequency;
use crate::residuals::ABOUT_AXIS;
use crate::structure::Structure;
use crate::trial::UNKNOWN;
use crate::unexplained::{Unexplained, worst};
use crate::wander::CHOSEN;

/// So many harmonics of an encoder, each of an order of its own, may be parts of something else.
const SEVERAL: usize = 2;

/// The parameters of a disturbance that are of the gyro about the axis.
const OF_GYRO: [&str; 2] = ["gyro_z_cos", "gyro_z_sin"];

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
    /// Harmonics of the encoder, and other effects that come back every turn, where one waveform on the gyro about the axis does
    /// as well: at one rate an encoder's error and a gyro's are one.
    pub(crate) fn of_every_turn(&self, after: &Fit, causes: &[Cause]) -> Option<Unexplained> {
        let parts: Vec<&Cause> =
            causes.iter().filter(|cause| !orders(cause.term, &cause.settings).is_empty()).collect();
        let harmonics = parts.iter().filter(|part| is_harmonic(part.term)).count();
        let saved = CHOSEN * parts.len() as f64 - UNKNOWN;
        if harmonics < SEVERAL || saved <= 0.0 {
            return None;
        }
        let run = parts[0].parameters.first().and_then(|estimate| estimate.run).unwrap_or_default();
        let frequency = turn_frequency(after, run)?;
        let (own, mut model): (Vec<Chosen>, Vec<Chosen>) = self
            .causes_in(after)
            .iter()
            .cloned()
            .partition(|one| !orders(one.term, &one.settings).is_empty());
        let mut all: Vec<f64> =
            own.iter().flat_map(|one| orders(one.term, &one.settings)).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        let wave = |order: f64| Chosen::new(&IN_ANGLE).with_setting("order", order);
        model.extend(all.into_iter().map(|order| wave(order).estimating(&OF_GYRO)));
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

/// The orders of the table angle in which an effect shows about the axis every turn, if it does.
fn orders(term: &Term, settings: &[f64]) -> Vec<f64> {
    if is_harmonic(term) {
        return vec![settings[0].abs()];
    }
    let part = PARTS.iter().find(|(part, _)| part.id == term.id);
    part.map_or_else(Vec::new, |(_, orders)| orders.to_vec())
}

fn is_harmonic(term: &Term) -> bool {
    term.id == catalogue::ENCODER_HARMONIC.id
}
