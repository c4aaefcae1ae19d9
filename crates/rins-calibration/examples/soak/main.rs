//! A day at 200 Hz: the covariance at every step, and the time that the filter takes.
#![expect(clippy::print_stdout, reason = "an example prints")]

mod case;

use std::time::Instant;

use case::Soak;

/// At 200 Hz.
const STEPS_A_MINUTE: u32 = 12_000;

fn main() -> Result<(), String> {
    let minutes = std::env::args().nth(1).map_or(Ok(24 * 60), |minutes| minutes.parse::<u32>());
    let steps = minutes.map_err(|error| error.to_string())? * STEPS_A_MINUTE;
    println!("{steps} steps of one prediction and one update by six rows");
    soak::<12>(steps)?;
    soak::<24>(steps)?;
    soak::<40>(steps)
}

fn soak<const N: usize>(steps: u32) -> Result<(), String> {
    let start = Instant::now();
    let mut alone = Soak::<N>::new();
    for _ in 0..steps {
        alone.step();
    }
    let seconds = start.elapsed().as_secs_f64();
    let mut checked = Soak::<N>::new();
    for _ in 0..steps {
        checked.step();
        if let Some(fault) = checked.fault() {
            return Err(format!("{N} states: {fault}"));
        }
    }
    let least = (0..N).map(|state| checked.sigma(state)).fold(f64::INFINITY, f64::min);
    println!(
        "{N} states: {seconds:.2} s, {:.0} ns a step; symmetric and positive definite after every step; the smallest sigma is {least:.1e}",
        seconds / f64::from(steps) * 1e9
    );
    Ok(())
}
