//! The paper's experiments, run again and set beside what it prints.
//!
//! **What it does.** Every figure of the paper (‹nie2019›) that can be had again is: the Monte
//! Carlo of its Tables 3 and 4 ([`Campaign`](monte_carlo::Campaign)), the honesty of the filter's covariance
//! ([`coverage`]), the read-out lag that its attitudes hold ([`readout`]), the experiment of its section 5,
//! emulated ([`real_test`]), the uncertainty of its estimates ([`uncertainty`]), its claims of precision
//! ([`enhancement`]), convergence ([`convergence`]), modulation ([`rotation`], [`accelerometers`]) and online
//! compensation ([`running`]), and the equations against numerical integration ([`grid`]). [`report`] turns all
//! of it into a page of the book and its figures; [`differences`](stale::differences) says where a page kept in the
//! repository has fallen behind.
//!
//! **What it does not do.** It holds no algorithm that the other crates should have, but for one:
//! [`BiasFilter`](bias_filter::BiasFilter), a filter with gyro biases among its states, shows what the paper's filter lacks.
//!
//! Numbers are in SI units and radians, but in [`printed`], which keeps the paper's.

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
