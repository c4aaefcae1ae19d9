//! Units and axes from the numbers themselves: gravity and its rotation, the Earth rate, the table motion.

use nalgebra::Vector3;

use super::sample::{Run, Sample};

/// The maximum relative variation of the specific force in a run at rest.
const STEADY: f64 = 0.02;

/// A slope is significant if it exceeds its standard deviation by this factor.
const SIGNIFICANT: f64 = 8.0;

/// The maximum relative difference between the slopes of half the runs.
const AGREED: f64 = 0.05;

/// The minimum fraction of all rotation that is about the spin axis.
const SPIN_SHARE: f64 = 0.9;

/// The magnitude of a triad's reading where it is constant, and its mean there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steady {
    pub(super) norm: f64,
    pub(super) mean: Vector3<f64>,
}

/// The rows of a triad in a run; NaN where a field is not a number.
fn rows(run: &Run, triad: [usize; 3]) -> Vec<Vector3<f64>> {
    let [x, y, z] = triad;
    let row = |index: usize| Vector3::new(run[x][index], run[y][index], run[z][index]);
    (0..run[x].len()).map(row).collect()
}

/// The constant magnitude that most runs share; `None` if it is not constant in any run.
pub(super) fn steady(sample: &Sample, triad: [usize; 3]) -> Option<Steady> {
    let mut found: Vec<Steady> = sample
        .runs
        .iter()
        .filter_map(|run| {
            let rows: Vec<_> =
                rows(run, triad).into_iter().filter(|row| row.norm().is_finite()).collect();
            let count = rows.len() as f64;
            let norm = rows.iter().map(Vector3::norm).sum::<f64>() / count;
            let spread = rows.iter().map(|row| (row.norm() - norm).powi(2)).sum::<f64>() / count;
            let mean = rows.iter().sum::<Vector3<f64>>() / count;
            let is_steady = rows.len() > 1 && norm > 0.0 && spread.sqrt() < STEADY * norm;
            is_steady.then_some(Steady { norm, mean })
        })
        .collect();
    found.sort_by(|a, b| a.norm.total_cmp(&b.norm));
    found.get(found.len() / 2).copied()
}

/// The rotation of the body per row and per unit of the gyros' numbers \[rad\], from the rotation of gravity in the body:
/// `f' = −ω × f`.
///
/// It is negative if the axes of the two sensors do not agree. A constant force in the body frame, such as a centripetal
/// force, makes it too small. `None` if the runs disagree, for instance if the body is rotated by hand and also accelerated.
pub(super) fn turning_of_gravity(
    sample: &Sample,
    gyro: [usize; 3],
    accel: [usize; 3],
) -> Option<f64> {
    let slopes: Vec<f64> =
        sample.runs.iter().filter_map(|run| slope(&rows(run, gyro), &rows(run, accel))).collect();
    let middle = median(slopes.iter().copied())?;
    let spread = median(slopes.iter().map(|slope| (slope - middle).abs()))?;
    (slopes.len() > 1 && spread < AGREED * middle.abs()).then_some(middle)
}

/// The slope of the rotation of gravity against that of the gyros, if it is significant.
fn slope(rates: &[Vector3<f64>], forces: &[Vector3<f64>]) -> Option<f64> {
    let pairs: Vec<(Vector3<f64>, Vector3<f64>)> = rates
        .iter()
        .skip(1)
        .zip(forces.windows(3))
        .map(|(rate, around)| ((around[2] - around[0]) / 2.0, -rate.cross(&around[1])))
        .filter(|(change, predicted)| (change + predicted).norm().is_finite())
        .collect();
    let power: f64 = pairs.iter().map(|(_, predicted)| predicted.norm_squared()).sum();
    let slope = pairs.iter().map(|(change, predicted)| change.dot(predicted)).sum::<f64>() / power;
    let rest: f64 = pairs.iter().map(|(change, p)| (change - p * slope).norm_squared()).sum();
    let sigma = (rest / (3 * pairs.len()) as f64 / power).sqrt();
    (slope.abs() > SIGNIFICANT * sigma).then_some(slope)
}

/// The magnitude of the gyros' mean reading in the quietest run, if it exceeds the noise.
pub(super) fn least_rate(sample: &Sample, gyro: [usize; 3]) -> Option<f64> {
    let of_run = |run: &Run| {
        let rows: Vec<_> =
            rows(run, gyro).into_iter().filter(|row| row.norm().is_finite()).collect();
        let count = rows.len() as f64;
        let mean = rows.iter().sum::<Vector3<f64>>() / count;
        let spread = rows.iter().map(|row| (row - mean).norm_squared()).sum::<f64>() / count;
        (rows.len() > 9).then_some((mean.norm(), (spread / count).sqrt()))
    };
    let runs = sample.runs.iter().filter_map(of_run);
    let (norm, sigma) = runs.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (norm > 10.0 * sigma).then_some(norm)
}

