//! The findings of this crate in recordings, compared with their simulation.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod axes;
mod coarse;
mod inspection;
mod late_table;
mod lever_arm;
mod mistakes;
mod rest;
mod run;
mod slow_turn;
mod static_population;
mod stuck;
