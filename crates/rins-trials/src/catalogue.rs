//! The catalogue's effects as hidden ones, and as their rivals.

use rins_blind::Effect;
use rins_terms::{Model, Need, SettingKind, Term, TermInstance, catalogue};

/// What is a choice of frame, what leaves nothing behind, and what a table in a laboratory does not do.
static NEVER_HIDDEN: [&Term; 5] = [
    &catalogue::AXIS_AZIMUTH,
    &catalogue::MOUNTING,
    &catalogue::ENCODER_ZERO,
    &catalogue::TABLE_RATE_RIPPLE,
    &catalogue::BASE_ROLLING,
];

/// The orders of the table angle at which rivals are tried.
const ORDERS: [f64; 12] = [-4.0, -3.0, -2.0, -1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 12.0];

/// The parts of a run after which something happens.
const PARTS: u32 = 16;

/// Whether a term is a signal that can be hidden in a run, and the baseline does not hold.
pub fn is_hideable(term: &Term) -> bool {
    let is_baseline = Model::full().terms.iter().any(|own| own.term.is(term));
    // The temperature of these laboratories changes by a few kelvins.
    let shows = !term.needs.contains(&Need::TemperatureRange);
    term.is_signal() && !is_baseline && shows && !NEVER_HIDDEN.iter().any(|never| never.is(term))
}

/// A term with its numbers, as the generator takes it.
pub fn hidden(chosen: &TermInstance) -> Effect {
    Effect::new(chosen.term.id, &chosen.values, &chosen.settings)
}

/// Every effect in every shape that a run of `duration` \[s\] could show, but for lines of any frequency.
pub(crate) fn rivals(duration: f64) -> Vec<TermInstance> {
    let mut rivals = Vec::new();
    for term in catalogue::CATALOGUE.iter().copied().filter(|term| is_hideable(term)) {
        let chosen = TermInstance::new(term).estimated();
        let with = |kind: SettingKind, values: &[f64]| -> Vec<TermInstance> {
            let setting = term.setting(kind).map(|place| &term.settings[place]);
            let fits = |value: &&f64| setting.is_some_and(|setting| setting.allows(**value));
            values.iter().filter(fits).map(|&v| chosen.clone().with_setting(kind, v)).collect()
        };
        let has = |kind: SettingKind| term.setting(kind).is_some();
        if has(SettingKind::Frequency) {
            continue;
        }
        if has(SettingKind::Time) {
            let part = |number| duration * (f64::from(number) + 0.5) / f64::from(PARTS);
            rivals.extend(with(SettingKind::Time, &(0..PARTS).map(part).collect::<Vec<_>>()));
        } else if has(SettingKind::TimeConstant) {
            let values = [0.03, 0.1, 0.3].map(|part| part * duration);
            rivals.extend(with(SettingKind::TimeConstant, &values));
        } else if has(SettingKind::Order) {
            rivals.extend(with(SettingKind::Order, &ORDERS));
        } else {
            rivals.push(chosen);
        }
    }
    rivals
}

/// The effects of the shape that another one has: of its order, frequency or time.
pub(crate) fn alike(chosen: &TermInstance) -> Vec<TermInstance> {
    let own = chosen.term.settings.iter().zip(&chosen.settings);
    own.flat_map(|(setting, &value)| {
        let has = move |term: &&'static Term| {
            let same = term.setting(setting.kind).map(|place| &term.settings[place]);
            same.is_some_and(|same| same.allows(value))
        };
        let terms = catalogue::CATALOGUE.iter().copied().filter(|term| is_hideable(term));
        terms
            .filter(has)
            .map(move |term| TermInstance::new(term).estimated().with_setting(setting.kind, value))
    })
    .collect()
}
