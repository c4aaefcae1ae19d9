//! The paper's experiments, small enough for every test run.
mod filter;
mod mechanism;
mod navigation;
mod page;
mod real_test;
