//! Tests of the generator against what is written apart from it.

mod agreement;
mod bench;
