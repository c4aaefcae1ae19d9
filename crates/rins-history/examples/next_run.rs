//! What the next run of a drifting gyro will show.
#![expect(clippy::print_stdout, reason = "an example prints")]

use nalgebra::DMatrix;
use rins_history::{Conditions, History, HistoryError, Quantity, RunEstimate};

fn main() -> Result<(), HistoryError> {
    let on = |power_on: usize, day: f64| Conditions {
        power_on,
        date: Some(day),
        ..Conditions::default()
    };
    let measured = [(0.0, 84.1), (30.0, 86.3), (61.0, 88.0), (92.0, 90.4), (122.0, 92.2)];
    let runs = measured.iter().enumerate().map(|(run, &(day, ppm))| {
        let variance = DMatrix::from_element(1, 1, 0.3 * 0.3);
        RunEstimate::measured(on(run, day), (1, &[0]), &[ppm], &variance)
    });
    let scale = Quantity { id: "gyro.scale.z".into(), typical: (1.0, 300.0) };
    let history = History::new(vec![scale], runs.collect::<Result<_, _>>()?)?;
    let explanation = history.explain();
    for cause in explanation.causes() {
        println!("{}: {}, p < {:.1e}", cause.id, cause.variation.kind().name(), cause.ln_p.exp());
        for one in &cause.alternatives {
            println!("    {:.3} {}", one.probability, one.kind.name());
        }
    }
    for day in [150.0, 365.0] {
        if let Some(forecast) = explanation.forecast(0, on(5, day))? {
            let (low, high) = forecast.interval(0.95);
            println!("day {day}: {:.1} ppm, 95 % {low:.1} to {high:.1} ppm", forecast.mean());
        }
    }
    Ok(())
}
