//! Blind trials of the diagnosis.
//!
//! **What it does.** A [`Trial`] is drawn from a seed: a table, an IMU, a schedule, a level of realism, and what is
//! hidden, so many times its Cramér-Rao bound strong. `rins_blind` makes the run; `rins diagnose` sees its log and
//! its rig file and nothing else; a [`Record`] of its answer goes beside the truth into a journal. [`card`] makes
//! the score card of a journal.
//!
//! **What it does not do.** It judges nothing that it could not judge from the command's JSON: the analyser is a
//! program, and this crate's use of the estimator is to say how strong a hidden effect is, and which
//! rivals the schedule tells from it.
mod trouble;

mod catalogue;
mod stand;

mod laboratory;

mod hide;
mod outside;

mod draw;

mod answer;
mod journal;

mod frozen;

mod certificates;
mod histories;

mod injected_log;
mod injections;
mod injections_page;

mod breakdown;
mod card;
mod null;
mod score;
mod statistics;

mod workers;

pub use answer::{Analyser, Answer, Named};
pub use card::card;
pub use catalogue::{hidden, is_hideable};
pub use certificates::certificates;
pub use draw::{Kind, Trial};
pub use frozen::{Frozen, run_frozen};
pub use hide::Hidden;
pub use histories::{HistoryTrial, history_page, history_trial};
pub use injections::{Injection, InjectionTrial};
pub use injections_page::injections;
pub use journal::{Plan, Population, Record, merge, records, run, time, try_out};
pub use laboratory::{Grade, Laboratory, Length, Level, Schedule};
pub use null::null_page;
pub use outside::Outside;
pub use stand::{ExtraInformation, Stand, StandError, recording};
pub use trouble::Trouble;
