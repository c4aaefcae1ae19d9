//! Prints the coverage of the estimator of `Model::full()`; fails if it is not consistent.

use std::error::Error;

use crate::error::ReproductionError;
use crate::model_coverage::{Colour, Coverage, Schedule, coverage};
use indicatif::ProgressBar;
use rins_frames::units::DEG_PER_HOUR;

/// The default number of runs of each kind.
pub(super) const RUNS: usize = 200;

/// Prints a table; returns whether all figures are within their bounds.
pub(super) fn run(n_runs: usize) -> Result<bool, Box<dyn Error>> {
    let faults = table(n_runs)?;
    if faults > 0 {
        eprintln!("error: {faults} figures are not those of a consistent estimator");
    }
    Ok(faults == 0)
}

/// Prints a table and returns the number of figures out of bounds.
fn table(n_runs: usize) -> Result<usize, ReproductionError> {
    println!(
        "| schedule | noise | pooled 95 % | each | NEES of 27 | variance / bound, at most | B found [deg/h] |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: |");
    let mut faults = Vec::new();
    for colour in [Colour::WHITE, Colour::FAINT, Colour::STRONG] {
        for schedule in Schedule::ALL {
            let bar = ProgressBar::new(n_runs as u64);
            let figures = coverage(schedule, &colour, n_runs, || bar.inc(1))?;
            bar.finish_and_clear();
            println!("{}", row(schedule, &colour, &figures));
            let name = format!("{}, {}", schedule.name(), colour.name());
            faults.extend(figures.faults().into_iter().map(|fault| format!("{name}: {fault}")));
        }
    }
    for fault in &faults {
        println!("{fault}");
    }
    Ok(faults.len())
}

fn row(schedule: Schedule, colour: &Colour, figures: &Coverage) -> String {
    let least = figures.each.iter().copied().fold(1.0, f64::min);
    let most = figures.each.iter().copied().fold(0.0, f64::max);
    let ratio = figures.variance_ratio.iter().copied().fold(0.0, f64::max);
    format!(
        "| {} | {} | {:.4} | {least:.3}-{most:.3} | {:.2} ± {:.2} | {ratio:.2} | {:.4} |",
        schedule.name(),
        colour.name(),
        figures.pooled,
        figures.nees,
        figures.nees_sigma,
        figures.flicker / DEG_PER_HOUR,
    )
}
