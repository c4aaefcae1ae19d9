//! Diagnoses unmodeled effects: prints what `rins diagnose RIG` prints.

use rins::{DiagnoseOptions, Log};

#[expect(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rig = std::env::args().nth(1).ok_or("usage: diagnose RIG")?;
    let diagnosis = rins::diagnose(vec![Log::open(rig)?], DiagnoseOptions::default())?;
    print!("{diagnosis}");
    Ok(())
}
