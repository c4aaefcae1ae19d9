//! The paper's experiments, at a scale for every test run.
mod filter;
mod mechanism;
mod model_coverage;
mod navigation;
mod page;
mod real_test;
