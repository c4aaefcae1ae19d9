//! A wheel without an encoder: when it turned, and how its axis stood.

use std::ops::Range;

use nalgebra::{DMatrix, DVector, Vector3};
use rins_frames::units::DEG;
use rins_frames::{Dcm, EulerAngles, Nav, Table};
use rins_motion::Recording;

/// The least rate of a turning wheel \[rad/s\].
const LEAST_RATE: f64 = 0.1;

/// The part of its fastest rate below which a wheel is being started or stopped, by hands that tilt it.
const LEAST_PART: f64 = 0.3;

/// The time over which rates are smoothed \[s\].
const SMOOTHING: f64 = 0.25;

/// Two phases of gravity, the pulls of w² and w' on what is off the axis, and constants in the body.
const COLUMNS: usize = 6;

/// The longest stretch of samples over which the body turns about z one way, and not slowly: what a run without
/// a table reading is taken from.
///
/// Slowly is by less than a third of the fastest rate, the rate that of the z gyro, smoothed over a quarter of a
/// second. `None` if it never turns.
pub fn turning_span(recording: &Recording) -> Option<Range<usize>> {
    let mut rate = 0.0;
    let rates: Vec<f64> = recording
        .increments
        .iter()
        .map(|sample| {
            let weight = (sample.interval / SMOOTHING).min(1.0);
            rate += weight * (sample.angle.components().z / sample.interval - rate);
            rate
        })
        .collect();
    let fastest = rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
    let least = LEAST_RATE.max(LEAST_PART * fastest);
    let mut longest: Option<Range<usize>> = None;
    let mut start = 0;
    for (index, rate) in rates.iter().enumerate() {
        let one_way = rate.abs() > least && rate.signum() == rates[start].signum();
        if !one_way {
            start = if rate.abs() > least { index } else { index + 1 };
            if start >= rates.len() {
                break;
            }
            continue;
        }
        let span = start..index + 1;
        if longest.as_ref().is_none_or(|longest| span.len() > longest.len()) {
            longest = Some(span);
        }
    }
    longest
}

/// How far a gyro's scale may be off.
const LARGEST_SCALE_ERROR: f64 = 0.05;

/// The most of a turning that is looked at \[rad\]: sixty turns show the axis, and the search grows with their square.
const MOST_TURNED: f64 = 60.0 * std::f64::consts::TAU;

/// By how much two scales that are tried differ in the angle at the end \[rad\].
const STEP: f64 = 0.25;

/// How far gravity's turning may be off the axis that it shows, 1σ \[rad\]: the base may move.
pub const AXIS_BY_GRAVITY: f64 = 2.0 * DEG;

/// How an axis stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSeen {
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// Whether its heading was surveyed; if not it is arbitrary.
    pub heading_known: bool,
}

/// The attitude of an axis about which the body turns, from the accelerometers.
///
/// What of the specific force turns with the body is gravity's part across the axis; the part along
/// it is what the z accelerometer reads. The gyro's scale error, which would take its angle away from
/// gravity's within a few turns, is searched for beside it. The table angle is zero where the run begins.
///
/// Gravity does not show where the axis heads: it does so as it was `surveyed`. The surveyed yaw alone would not say it, for
/// that depends on how far the table has turned, which nobody knows where nothing reads it. It is all that is taken of a
/// survey that leans by more than three times [`AXIS_BY_GRAVITY`] less or more than what is seen, or by no more than that
/// itself; without a survey the yaw is zero. The heading is not known then.
///
/// `None` if the body makes less than a turn.
pub fn axis_from_gravity(recording: &Recording, surveyed: Option<EulerAngles>) -> Option<AxisSeen> {
    let turned: f64 = recording.increments.iter().map(|k| k.angle.components().z.abs()).sum();
    let turned = turned.min(MOST_TURNED);
    let (mut best, mut least) = (None, f64::INFINITY);
    let half = (LARGEST_SCALE_ERROR * turned / STEP).ceil();
    let mut step = -half;
    while step <= half {
        if let Some((up, misfit)) = up_seen(recording, 1.0 + step * STEP / turned)
            && misfit < least
        {
            (best, least) = (Some(up), misfit);
        }
        step += 1.0;
    }
    let up = best?;
    // The third row of C_s^n is up: -cos(pitch) sin(roll), sin(pitch), cos(pitch) cos(roll).
    let pitch = up.y.clamp(-1.0, 1.0).asin();
    let roll = (-up.x).atan2(up.z);
    let yaw = surveyed.map_or(0.0, |angles| angles.yaw);
    let axis = EulerAngles { roll, pitch, yaw }.dcm();
    let headed = surveyed.and_then(|angles| headed(&axis, &angles.dcm()));
    Some(AxisSeen { nav_from_table: headed.unwrap_or(axis), heading_known: headed.is_some() })
}

