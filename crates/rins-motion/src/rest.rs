//! When an IMU stands still, and what it measures on average then.

mod drift;

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::{DEG, DEG_PER_SECOND};
use rins_frames::{InFrame, Rates};

use crate::median::median;
use crate::recording::Recording;

/// The stretch over which rest is judged \[s\].
const WINDOW: f64 = 1.0;

/// A table that turns more slowly than this \[rad/s\] stands still: 7.2″ a second, half the Earth's
/// rate, and seven sigma of what an encoder's noise of 2″ at 50 Hz feigns over a second.
const SLOWEST_TABLE_RATE: f64 = 0.002 * DEG_PER_SECOND;

/// Without a table, a mean rate above this \[rad/s\] is a turn rather than a gyro bias.
const LARGEST_BIAS: f64 = 1.0 * DEG_PER_SECOND;

/// A window moves if its scatter is so many times that of the quietest tenth of all windows.
const SCATTER_RATIO: f64 = 4.0;

/// Up to [`SCATTER_RATIO`] times this \[rad/s\] a gyro's scatter is a footstep or a shock, which
/// leaves the IMU where it was, however quiet the sensor is otherwise.
const LEAST_GYRO_SCATTER: f64 = 0.125 * DEG_PER_SECOND;

/// Without a table, a mean rate that is so far from the median of all rests \[rad/s\] is a slow turn.
const LARGEST_RATE_CHANGE: f64 = 0.05 * DEG_PER_SECOND;

/// So many sigma of a noisy gyro's mean are no turn either.
const NOISE_SIGMAS: f64 = 6.0;

/// What [`LEAST_GYRO_SCATTER`] is to gyros, to accelerometers \[m/s²\].
const LEAST_ACCEL_SCATTER: f64 = 1e-7;

/// A disturbance of at most so long \[s\] ...
const LONGEST_DISTURBANCE: f64 = 10.0;

/// ... after which the IMU stands as before, to within this angle \[rad\], does not end a rest.
const LARGEST_DISTURBANCE: f64 = 0.5 * DEG;

/// The mean rates over a stretch of rest, and how far they scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestMean {
    /// The means.
    pub rates: Rates,
    /// The stretch's length \[s\].
    pub duration: f64,
    /// The 1σ of each gyro's mean that the scatter of its parts' means shows \[rad/s\].
    pub angular_rate_sigma: Vector3<f64>,
    /// The same of each accelerometer's mean \[m/s²\].
    pub specific_force_sigma: Vector3<f64>,
}

impl RestMean {
    /// The means over samples `span` of a recording, or `None` if the span is outside or holds
    /// fewer than two samples, which show no scatter.
    ///
    /// Their sigma is that of up to 20 batch means over the root of their number, which holds for
    /// white noise and for drifts that are short against the span; a constant bias does not show
    /// in it. It is itself uncertain by a sixth.
    pub fn of(recording: &Recording, span: Range<usize>) -> Option<Self> {
        const BATCHES: usize = 20;
        let samples = recording.increments.get(span).filter(|samples| samples.len() > 1)?;
        let (rates, duration) = mean(samples);
        let size = samples.len().div_ceil(BATCHES);
        let batches: Vec<Rates> = samples.chunks_exact(size).map(|batch| mean(batch).0).collect();
        let count = batches.len() as f64;
        let spread = |of: fn(&Rates) -> Vector3<f64>| {
            let square = |sum: Vector3<f64>, batch: &Rates| {
                let off = of(batch) - of(&rates);
                sum + off.component_mul(&off)
            };
            let variance = batches.iter().fold(Vector3::zeros(), square) / (count - 1.0);
            variance.map(|variance| (variance / count).sqrt())
        };
        Some(Self {
            rates,
            duration,
            angular_rate_sigma: spread(|rates| *rates.angular_rate.components()),
            specific_force_sigma: spread(|rates| *rates.specific_force.components()),
        })
    }
}

/// The stretches of at least `shortest` \[s\] over which the IMU stood still, as ranges of samples.
///
/// Where the table's angle or rate is known, it must stand; the IMU's own scatter over a second
/// must in any case be near that of the quietest seconds. Where the table is not known, neither may
/// gravity turn in the body, beyond what a base sways: a turn that is too slow to tell from a gyro
/// bias shows in it, unless it is about the vertical.
pub fn rest_spans(recording: &Recording, shortest: f64) -> Vec<Range<usize>> {
    let windows = windows(recording);
    let quiet = |of: fn(&Window) -> f64, least: f64| {
        let mut scatter: Vec<f64> = windows.iter().filter(|window| window.stands).map(of).collect();
        scatter.sort_by(f64::total_cmp);
        scatter.get(scatter.len() / 10).map_or(0.0, |quiet| quiet.max(least) * SCATTER_RATIO)
    };
    let gyro_noise = quiet(|window| window.gyro_noise, 0.0) / SCATTER_RATIO;
    let gyro = quiet(|window| window.gyro_scatter, LEAST_GYRO_SCATTER);
    let accel = quiet(|window| window.accel_scatter, LEAST_ACCEL_SCATTER);
    let quiet = |window: &Window| {
        window.stands && window.gyro_scatter <= gyro && window.accel_scatter <= accel
    };
    let usual_rate = usual_rate(windows.iter().filter(|window| quiet(window)));
    let at_rest = |window: &Window| {
        // The mean of a coarse gyro's second scatters more than a good one's rate changes.
        let noise = gyro_noise / (window.span.len() as f64).sqrt();
        let turns =
            (window.rate - usual_rate).norm() > LARGEST_RATE_CHANGE.max(NOISE_SIGMAS * noise);
        quiet(window) && (window.table_known || !turns)
    };

    // A footstep moves no table, and an IMU that is where it was before has not left its rest.
    let undisturbed = |gap: Range<usize>| {
        let samples = &recording.increments[gap];
        let lasting: f64 = samples.iter().map(|sample| sample.interval).sum();
        let turn: Vector3<f64> = samples.iter().map(|sample| sample.angle.components()).sum();
        lasting <= LONGEST_DISTURBANCE
            && (turn - usual_rate * lasting).norm() < LARGEST_DISTURBANCE
            && !windows.iter().any(|window| window.table_known)
    };
    let mut rests: Vec<Vec<&Window>> = Vec::new();
    for window in windows.iter().filter(|window| at_rest(window)) {
        let gap =
            rests.last().and_then(|rest| rest.last()).map(|last| last.span.end..window.span.start);
        match rests.last_mut() {
            Some(rest) if gap.is_some_and(|gap| gap.is_empty() || undisturbed(gap)) => {
                rest.push(window);
            }
            _ => rests.push(vec![window]),
        }
    }
    let mut spans: Vec<Range<usize>> = rests.iter().flat_map(|rest| still_parts(rest)).collect();
    spans.retain(|span| {
        let lasting: f64 =
            recording.increments[span.clone()].iter().map(|sample| sample.interval).sum();
        lasting >= shortest * (1.0 - 1e-9)
    });
    spans
}

