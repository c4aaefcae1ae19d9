//! The crate against what was published, or written apart.

mod earth;