/// An axis with the heading of the surveyed one; `None` where the two do not lean alike, or not at all.
fn headed(axis: &Dcm<Nav, Table>, surveyed: &Dcm<Nav, Table>) -> Option<Dcm<Nav, Table>> {
    const FAR: f64 = 3.0 * AXIS_BY_GRAVITY;
    let leaning = |axis: &Dcm<Nav, Table>| {
        let up = axis.matrix().column(2);
        let across = up[0].hypot(up[1]);
        (across, across.atan2(up[2]), up[1].atan2(up[0]))
    };
    let ((_, tilt, heading), (across, surveyed_tilt, surveyed_heading)) =
        (leaning(axis), leaning(surveyed));
    let alike = across >= FAR && (tilt - surveyed_tilt).abs() <= FAR;
    let about_up = Vector3::new(0.0, 0.0, surveyed_heading - heading);
    alike.then(|| Dcm::<Nav, Nav>::from_rotation_vector(&about_up) * *axis)
}

/// Where up is in the axis frame, if the true rate is `scale` times what the z gyro reads; and what is left over
/// of the accelerometers' readings across the axis, as a sum of squares.
fn up_seen(recording: &Recording, scale: f64) -> Option<(Vector3<f64>, f64)> {
    let samples = &recording.increments;
    let mut normal = DMatrix::<f64>::zeros(COLUMNS, COLUMNS);
    let mut right = DVector::<f64>::zeros(COLUMNS);
    let (mut angle, mut least, mut most, mut along) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0);
    let (mut duration, mut turned, mut square) = (0.0, 0.0, 0.0);
    for (index, sample) in samples.iter().enumerate() {
        let interval = sample.interval;
        let rates = sample.rates();
        let force = rates.specific_force.components();
        let w = scale * rates.angular_rate.components().z;
        let middle = angle + 0.5 * w * interval;
        angle += w * interval;
        turned += (w * interval).abs();
        least = least.min(angle);
        most = most.max(angle);
        let neighbour = |at: usize| {
            let at = at.min(samples.len() - 1);
            scale * samples[at].rates().angular_rate.components().z
        };
        let acceleration =
            (neighbour(index + 1) - neighbour(index.saturating_sub(1))) / (2.0 * interval);
        let (sin, cos) = middle.sin_cos();
        // f_b = Rz(ζ)ᵀ F + [-w² r_x - w' r_y, -w² r_y + w' r_x] + b.
        let rows = [
            [cos, sin, -w * w, -acceleration, 1.0, 0.0],
            [-sin, cos, acceleration, -w * w, 0.0, 1.0],
        ];
        for (row, read) in rows.iter().zip([force.x, force.y]) {
            let row = DVector::from_column_slice(row);
            normal.syger(interval, &row, &row, 1.0);
            right.axpy(read * interval, &row, 1.0);
            square += read * read * interval;
        }
        along += force.z * interval;
        duration += interval;
        if turned > MOST_TURNED {
            break;
        }
    }
    if most - least < std::f64::consts::TAU {
        return None;
    }
    normal.fill_upper_triangle_with_lower_triangle();
    let solved = normal.cholesky()?.solve(&right);
    let up = Vector3::new(solved[0], solved[1], along / duration).normalize();
    Some((up, square - right.dot(&solved)))
}
