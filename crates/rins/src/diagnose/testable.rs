//! Which effects a run could not have shown, and why.

use rins_estimation::Run;
use rins_terms::{Model, Need, SettingKind, Term, catalogue};

/// An effect of which a run shows nothing.
#[derive(Clone, Debug)]
pub(crate) struct Untestable {
    pub(crate) term: &'static Term,
    /// What the run would have to offer, in words.
    pub(crate) why: String,
}

/// The effects that could not be tried on these runs, or of which they show nothing beyond `model`.
pub(crate) fn untestable(runs: &[Run], model: &Model, unseen: &[&str]) -> Vec<Untestable> {
    let tried = rins_diagnosis::candidates(runs, model);
    let left_out = |term: &Term| {
        term.is_signal()
            && !model.terms.iter().any(|chosen| chosen.term.is(term))
            && !tried.iter().any(|candidate| candidate.chosen.term.is(term))
            // What has a frequency is tried where the innovations are strongest.
            && term.setting(SettingKind::Frequency).is_none()
    };
    let terms = catalogue::CATALOGUE.iter().copied();
    terms
        .filter_map(|term| {
            let why = if unseen.contains(&term.id) {
                unseen_for(term)
            } else if left_out(term) {
                missing(runs, term)
            } else {
                return None;
            };
            Some(Untestable { term, why })
        })
        .collect()
}

/// Why an effect that was tried does not show.
fn unseen_for(term: &Term) -> String {
    let needs: Vec<&str> = term.needs.iter().map(|need| in_words(*need)).collect();
    if needs.is_empty() {
        format!(
            "under this schedule it is equivalent to terms of the model; to separate it: {}",
            term.told_apart_by
        )
    } else {
        format!("it requires {}", needs.join(" and "))
    }
}

/// Why an effect was not tried.
fn missing(runs: &[Run], term: &Term) -> String {
    let lacks = |need: &&Need| match need {
        Need::Temperature => runs.iter().all(|run| run.recording.temperature.is_none()),
        // It was not tried, although the temperature is known.
        Need::TemperatureRange => true,
        Need::TableAngle => runs.iter().all(|run| run.recording.table_angle.is_none()),
        _ => false,
    };
    match term.needs.iter().find(lacks) {
        Some(need) => format!("it requires {}", in_words(*need)),
        None if term.needs.contains(&Need::Temperature) => "the temperature did not change".into(),
        None => term.told_apart_by.into(),
    }
}

const fn in_words(need: Need) -> &'static str {
    match need {
        Need::Temperature => "a temperature channel",
        Need::TemperatureRange => "a temperature that changes by tens of kelvins",
        Need::TableAngle => "a measured table angle",
        Need::SeveralRates => "more than one table rate",
        Need::Reversal => "rotation in both directions",
        Need::Tilt => "a spin axis that is not vertical",
        Need::SeveralTilts => "more than one direction of the spin axis",
        Need::MagneticField => "a known magnetic field",
    }
}
