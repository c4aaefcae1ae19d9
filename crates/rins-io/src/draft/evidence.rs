//! What the numbers themselves show: gravity, its turning, the Earth's rotation, the table's.

use nalgebra::Vector3;

use super::sample::{Run, Sample};

/// How much the magnitude of a specific force may vary within a run at rest, relative.
const STEADY: f64 = 0.02;

/// A slope is believed if it is this many times its standard deviation.
const SIGNIFICANT: f64 = 8.0;

/// How much the slopes of half the runs may differ, relative.
const AGREED: f64 = 0.05;

/// The share of all turning that the spin axis must carry.
const SPIN_SHARE: f64 = 0.9;

/// The magnitude of a triad's reading where that is steady, and its mean there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steady {
    pub(super) norm: f64,
    pub(super) mean: Vector3<f64>,
}

/// The rows of a triad in a run; not a number where a field is none.
fn rows(run: &Run, triad: [usize; 3]) -> Vec<Vector3<f64>> {
    let [x, y, z] = triad;
    let row = |index: usize| Vector3::new(run[x][index], run[y][index], run[z][index]);
    (0..run[x].len()).map(row).collect()
}

/// The magnitude that most runs with a steady one have; `None` if no run has.
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

/// How far one of the gyros' numbers turns the body from row to row \[rad\], by how gravity turns
/// against it: `f' = −ω × f`.
///
/// It is negative if the axes of the two sensors do not belong together. A constant force along the
/// body, such as that towards the axis of a wheel, makes it too small. `None` if runs disagree, as
/// where a hand that turns the body also pushes it.
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

/// The slope of gravity's turning over that which the gyros tell, if it stands out.
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

/// The magnitude of the gyros' mean reading in the quietest run, if it stands out from the noise.
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

/// What the table did in a run.
struct TableRun {
    /// The median of the column's steps, or of its rates.
    table: f64,
    /// The gyros' median reading.
    gyro: Vector3<f64>,
}

/// The runs in which the table turns steadily. Its column is an angle, or a rate.
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

/// The steps of the table's angle, or its rates, per one of the gyros' numbers.
pub(super) fn turning_of_table(
    sample: &Sample,
    gyro: [usize; 3],
    column: usize,
    is_angle: bool,
) -> Option<f64> {
    let runs = table_runs(sample, gyro, column, is_angle);
    median(runs.iter().map(|run| run.table.abs() / run.gyro.norm()))
}

/// The size of the jumps by which an angle is wrapped, if it is.
pub(super) fn wrap(sample: &Sample, column: usize) -> Option<f64> {
    let steps = |run: &Run| -> Vec<f64> {
        run[column].windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect()
    };
    let steps: Vec<f64> = sample.runs.iter().flat_map(steps).collect();
    let usual = median(steps.iter().copied())?;
    let jumps = steps.iter().copied().filter(|step| *step > 50.0 * usual);
    median(jumps).filter(|_| usual > 0.0)
}

/// The axis that carries almost all turning, and its share of it; by the table's motion, with its
/// sign, where there is a table, and else by the runs with the most turning.
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

/// The median of the numbers that are finite.
fn median(numbers: impl Iterator<Item = f64>) -> Option<f64> {
    rins_motion::median(numbers.filter(|number| number.is_finite()))
}
