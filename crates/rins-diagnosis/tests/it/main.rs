//! Effects hidden in simulated runs are found, and nothing is found where there is nothing.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod dead_zone;
mod events;
mod evidence;
mod gain;
mod hidden;
mod lines;
mod outside;
mod repeated;
mod rounding;
mod several;
mod support;
