//! A Monte Carlo campaign of a hundred runs: are the covariances of the paper's filter consistent with its errors?

use rins::{MonteCarloOptions, Outcome};

#[expect(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenario = std::env::args().nth(1).ok_or("usage: campaign SCENARIO")?;
    let folder = tempfile::tempdir()?;
    let options = MonteCarloOptions::new(100, folder.path().join("runs.parquet"));
    let campaign = rins::monte_carlo(scenario.as_ref(), &options)?;
    for cell in campaign.result().cells {
        println!("NEES {:.3?} within {:.3?}", cell.nees, cell.nees_bounds_99);
    }
    Ok(())
}
