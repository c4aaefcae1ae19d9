//! Integration tests of the calibration.
mod consistency;
mod correlated_noise;
mod lanes;
mod online;
mod soak;
