//! Terms in files: an id, settings, values, which of them are estimated, and how well they are known.

mod read;
mod write;

pub(crate) use read::{Use, read, read_about, refuse_triads, tables};
pub(crate) use write::{parameters, written};
