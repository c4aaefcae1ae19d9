//! The paper's experiments, small enough for every test run.
mod filter;
mod mechanism;
mod model_coverage;
mod navigation;
mod page;
mod real_test;
