//! One file a command: from its arguments to its outcome.

pub(crate) mod align;
pub(crate) mod allan;
pub(crate) mod apply;
pub(crate) mod calibrate;
pub(crate) mod campaign_runs;
mod campaign_size;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod diagnose;
pub(crate) mod init;
pub(crate) mod merge;
pub(crate) mod monte_carlo;
pub(crate) mod navigate;
pub(crate) mod observe;
pub(crate) mod range;
pub(crate) mod repairs;
mod setup;
pub(crate) mod simulate;
pub(crate) mod statics;
