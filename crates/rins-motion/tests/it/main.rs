//! What this crate computes, against what was written apart from it.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod alignment;
mod axes;
mod closed_form;
mod fine_alignment;
mod inspection;
mod late_table;
mod linear_model;
mod mistakes;
mod moving;
mod oscillations;
mod rest;
mod run;
mod schuler;
mod slow_turn;
mod static_population;
mod strapdown;
mod stuck;
mod support;
mod truth;
