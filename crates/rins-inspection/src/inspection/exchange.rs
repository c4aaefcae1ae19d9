//! Exchanged columns of gyros and accelerometers.

use super::suspicion::Suspicion;
use super::whole_turns::{STANDS, WholeTurns};
use rins_motion::Recording;

/// The smallest correlation of a channel with the table rate, and the largest one of an unrelated channel.
const FOLLOWS: f64 = 0.95;
const IGNORES: f64 = 0.5;

/// The channel that correlates with the table's rotation: an accelerometer instead of a gyro.
///
/// Correlations do not depend on units, which are wrong too if columns are exchanged.
pub(super) fn suspicion(recording: &Recording, table_angle: Option<&[f64]>) -> Option<Suspicion> {
    let angle = table_angle?;
    let samples = recording.increments.get(1..)?;
    let turns = angle.windows(2).zip(samples).map(|(pair, s)| (pair[1] - pair[0]) / s.interval);
    let turns: Vec<f64> = turns.collect();
    let of = |channel: fn(&rins_frames::Rates) -> f64| {
        let readings: Vec<f64> = samples.iter().map(|sample| channel(&sample.rates())).collect();
        correlation(&readings, &turns).map(f64::abs)
    };
    let gyro = of(|rates| rates.angular_rate.components().x)?
        .max(of(|rates| rates.angular_rate.components().y)?)
        .max(of(|rates| rates.angular_rate.components().z)?);
    let accel = of(|rates| rates.specific_force.components().x)?
        .max(of(|rates| rates.specific_force.components().y)?)
        .max(of(|rates| rates.specific_force.components().z)?);
    (accel > FOLLOWS && gyro < IGNORES).then_some(Suspicion::Triads { gyro, accel })
}

/// The same for a constant table rate, which has no correlation: the gyros measure a vector that is fixed while the body
/// rotates, which is gravity, and the accelerometers do not.
pub(super) fn in_turns(turns: &WholeTurns) -> Option<Suspicion> {
    let [accel, gyro] = turns.standing();
    (gyro > STANDS && accel < gyro / 10.0).then_some(Suspicion::TurningTriads { gyro, accel })
}

/// The correlation; `None` if one of the lists is constant.
fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut product, mut square_a, mut square_b) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        product += (a - mean_a) * (b - mean_b);
        square_a += (a - mean_a).powi(2);
        square_b += (b - mean_b).powi(2);
    }
    let scale = (square_a * square_b).sqrt();
    (scale > 0.0).then(|| product / scale)
}
