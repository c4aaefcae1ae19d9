//! What the terms add, against what was written apart from them.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]
#![expect(clippy::float_cmp, reason = "what is left alone is the same to the last bit")]

mod catalogue;
mod derivatives;
mod identities;
mod lever_arm;
mod line;
mod log;
mod model;
mod noise;
mod page;
mod ramps;
mod sensors;
mod support;
mod tilt;
mod timing;
mod track;
mod triads;
