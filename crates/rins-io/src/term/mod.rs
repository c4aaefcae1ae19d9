//! Terms in files: id, settings, values, estimated parameters, and sigmas.

mod read;
mod write;

pub(crate) use read::{Use, read, read_about, refuse_triads, tables};
pub(crate) use write::{parameters, written};
