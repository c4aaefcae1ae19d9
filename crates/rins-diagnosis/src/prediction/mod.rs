//! What the causes gain on data that were not used for the fit.

pub(crate) mod drift;
pub(crate) mod gain;
pub(crate) mod overlay;
pub(crate) mod spans;
