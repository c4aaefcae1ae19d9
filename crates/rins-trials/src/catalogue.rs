//! The catalogue's effects as hidden ones.

use rins_blind::Effect;
use rins_terms::{Action, Chosen, Term};

/// What the baseline holds anyway, what is a choice of frame, and what leaves nothing behind.
const NEVER_HIDDEN: [&str; 10] = [
    "gyro.bias",
    "gyro.scale",
    "gyro.misalignment",
    "accel.bias",
    "accel.scale",
    "accel.misalignment",
    "axis.attitude",
    "mounting",
    "encoder.zero",
    "table_rate_ripple",
];

/// Whether a term is a signal that can be hidden in a run.
pub fn is_hideable(term: &Term) -> bool {
    matches!(term.action, Action::Signal(_)) && !NEVER_HIDDEN.contains(&term.id)
}

/// A term with its numbers, as the generator takes it.
pub fn hidden(chosen: &Chosen) -> Effect {
    Effect::new(chosen.term.id, &chosen.values, &chosen.settings)
}
