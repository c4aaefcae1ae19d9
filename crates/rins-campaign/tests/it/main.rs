//! Integration tests of campaigns.
mod runs;
mod statistics;
mod support;
