//! Structures without a physical cause.

pub(crate) mod between_runs;
pub(crate) mod disturbance;
pub(crate) mod waveform;

use rins_terms::{Prevalence, Term};

/// Whether a term has no physical cause.
pub(crate) fn is_generic(term: &Term) -> bool {
    term.prevalence == Prevalence::Unknown
}