/// The motion of the table in a run.
struct TableRun {
    /// The median of the column's steps, or of its rates.
    table: f64,
    /// The gyros' median reading.
    gyro: Vector3<f64>,
}

/// The runs in which the table rotates at a constant rate. Its column is an angle or a rate.
fn table_runs(sample: &Sample, gyro: [usize; 3], column: usize, is_angle: bool) -> Vec<TableRun> {
    let of_run = |run: &Run| {
        let values: Vec<f64> = if is_angle {
            run[column].windows(2).map(|pair| pair[1] - pair[0]).collect()
        } else {
            run[column].clone()
        };
        let table = median(values.iter().copied())?;
        let spread = median(values.iter().map(|value| (value - table).abs()))?;
        if table.abs() <= 3.0 * spread {
            return None;
        }
        let [x, y, z] = gyro.map(|axis| median(run[axis].iter().copied()));
        Some(TableRun { table, gyro: Vector3::new(x?, y?, z?) })
    };
    let runs: Vec<TableRun> = sample.runs.iter().filter_map(of_run).collect();
    let fastest = runs.iter().map(|run| run.table.abs()).fold(0.0, f64::max);
    runs.into_iter().filter(|run| run.table.abs() > 0.1 * fastest).collect()
}

/// The steps of the table angle, or the table rate, per unit of the gyros' numbers.
pub(super) fn turning_of_table(
    sample: &Sample,
    gyro: [usize; 3],
    column: usize,
    is_angle: bool,
) -> Option<f64> {
    let runs = table_runs(sample, gyro, column, is_angle);
    median(runs.iter().map(|run| run.table.abs() / run.gyro.norm()))
}

/// The size of the jumps at which an angle wraps around, if it does.
pub(super) fn wrap(sample: &Sample, column: usize) -> Option<f64> {
    let steps = |run: &Run| -> Vec<f64> {
        run[column].windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect()
    };
    let steps: Vec<f64> = sample.runs.iter().flat_map(steps).collect();
    let usual = median(steps.iter().copied())?;
    let jumps = steps.iter().copied().filter(|step| *step > 50.0 * usual);
    median(jumps).filter(|_| usual > 0.0)
}

/// The axis with almost all of the rotation, and its fraction of it: from the table motion, with its sign, if there is a table,
/// and otherwise from the runs with the most rotation.
pub(super) fn spin_axis(
    sample: &Sample,
    gyro: [usize; 3],
    table: Option<(usize, bool)>,
) -> Option<(String, f64)> {
    let mut turns: Vec<Vector3<f64>> = match table {
        Some((column, is_angle)) => {
            let runs = table_runs(sample, gyro, column, is_angle);
            runs.iter().map(|run| run.gyro * run.table.signum()).collect()
        }
        None => {
            let of_run = |run: &Run| {
                let [x, y, z] = gyro.map(|axis| median(run[axis].iter().copied()));
                Some(Vector3::new(x?, y?, z?))
            };
            sample.runs.iter().filter_map(of_run).collect()
        }
    };
    let norms = || turns.iter().map(Vector3::norm);
    let (most, least) = (norms().fold(0.0, f64::max), norms().fold(f64::INFINITY, f64::min));
    if table.is_none() && most < 20.0 * least {
        return None;
    }
    turns.retain(|turn| turn.norm() > 0.1 * most);
    let axis = turns.iter().map(Vector3::abs).sum::<Vector3<f64>>().imax();
    let about = turns.iter().map(|turn| turn[axis].abs()).sum::<f64>();
    let share = about / turns.iter().map(Vector3::norm).sum::<f64>();
    if turns.is_empty() || share < SPIN_SHARE {
        return None;
    }
    let forward = turns.iter().filter(|turn| turn[axis] > 0.0).count();
    let sign = match (table, forward) {
        (None, _) => "",
        (_, 0) => "-",
        (_, all) if all == turns.len() => "",
        _ => return None,
    };
    Some((format!("{sign}{}", ["x", "y", "z"][axis]), share))
}

/// The median of the finite numbers.
fn median(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    rins_motion::median(numbers.filter(|number| number.is_finite()))
}
