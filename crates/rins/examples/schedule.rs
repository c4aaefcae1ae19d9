//! The shortest schedule that distinguishes a g-sensitivity from the lever arm of the accelerometers.

use rins::{ObserveOptions, Outcome};

#[expect(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scenario = std::env::args().nth(1).ok_or("usage: schedule SCENARIO")?;
    let separate = Some(["gyro_g_sensitivity", "accel_lever_arm"].map(String::from));
    let options = ObserveOptions { separate, ..ObserveOptions::default() };
    let observability = rins::observe(&[scenario.into()], &options)?;
    match observability.result().proposal {
        None => println!("this schedule separates them"),
        Some(proposal) => println!("run next: {}", proposal.schedule),
    }
    Ok(())
}
