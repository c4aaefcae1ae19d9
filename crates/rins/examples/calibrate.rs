//! Calibrates a log: prints what `rins calibrate RIG` prints.

use rins::{CalibrateOptions, Log};

#[expect(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rig = std::env::args().nth(1).ok_or("usage: calibrate RIG")?;
    let calibration = rins::calibrate(vec![Log::open(rig)?], &CalibrateOptions::default())?;
    print!("{calibration}");
    Ok(())
}
