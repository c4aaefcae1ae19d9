//! Lines that are one: a line that comes and goes stands between others.

use rins_terms::SettingKind;

use crate::criticism::structure::{Stratum, Structure};
use crate::criticism::unexplained::Unexplained;
use crate::verdict::cause::Cause;

/// Lines stand beside another whose frequencies differ from its own by less than this part of it, ...
const BESIDE: f64 = 0.1;

/// ... and where there are such on both sides of it, those further out than that, to this part of it, are of it too.
const OUTER: f64 = 0.2;

/// Lines that differ by less than so many cycles in a run are not told apart by it.
const UNRESOLVED: f64 = 2.0;

/// Every line without those beside it that are nothing but its coming and going, and what is to be said of each that has
/// such.
///
/// A line whose amplitude changes stands between others, its sidebands. Two lines apart are two.
pub(crate) fn gathered(mut causes: Vec<Cause>, duration: f64) -> (Vec<Cause>, Vec<Unexplained>) {
    causes.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut found = Vec::new();
    let mut place = 0;
    while place < causes.len() {
        let line = &causes[place];
        let beside: Vec<f64> =
            causes[place + 1..].iter().filter_map(|other| apart(line, other)).collect();
        let is_near = |apart: f64| apart.abs() < BESIDE * line.settings[0];
        let is_there = |side: f64| beside.iter().any(|&apart| side * apart > 0.0 && is_near(apart));
        let on_both_sides = is_there(1.0) && is_there(-1.0);
        let is_one = |apart: f64| on_both_sides || apart.abs() * duration < UNRESOLVED;
        let line = line.clone();
        let mut of_sidebands: Option<f64> = None;
        causes.retain(|other| {
            let goes = apart(&line, other).is_some_and(is_one) && other.gain <= line.gain;
            if goes {
                of_sidebands = Some(of_sidebands.map_or(other.ln_p, |least| least.min(other.ln_p)));
            }
            !goes
        });
        found.extend(of_sidebands.map(|ln_p| Unexplained {
            run: line.parameters.first().and_then(|estimate| estimate.run).unwrap_or_default(),
            channel: "all",
            structure: Structure::Inconstant(Stratum::Time),
            of: Some(line.term.id),
            ln_p,
            amplitude: None,
            worst: Vec::new(),
        }));
        place += 1;
    }
    (causes, found)
}

/// How much higher the frequency of one line is than that of another beside it \[Hz\].
fn apart(line: &Cause, other: &Cause) -> Option<f64> {
    let run = |cause: &Cause| cause.parameters.first().and_then(|estimate| estimate.run);
    if line.term.setting(SettingKind::Frequency) != Some(0)
        || !line.term.is(other.term)
        || line.settings == other.settings
    {
        return None;
    }
    let alike = line.settings[1..] == other.settings[1..] && run(line) == run(other);
    let apart = other.settings[0] - line.settings[0];
    (alike && apart.abs() < OUTER * line.settings[0]).then_some(apart)
}
