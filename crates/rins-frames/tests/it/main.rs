//! The crate against published values and independent implementations.

mod earth;
