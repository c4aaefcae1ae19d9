//! The results of this crate compared with independent calculations.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

mod alignment;
mod closed_form;
mod fine_alignment;
mod linear_model;
mod moving;
mod oscillations;
mod schuler;
mod strapdown;
mod support;
mod truth;
