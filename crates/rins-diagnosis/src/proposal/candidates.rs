//! The effects that are tried on runs: every term of the catalogue, in every shape that could differ.

use rins_estimation::{Reference, Run};
use rins_terms::{
    GridPoint, Model, Need, Role, Setting, SettingKind, Term, TermInstance, catalogue,
};

use crate::generic::between_runs;
use crate::proposal::dead_zone;

/// Choices of a frame, of which a baseline holds all that shows, and the heading, which a survey tells or a baseline estimates.
static NEVER_TRIED: [&Term; 3] =
    [&catalogue::MOUNTING, &catalogue::ENCODER_ZERO, &catalogue::AXIS_AZIMUTH];

/// No more events of one kind are taken for such: what happens again and again is something else.
const MOST_ALIKE: usize = 2;

/// A warm-up with two time constants is two effects if one is so many times the other at least.
const APART: f64 = 3.0;

/// A temperature that changes by less \[K\] shows no effect of temperature.
const LEAST_WARMING: f64 = 0.05;

/// Over a smaller range of temperature \[K\] the typical curvature of a bias, 0.01 per K of its slope, departs from a line by less than a
/// fortieth of the change.
const CURVED: f64 = 20.0;

/// A table that has turned by less may stand \[rad\].
const LEAST_TURN: f64 = 1e-3;

/// A term in one shape, to be tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The term, all its parameters estimated.
    pub chosen: TermInstance,
    /// How many independent shapes the term has: what a test of the best of them costs.
    pub looks: f64,
    /// How far the neighbouring shapes are, if shapes are taken from a continuum: the place of a setting, and its step.
    pub step: Option<(usize, f64)>,
    /// The term of the model of which it is a departure beyond the stated prior, if it is one.
    pub(crate) departs: Option<usize>,
}

/// What is tried on `runs` beyond `model`.
///
/// Terms that the model estimates already, that need what no run has, or whose shape is an unknown
/// frequency are left out.
pub fn candidates(runs: &[Run], model: &Model) -> Vec<Candidate> {
    terms(runs)
        .flat_map(|term| shapes(duration(runs), term))
        .chain(between_runs(runs, model))
        .map(|candidate| candidate.about(runs))
        .filter(|candidate| has_room(model, &candidate.chosen, duration(runs)))
        .filter(|candidate| !is_latency(runs, &candidate.chosen))
        .collect()
}

/// The signals of the catalogue that are tried on `runs`: those of which a run has what they need.
pub(crate) fn terms(runs: &[Run]) -> impl Iterator<Item = &'static Term> {
    catalogue::CATALOGUE
        .iter()
        .copied()
        .filter(|term| term.is_signal() && !NEVER_TRIED.iter().any(|other| other.is(term)))
        .filter(|term| term.needs.iter().all(|need| offer(runs, *need)))
}

/// Whether a run has an encoder.
pub(crate) fn has_encoder(runs: &[Run]) -> bool {
    runs.iter().any(|run| matches!(run.rig.reference, Reference::Encoder { .. }))
}

/// What may differ between several runs.
fn between_runs(runs: &[Run], model: &Model) -> impl Iterator<Item = Candidate> {
    let all = (runs.len() > 1).then(|| between_runs::of_model(model));
    let of = |chosen| Candidate { chosen, looks: 1.0, step: None, departs: None };
    all.into_iter().flatten().map(of)
}

/// How many terms a search chooses from.
pub(crate) fn number_of_terms(list: &[Candidate]) -> usize {
    let mut ids: Vec<&str> = list.iter().map(|one| one.chosen.term.id).collect();
    ids.sort_unstable();
    ids.dedup();
    // Lines have no grid.
    ids.len() + 2
}

/// Whether these are samples that an encoder loses before the table ever turns, which is nothing but a latency.
fn is_latency(runs: &[Run], chosen: &TermInstance) -> bool {
    let turns_by = |run: &Run, time: f64| {
        let (angles, times) = (run.recording.table_angle.as_deref()?, &run.recording.times);
        let first = angles.iter().position(|angle| (angle - angles[0]).abs() > LEAST_TURN)?;
        Some(times[first] - times[0] < time)
    };
    let time = chosen.settings.first();
    chosen.term.is(&catalogue::DROPPED_SAMPLES)
        && time.is_some_and(|time| runs.iter().all(|run| turns_by(run, *time) == Some(false)))
}

