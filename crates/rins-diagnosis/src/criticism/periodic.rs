//! Lines that are one thing: multiples of one frequency, or a wave of the turning table that comes and goes.

use std::f64::consts::TAU;

use rins_estimation::{Estimate, Fit};
use rins_terms::{Track, Unit, catalogue};

use crate::criticism::structure::Structure;
use crate::criticism::unexplained::{Unexplained, worst};
use crate::generic::disturbance::CHANNELS;
use crate::median::median;
use crate::verdict::cause::Cause;

/// Rates of a table that differ by less, as a part of them, are one.
const ALIKE: f64 = 0.01;

/// How many times one frequency is the other, in one waveform.
const MULTIPLES: [f64; 2] = [2.0, 3.0];

/// One frequency is a multiple of another within so many of their sigmas, which are no more than this part of it: else
/// it would be one by chance.
const WITHIN: (f64, f64) = (3.0, 0.01);

/// A line is a multiple of the table's turn by chance if it is not told to this part of a turn's frequency: of two, one pair in
/// a hundred is so.
const BY_CHANCE: f64 = 0.05;

/// The same where the table turns back, and what keeps step with it is no line: one pair in twenty-five.
const BY_CHANCE_BACK: f64 = 0.1;

/// A wave so many times a turn at most is looked for between two lines.
const MOST_A_TURN: u32 = 3;

/// The frequencies of what comes and goes are this near to the one between them, as a part of it.
const BESIDE: f64 = 0.3;

/// Whatever comes and goes with the turning table is no interference: two lines as far below and above what the table
/// does most of the time, and in truth one wave whose strength changes its sign.
pub(crate) fn modulated(after: &Fit, causes: &[Cause]) -> Vec<Unexplained> {
    let mut found: Vec<Unexplained> = Vec::new();
    for (one, other) in pairs(causes) {
        let (low, high) = (one.settings[0], other.settings[0]);
        let (middle, apart) = (0.5 * (low + high), 0.5 * (high - low).abs());
        let Some((sensor, estimate, height)) = strongest(one) else { continue };
        let run = estimate.run.unwrap_or_default();
        let linear = &after.linear[run];
        // Two lines so near to each other are hardly told apart, and their mean is known to that at best.
        let resolved = 1.0 / linear.track().duration();
        let motion = linear.motion();
        let is_often = |times: &u32| {
            let frequency = |rate: f64| f64::from(*times) * rate.abs() / TAU;
            let there = |(_, rate): &&(f64, f64)| (frequency(*rate) - middle).abs() < resolved;
            2 * motion.iter().filter(there).count() > motion.len()
        };
        let Some(times) = (1..=MOST_A_TURN).find(is_often) else { continue };
        let known = |other: &Unexplained| (other.run, other.channel) == (run, sensor);
        if apart > BESIDE * middle || found.iter().any(known) {
            continue;
        }
        // Each of the two has half of it.
        let amplitude = (2.0 * height, estimate.parameter.unit);
        let structure = Structure::Modulated(f64::from(times));
        found.push(of_pair(after, [one, other], (run, sensor), structure, amplitude));
    }
    found
}

/// Whether a cause is a line of one axis.
pub(crate) fn is_line(cause: &Cause) -> bool {
    cause.term.is(&catalogue::INTERFERENCE_LINE)
}

/// Lines of one axis, two and two.
fn pairs(causes: &[Cause]) -> impl Iterator<Item = (&Cause, &Cause)> {
    let lines = causes.iter().enumerate().filter(move |(_, cause)| is_line(cause));
    lines.flat_map(move |(place, line)| {
        let others = causes[place + 1..].iter().filter(|other| is_line(other));
        others.filter(|other| axis(line) == axis(other)).map(move |other| (line, other))
    })
}

/// Interference whose frequencies are multiples of one, of a line or of the table's turn: every line of it is explained,
/// that there are several is not.
pub(crate) fn waveforms(after: &Fit, causes: &[Cause]) -> Vec<Unexplained> {
    let mut found: Vec<Unexplained> = Vec::new();
    for (line, other) in pairs(causes) {
        let Some((sensor, estimate, height)) = strongest(line) else { continue };
        let run = estimate.run.unwrap_or_default();
        let Some(frequency) = common(line, other).or_else(|| of_turn(after, run, [line, other]))
        else {
            continue;
        };
        if found.iter().any(|one| one.channel == sensor) {
            continue;
        }
        let place = (run, sensor);
        let amplitude = (height, estimate.parameter.unit);
        let structure = Structure::Waveform(frequency);
        found.push(of_pair(after, [line, other], place, structure, amplitude));
    }
    found
}

/// What two lines of a channel of a run are.
fn of_pair(
    after: &Fit,
    [one, other]: [&Cause; 2],
    (run, channel): (usize, &'static str),
    structure: Structure,
    amplitude: (f64, Unit),
) -> Unexplained {
    Unexplained {
        run,
        channel,
        structure,
        of: None,
        ln_p: one.ln_p.max(other.ln_p),
        amplitude: Some(amplitude),
        worst: worst(after, 2.0 * (one.gain + other.gain)),
    }
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

/// How often the table turns \[Hz\], if it does at one rate most of the time.
pub(crate) fn turn_frequency(after: &Fit, run: usize) -> Option<f64> {
    let motion = after.linear[run].motion();
    let turns: Vec<f64> = motion.iter().map(|(_, rate)| rate.abs() / TAU).collect();
    let turn = median(&turns);
    let alike = turns.iter().filter(|other| (*other - turn).abs() < ALIKE * turn).count();
    (2 * alike > turns.len()).then_some(turn)
}

/// How often the table turns \[Hz\], if it does at one rate and two lines are multiples of that.
///
/// Where the table turns back, so does what it brings every turn: a line keeps step with that both ways at a frequency that is
/// off by half a period over one way at most.
fn of_turn(after: &Fit, run: usize, lines: [&Cause; 2]) -> Option<f64> {
    let turn = turn_frequency(after, run)?;
    let turns_back = turns_before_back(after.linear[run].track());
    let (in_step, by_chance) =
        turns_back.map_or((0.0, BY_CHANCE), |turns| (0.5 * turn / turns, BY_CHANCE_BACK));
    let is_multiple = |line: &Cause| {
        line.sought.is_some_and(|(place, sigma)| {
            let frequency = line.settings[place];
            let times = (frequency / turn).round();
            let within = in_step.max(WITHIN.0 * sigma);
            times > 1.0 && (frequency - times * turn).abs() < within && within < by_chance * turn
        })
    };
    lines.into_iter().all(is_multiple).then_some(turn)
}

/// How many turns a table makes one way at most before it turns back, if it does; a rest is no turning back.
fn turns_before_back(track: &Track) -> Option<f64> {
    let senses: Vec<f64> = track.moments().map(|moment| moment.end.sense).collect();
    let (mut first, mut ways, mut most) = (0, 0, 0.0_f64);
    for way in senses.chunk_by(|one, other| one * other > 0.0) {
        let last = first + way.len();
        if way[0] != 0.0 {
            ways += 1;
            most = most.max((track.angles()[last] - track.angles()[first]).abs() / TAU);
        }
        first = last;
    }
    (ways > 1).then_some(most)
}

/// On which sensor a line is strongest, and how high it is there.
pub(crate) fn strongest(line: &Cause) -> Option<(&'static str, &Estimate, f64)> {
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
