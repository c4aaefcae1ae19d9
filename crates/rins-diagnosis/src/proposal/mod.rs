//! Where the search looks: the catalogue on a grid of settings, and what the innovations suggest.

pub(crate) mod candidates;
pub(crate) mod dead_zone;
pub(crate) mod harmonics;
pub(crate) mod jolt;
pub(crate) mod lines;
pub(crate) mod sinusoid;
pub(crate) mod spectrum;
pub(crate) mod suggested;
