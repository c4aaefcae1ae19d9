//! What an inertial measurement unit gets wrong, and how to undo it.
mod spec;

pub use spec::{ImuSpec, TriadSpec};
