//! Integration tests of campaigns.
mod posteriors;
mod runs;
mod statistics;
mod support;
