//! The `rins` command as its users meet it.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod bad_input;
mod demo;
mod help;
mod measured;
mod round_trip;
mod support;
mod synthetic;
