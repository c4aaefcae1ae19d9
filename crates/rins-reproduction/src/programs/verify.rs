//! Prints eqs. (6), (8), (9) and (A.5) against numerical integration; fails if a bound is violated.

use std::error::Error;

use crate::accelerometers::{ALL, Left, TURNS, left_over};
use crate::error::ReproductionError;
use crate::experiment::Experiment;
use crate::grid::{ATTITUDES, Errors, RATES, Row, TIMES, grid};

/// Prints the grid; returns whether all bounds are kept.
pub(super) fn run() -> Result<bool, Box<dyn Error>> {
    let broken = print()?;
    if broken > 0 {
        eprintln!("error: {broken} bounds are broken");
    }
    Ok(broken == 0)
}

/// Prints the grid and returns the number of violated bounds.
fn print() -> Result<usize, ReproductionError> {
    let rows = grid(&TIMES, &ATTITUDES, &RATES)?;
    println!(
        "velocity errors [m/s]: printed = eqs. (8), (9); corrected = with the opposite sign; flat = integrated on a flat Earth;\n\
         extended = linear on the round Earth, second order on the flat one; navigator = integrated on the round Earth\n"
    );
    println!(
        "{:>16} {:>5} {:>4}   {:>9} {:>9} {:>9} {:>11} {:>9} {:>9} {:>9}",
        "roll/pitch/yaw",
        "deg/s",
        "s",
        "printed",
        "corrected",
        "flat",
        "corr./flat",
        "extended",
        "navigator",
        "ext./nav.",
    );
    for row in &rows {
        for (axis, name) in ["E", "N"].into_iter().enumerate() {
            print_line(row, axis, name);
        }
    }
    let worst = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).fold(0.0, f64::max);
    println!("\n{} places; largest relative differences of velocity or attitude", rows.len());
    println!(
        "  corrected to integrated flat {:.1e}",
        worst(&|row| row.corrected.relative_to(&row.flat))
    );
    println!("  flat integration to its form {:.1e}", worst(&|row| row.integration));
    println!(
        "  extended to navigator        {:.1e}",
        worst(&|row| row.extended.relative_to(&row.navigated))
    );
    let left = left_over(&Experiment::simulation()?.scenario.imu_error.accel)?;
    print_accelerometers(&left);
    let broken: Vec<String> =
        rows.iter().flat_map(Row::broken).chain(left.iter().flat_map(Left::broken)).collect();
    for bound in &broken {
        println!("broken: {bound}");
    }
    Ok(broken.len())
}

/// Prints the effect of all of Table 1 together after whole turns, and the largest differences over each error alone.
fn print_accelerometers(left: &[Left]) {
    println!(
        "\neq. (A.5): velocity [m/s] that the accelerometer errors of Table 1 leave after {TURNS} turns; mean = the mean over a turn\n\
         times the time, quadrature = numerical, navigator = integrated on the round Earth\n"
    );
    println!(
        "{:>16} {:>5} {:>5}   {:>9} {:>10} {:>9}",
        "roll/pitch/yaw", "deg/s", "s", "mean", "quadrature", "navigator"
    );
    for one in left.iter().filter(|one| one.name == ALL) {
        let [roll, pitch, yaw] = one.attitude;
        for (axis, name) in ["E", "N"].into_iter().enumerate() {
            println!(
                "{:>16} {:>5} {:>5} {name} {:>9.4} {:>10.4} {:>9.4}",
                format!("{roll}/{pitch}/{yaw}"),
                one.rate,
                one.time.round(),
                one.closed[axis],
                one.integrated[axis],
                one.navigated[axis],
            );
        }
    }
    let worst = |of: &dyn Fn(&Left) -> f64| left.iter().map(of).fold(0.0, f64::max);
    println!(
        "\n{} places; largest differences over the size of the error times the time",
        left.len()
    );
    println!(
        "  mean to quadrature           {:.1e}",
        worst(&|one| (one.closed - one.integrated).norm() / one.scale)
    );
    println!(
        "  quadrature to navigator      {:.1e}",
        worst(&|one| (one.integrated - one.navigated).xy().norm() / one.scale)
    );
}

fn print_line(row: &Row, axis: usize, name: &str) {
    let of = |errors: &Errors| errors.velocity[axis];
    let [roll, pitch, yaw] = row.attitude;
    println!(
        "{:>16} {:>5} {:>4} {name} {:>9.4} {:>9.4} {:>9.4} {:>11.4} {:>9.4} {:>9.4} {:>9.5}",
        format!("{roll}/{pitch}/{yaw}"),
        row.rate,
        row.time,
        of(&row.printed),
        of(&row.corrected),
        of(&row.flat),
        of(&row.corrected) / of(&row.flat),
        of(&row.extended),
        of(&row.navigated),
        of(&row.extended) / of(&row.navigated),
    );
}
