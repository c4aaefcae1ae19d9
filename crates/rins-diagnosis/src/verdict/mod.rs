//! What is reported: causes, credible sets, detection limits and false alarms.

pub(crate) mod cause;
pub(crate) mod false_alarms;
pub(crate) mod limits;
pub(crate) mod named;
