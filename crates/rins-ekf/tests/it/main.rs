//! The filter and the smoother against estimators written apart, their laws, and their honesty.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod consistency;
mod digits;
mod exact;
mod factorised;
mod laws;
mod random;
mod refusals;
mod truth;