/// Whether a model leaves room for an effect beside those of its kind: two orders are two effects, and what happens twice
/// two events, if they are not one whose time is a little off. A base that steps time and again is no step.
pub(crate) fn has_room(model: &Model, other: &TermInstance, duration: f64) -> bool {
    let alike: Vec<&TermInstance> =
        model.terms.iter().filter(|own| own.term.is(other.term)).collect();
    if other.term.setting(SettingKind::Order).is_some() {
        return alike.iter().all(|own| own.settings != other.settings);
    }
    if let Some(place) = other.term.setting(SettingKind::Frequency) {
        // Nearer to each other they are one.
        let apart = |own: &&TermInstance| (own.settings[place] - other.settings[place]).abs();
        let elsewhere =
            |own: &&TermInstance| own.settings[place + 1..] != other.settings[place + 1..];
        return alike.iter().all(|own| elsewhere(own) || apart(own) * duration > 1.0);
    }
    let follows_heat = other.term.is(&catalogue::THERMAL_ONE_PER_TURN);
    if let Some(place) = other.term.setting(SettingKind::TimeConstant).filter(|_| !follows_heat) {
        let apart = |own: &&TermInstance| (own.settings[place] / other.settings[place]).ln().abs();
        return alike.len() < MOST_ALIKE && alike.iter().all(|own| apart(own) > APART.ln());
    }
    match other.term.setting(SettingKind::Time) {
        Some(place) if !other.term.is(&catalogue::BASE_TILT_STEP) => {
            let apart = |own: &&TermInstance| (own.settings[place] - other.settings[place]).abs();
            let least = duration / f64::from(SettingKind::EVENT_TIMES);
            alike.len() < MOST_ALIKE && alike.iter().all(|own| apart(own) > least)
        }
        _ => alike.is_empty(),
    }
}

/// Whether an effect is a line of any frequency.
pub(crate) fn has_frequency(term: &Term) -> bool {
    term.setting(SettingKind::Frequency).is_some()
}

/// How long the longest run is \[s\].
pub(crate) fn duration(runs: &[Run]) -> f64 {
    let of = |run: &Run| run.recording.times[run.recording.len() - 1] - run.recording.times[0];
    runs.iter().map(of).fold(0.0, f64::max)
}

/// By how much the temperature changes in and between runs \[K\]; minus infinity if it is not known.
fn temperature_range(runs: &[Run]) -> f64 {
    let all = || runs.iter().filter_map(|run| run.recording.temperature.as_ref()).flatten();
    let most = all().copied().fold(f64::NEG_INFINITY, f64::max);
    most - all().copied().fold(f64::INFINITY, f64::min)
}

fn offer(runs: &[Run], need: Need) -> bool {
    match need {
        // From run to run is a change too.
        Need::Temperature => temperature_range(runs) > LEAST_WARMING,
        Need::TemperatureRange => temperature_range(runs) > CURVED,
        Need::TableAngle => has_encoder(runs),
        // Where rates, tilts or senses are too few, the information says so by itself.
        _ => true,
    }
}

/// A term in each of its shapes.
fn shapes(duration: f64, term: &'static Term) -> Vec<Candidate> {
    let chosen = TermInstance::new(term).estimated();
    let grid =
        |(place, setting): (usize, &'static Setting)| Some((place, setting.search_grid(duration)?));
    if dead_zone::is_true(&chosen) {
        dead_zone::shapes()
    } else if has_frequency(term) {
        Vec::new()
    } else if let Some((place, grid)) = term.settings.iter().enumerate().find_map(grid) {
        let grid: Vec<GridPoint> = grid.collect();
        let all: f64 = grid.iter().map(|point| point.weight).sum();
        let candidate = |point: &GridPoint| {
            let mut chosen = chosen.clone();
            chosen.settings[place] = point.value;
            let step = point.spacing.map(|spacing| (place, spacing));
            // A shape is looked for the more, the more is expected of it.
            Candidate { chosen, looks: all / point.weight, step, departs: None }
        };
        grid.iter().map(candidate).collect()
    } else {
        vec![Candidate { chosen, looks: 1.0, step: None, departs: None }]
    }
}

impl Candidate {
    /// The same about the temperature at which the runs begin, if it depends on temperature: what the sheet says of a bias is
    /// true of the runs, whatever its coefficient.
    fn about(mut self, runs: &[Run]) -> Self {
        let first = |run: &Run| run.recording.temperature.as_ref()?.first().copied();
        let place = self.chosen.term.setting(SettingKind::ReferenceTemperature);
        if let Some((place, start)) = place.zip(runs.iter().find_map(first)) {
            self.chosen.settings[place] = start;
        }
        self
    }

    /// The departures of a model's parameters beyond their stated priors.
    pub(crate) fn departures(model: &Model) -> impl Iterator<Item = Self> {
        let terms = model.terms.iter().enumerate();
        let free = terms.filter(|(_, one)| one.roles.iter().any(|role| *role != Role::Held));
        free.map(|(place, one)| {
            let chosen = one.clone().with_values(&vec![0.0; one.values.len()]);
            Self { chosen, looks: 1.0, step: None, departs: Some(place) }
        })
    }

    /// Shapes around this one, `part` of its step apart, four on each side, and itself.
    pub(crate) fn neighbours(&self, part: f64) -> Vec<Self> {
        let Some((place, step)) = self.step else { return vec![self.clone()] };
        let setting = &self.chosen.term.settings[place];
        let moved = |by: i32| {
            let mut other = self.clone();
            other.chosen.settings[place] += f64::from(by) * step * part;
            other
        };
        (-4..=4).map(moved).filter(|other| setting.allows(other.chosen.settings[place])).collect()
    }

    /// The same effect when another one happens, or as slowly, if both are events or settle.
    pub(crate) fn at_the_time_of(&self, other: &TermInstance) -> Option<Self> {
        [SettingKind::Time, SettingKind::TimeConstant].into_iter().find_map(|kind| {
            let own = self.chosen.term.setting(kind)?;
            let mut moved = self.clone();
            moved.chosen.settings[own] = other.setting(kind)?;
            Some(moved)
        })
    }
}
