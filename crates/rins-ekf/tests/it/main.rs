//! The filter and the smoother compared with independent estimators, their laws, and their consistency.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod consistency;
mod digits;
mod exact;
mod factorised;
mod laws;
mod random;
mod refusals;
mod truth;
