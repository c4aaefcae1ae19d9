//! A table without an encoder: the span in which it rotates, and the attitude of its axis.

use std::ops::Range;

use nalgebra::{DMatrix, DVector, Vector3};
use rins_frames::units::DEG;
use rins_frames::{Dcm, EulerAngles, Nav, Table};
use rins_motion::Recording;

/// The smallest rate of a rotating table \[rad/s\].
const LEAST_RATE: f64 = 0.1;

/// The fraction of the largest rate below which the table is being started or stopped by hand, which tilts it.
const LEAST_PART: f64 = 0.3;

/// The time over which rates are smoothed \[s\].
const SMOOTHING: f64 = 0.25;

/// The columns of the regression: two components of gravity, the effects of w² and w' on the lever arm, and two constants in
/// the body.
const COLUMNS: usize = 6;

/// The longest span of samples with a rotation about z in one direction and not slowly: the data of a run without a table
/// angle.
///
/// Slow means less than 0.3 of the largest rate. The rate is that of the z gyro, smoothed over a quarter of a second. `None` if
/// the table never rotates.
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

/// The largest scale error of the z gyro.
const LARGEST_SCALE_ERROR: f64 = 0.05;

/// The largest angle of rotation that is used \[rad\]: sixty revolutions determine the axis, and the search time increases with
/// their square.
const MOST_TURNED: f64 = 60.0 * std::f64::consts::TAU;

/// The difference of the final angle between successive trial scale factors \[rad\].
const STEP: f64 = 0.25;

/// 1σ of the axis attitude from gravity \[rad\]: the base may move.
pub const AXIS_BY_GRAVITY: f64 = 2.0 * DEG;

/// The attitude of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSeen {
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// Whether the heading is known from a survey; otherwise it is arbitrary.
    pub heading_known: bool,
}

/// The attitude of the axis about which the body rotates, from the accelerometers.
///
/// The component of the specific force that rotates in the body is the component of gravity perpendicular to the axis; the z
/// accelerometer measures the component along it. The scale error of the gyro, by which its angle would depart from that of
/// gravity within a few revolutions, is estimated by a grid search. The table angle is zero at the start of the run.
///
/// Gravity does not determine the heading of the axis, which is that of `surveyed`. The surveyed yaw alone does not determine
/// it either, because it depends on the unknown table angle. Only the yaw of a survey is used if its tilt differs by more than
/// three times [`AXIS_BY_GRAVITY`] from the measured one, or is itself smaller than that; without a survey the yaw is zero. The
/// heading is unknown in these cases.
///
/// `None` if the body rotates by less than one revolution.
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

/// An axis with the heading of the surveyed one; `None` if the tilts of the two differ, or are too small.
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

/// The direction of up in the axis frame if the true rate is `scale` times the reading of the z gyro, and the sum of squared
/// residuals of the accelerometer readings perpendicular to the axis.
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
