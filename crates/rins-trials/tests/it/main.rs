//! Tests of the generator against what is written apart from it, and of the trials as they are drawn and kept.

mod agreement;
mod bench;
mod draws;
mod journal;
