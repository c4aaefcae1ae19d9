//! Reproduction of the paper's experiments, compared with its printed results.
//!
//! **What it does.** It reproduces every reproducible figure of the paper (‹nie2019›): the Monte
//! Carlo of its Tables 3 and 4 ([`Campaign`](monte_carlo::Campaign)), the consistency of the filter's covariance
//! ([`coverage`]), the read-out lag of its attitudes ([`readout`]), an emulation of the experiment of its section 5
//! ([`real_test`]), the uncertainty of its estimates ([`uncertainty`]), its claims of precision
//! ([`enhancement`]), convergence ([`convergence`]), modulation ([`rotation`], [`accelerometers`]) and online
//! compensation ([`running`]), and the equations against numerical integration ([`grid`]). [`report`] writes the
//! page of the book with its figures; [`differences`](stale::differences) compares it with the page in the
//! repository.
//!
//! **What it does not do.** It contains no algorithm that belongs to another crate, except
//! [`BiasFilter`](bias_filter::BiasFilter), a filter with gyro biases as states, which shows the effect of their absence in the
//! paper's filter.
//!
//! Numbers are in SI units and radians, except in [`printed`], which keeps the paper's units.

use std::env;
use std::process::ExitCode;

mod accelerometers;
mod bias_filter;
mod causes;
mod convergence;
mod coverage;
mod enhancement;
mod equations;
mod error;
mod experiment;
mod grid;
mod model_coverage;
mod monte_carlo;
mod plain_model;
mod printed;
mod programs;
mod pure_navigation;
mod readout;
mod real_test;
mod report;
mod rotation;
mod running;
mod stale;
mod statistics;
#[cfg(test)]
mod tests;
mod uncertainty;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    programs::run(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}
