//! The estimator compared with simulated runs, closed forms and itself.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod batch_and_filter;
mod colour;
mod gravity;
mod latency;
mod left_out;
mod mountings;
mod online;
mod prior_consistency;
mod refusals;
mod rests;
mod rounding;
mod several_runs;
mod shortcuts;
mod support;
mod sway;
mod temperatures;
mod terms;
mod turns;
mod unobservable;
