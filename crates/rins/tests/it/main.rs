//! Tests of the library as a program that depends on it sees it.
#![expect(clippy::unwrap_used, reason = "helpers of tests, and not tests themselves, unwrap too")]

mod read_back;
mod schema;
