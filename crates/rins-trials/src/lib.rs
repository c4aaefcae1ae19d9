//! Blind trials of the diagnosis.
//!
//! **What it does.** A [`Trial`] is drawn from a seed: a table, an IMU, a schedule, a level of realism, and what is
//! hidden, so many times its Cramér-Rao bound strong. `rins_blind` makes the run, `rins diagnose` sees its log and
//! its rig file and nothing else, and a [`Record`] of the answer goes beside the truth into a journal. [`card`] makes the score
//! card of a journal.
//!
//! **What it does not do.** It judges nothing that it could not judge from the command's JSON: the analyser is a
//! program, and this crate's use of the estimator is to say how strong a hidden effect is, and which
//! rivals the schedule tells from it.
mod catalogue;
mod stand;

pub use catalogue::{hidden, is_hideable};
pub use stand::{Stand, StandError, Told, recording};
