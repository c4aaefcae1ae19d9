//! Lines that are one thing: multiples of one frequency.

use rins_estimation::{Estimate, Fit};
use rins_terms::catalogue;

use crate::diagnosis::Cause;
use crate::disturbance::CHANNELS;
use crate::structure::Structure;
use crate::unexplained::{Unexplained, worst};

/// How many times one frequency is the other, in one waveform.
const MULTIPLES: [f64; 2] = [2.0, 3.0];

/// One frequency is a multiple of another within so many of their sigmas, which are no more than this part of it: else
/// it would be one by chance.
const WITHIN: (f64, f64) = (3.0, 0.01);

/// Interference whose frequencies are multiples of one: every line of it is explained, that there are several is not.
pub(crate) fn waveforms(after: &Fit, causes: &[Cause]) -> Vec<Unexplained> {
    let lines: Vec<&Cause> =
        causes.iter().filter(|cause| cause.term.id == catalogue::INTERFERENCE_LINE.id).collect();
    let mut found: Vec<Unexplained> = Vec::new();
    for (place, line) in lines.iter().enumerate() {
        for other in &lines[place + 1..] {
            let Some(frequency) = common(line, other) else { continue };
            let Some((sensor, estimate, height)) = strongest(line) else { continue };
            if axis(line) != axis(other) || found.iter().any(|one| one.channel == sensor) {
                continue;
            }
            found.push(Unexplained {
                run: estimate.run.unwrap_or_default(),
                channel: sensor,
                structure: Structure::Waveform(frequency),
                of: None,
                ln_p: line.ln_p.max(other.ln_p),
                amplitude: Some((height, estimate.parameter.unit)),
                worst: worst(after, 2.0 * (line.gain + other.gain)),
            });
        }
    }
    found
}

/// The axis of a line, from zero.
fn axis(line: &Cause) -> Option<usize> {
    [1.5, 2.5, 3.5].iter().position(|edge| line.settings[1] < *edge)
}

/// The frequency of which two lines are multiples, if there is one \[Hz\].
fn common(one: &Cause, other: &Cause) -> Option<f64> {
    let frequency =
        |cause: &Cause| cause.sought.map(|(place, sigma)| (cause.settings[place], sigma));
    let (one, other) = (frequency(one)?, frequency(other)?);
    let (low, high) = if one.0 < other.0 { (one, other) } else { (other, one) };
    let is_multiple = |times: &&f64| {
        let sigma = (*times * low.1).hypot(high.1);
        let off = (high.0 - *times * low.0).abs();
        off < WITHIN.0 * sigma && sigma < WITHIN.1 * high.0
    };
    MULTIPLES.iter().find(is_multiple).map(|_| low.0)
}

/// On which sensor a line is strongest, and how high it is there.
fn strongest(line: &Cause) -> Option<(&'static str, &Estimate, f64)> {
    let axis = axis(line)?;
    let pair = |first: usize| {
        let mut own = line.parameters.iter().filter(move |e| e.parameter.parameter / 2 == first);
        let (cos, sin) = (own.next()?, own.next()?);
        let height = cos.value.hypot(sin.value);
        Some((cos, height, height / cos.sigma.max(sin.sigma)))
    };
    let of_triad = |triad: usize| {
        pair(triad)
            .map(|(estimate, height, size)| (CHANNELS[3 * triad + axis], estimate, height, size))
    };
    let best = [0, 1].into_iter().filter_map(of_triad).max_by(|a, b| a.3.total_cmp(&b.3))?;
    Some((best.0, best.1, best.2))
}
