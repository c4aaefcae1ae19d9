//! Integration tests of the calibration.
mod consistency;
mod lanes;
mod online;
mod soak;
