//! Tests of the library from the view of a program that depends on it.
#![expect(clippy::unwrap_used, reason = "helpers of tests, and not tests themselves, unwrap too")]

mod campaign;
mod live;
mod merge;
mod read_back;
mod schema;