/// The parts of a rest in which the IMU does not turn so slowly that only gravity shows it.
fn still_parts(rest: &[&Window]) -> Vec<Range<usize>> {
    let span = |part: &[&Window]| part[0].span.start..part[part.len() - 1].span.end;
    if rest.iter().any(|window| window.table_known) {
        return vec![span(rest)];
    }
    let forces: Vec<Vector3<f64>> = rest.iter().map(|window| window.force).collect();
    drift::parts(&forces).into_iter().map(|part| span(&rest[part])).collect()
}

/// The median of each component of the windows' mean rates.
fn usual_rate<'a>(windows: impl Iterator<Item = &'a Window>) -> Vector3<f64> {
    let rates: Vec<Vector3<f64>> = windows.map(|window| window.rate).collect();
    Vector3::from_fn(|axis, _| median(rates.iter().map(|rate| rate[axis])).unwrap_or_default())
}

struct Window {
    span: Range<usize>,
    stands: bool,
    table_known: bool,
    /// The mean angular rate \[rad/s\].
    rate: Vector3<f64>,
    /// The mean specific force \[m/s²\].
    force: Vector3<f64>,
    gyro_scatter: f64,
    /// What is left of that in differences between neighbours, which motion hardly shows in \[rad/s\].
    gyro_noise: f64,
    accel_scatter: f64,
}

fn windows(recording: &Recording) -> Vec<Window> {
    let mut windows = Vec::new();
    let mut start = 0;
    let mut elapsed = 0.0;
    for (index, sample) in recording.increments.iter().enumerate() {
        elapsed += sample.interval;
        if elapsed >= WINDOW * (1.0 - 1e-9) {
            windows.push(window(recording, start..index + 1));
            start = index + 1;
            elapsed = 0.0;
        }
    }
    windows
}

fn window(recording: &Recording, span: Range<usize>) -> Window {
    let samples = &recording.increments[span.clone()];
    let (rates, duration) = mean(samples);
    let scatter = |of: fn(&Rates) -> Vector3<f64>| {
        let sum: f64 =
            samples.iter().map(|sample| (of(&sample.rates()) - of(&rates)).norm_squared()).sum();
        (sum / samples.len() as f64).sqrt()
    };
    let differences: f64 = samples
        .windows(2)
        .map(|pair| {
            let (before, after) = (pair[0].rates().angular_rate, pair[1].rates().angular_rate);
            (after - before).components().norm_squared()
        })
        .sum();
    let table_rate = recording
        .table_rate
        .as_ref()
        .map(|rate| rate[span.clone()].iter().fold(0.0, |most: f64, rate| most.max(rate.abs())))
        .or_else(|| {
            recording.table_angle.as_ref().map(|angle| slope(&angle[span.clone()], duration))
        });
    Window {
        stands: match table_rate {
            Some(rate) => rate.abs() < SLOWEST_TABLE_RATE,
            None => rates.angular_rate.norm() < LARGEST_BIAS,
        },
        table_known: table_rate.is_some(),
        rate: *rates.angular_rate.components(),
        force: *rates.specific_force.components(),
        gyro_scatter: scatter(|rates| *rates.angular_rate.components()),
        gyro_noise: (differences / (2.0 * samples.len() as f64)).sqrt(),
        accel_scatter: scatter(|rates| *rates.specific_force.components()),
        span,
    }
}

/// The mean slope of equally spaced readings: the last third's mean less the first third's.
///
/// A difference of two readings would carry the encoder's noise in full.
fn slope(angle: &[f64], duration: f64) -> f64 {
    let third = (angle.len() / 3).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let apart = duration * (angle.len() - third) as f64 / angle.len() as f64;
    let change = mean(&angle[angle.len() - third..]) - mean(&angle[..third]);
    if apart > 0.0 { change / apart } else { 0.0 }
}

fn mean(samples: &[rins_frames::Increments]) -> (Rates, f64) {
    let mut duration = 0.0;
    let (mut angle, mut velocity) = (Vector3::zeros(), Vector3::zeros());
    for sample in samples {
        angle += sample.angle.components();
        velocity += sample.velocity.components();
        duration += sample.interval;
    }
    let rates = Rates {
        angular_rate: InFrame::from_components(angle / duration),
        specific_force: InFrame::from_components(velocity / duration),
    };
    (rates, duration)
}
