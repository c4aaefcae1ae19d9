//! A wheel without an encoder: when it turned, and how its axis stood.

use std::ops::Range;

use nalgebra::{DMatrix, DVector, Vector3};
use rins_frames::{Dcm, EulerAngles, Nav, Table};
use rins_motion::Recording;

/// The least rate of a turning wheel \[rad/s\].
const LEAST_RATE: f64 = 0.1;

/// How long a stop may be that does not end a turning \[s\].
const LONGEST_STOP: f64 = 3.0;

/// Two phases of gravity, the pulls of w² and w' on what is off the axis, and constants in the body.
const COLUMNS: usize = 6;

/// The longest stretch of samples over which the body turns about z: what a run without a table reading is
/// taken from.
///
/// The rate is that of the z gyro, smoothed over half a second. `None` if it never turns.
pub fn turning_span(recording: &Recording) -> Option<Range<usize>> {
    let mut longest: Option<Range<usize>> = None;
    let mut now: Option<Range<usize>> = None;
    let (mut rate, mut still) = (0.0, 0.0);
    for (index, sample) in recording.increments.iter().enumerate() {
        let interval = sample.interval;
        let weight = (interval / 0.25).min(1.0);
        rate += weight * (sample.angle.components().z / interval - rate);
        if rate.abs() > LEAST_RATE {
            still = 0.0;
            let start = now.as_ref().map_or(index, |span: &Range<usize>| span.start);
            now = Some(start..index + 1);
        } else {
            still += interval;
            if still > LONGEST_STOP {
                now = None;
            }
        }
        let better = |span: &Range<usize>| longest.as_ref().is_none_or(|l| span.len() > l.len());
        if let Some(span) = now.clone().filter(better) {
            longest = Some(span);
        }
    }
    longest
}

/// The attitude of an axis about which the body turns, from the accelerometers.
///
/// What of the specific force turns with the body is gravity's part across the axis; the part along
/// it is what the z accelerometer reads. The azimuth, which gravity does not show, is `yaw` \[rad\]; the table
/// angle is zero where the run begins.
///
/// `None` if the body makes less than a turn.
pub fn axis_from_gravity(recording: &Recording, yaw: f64) -> Option<Dcm<Nav, Table>> {
    let samples = &recording.increments;
    let mut normal = DMatrix::<f64>::zeros(COLUMNS, COLUMNS);
    let mut right = DVector::<f64>::zeros(COLUMNS);
    let (mut angle, mut least, mut most, mut along) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0);
    let mut duration = 0.0;
    for (index, sample) in samples.iter().enumerate() {
        let interval = sample.interval;
        let rates = sample.rates();
        let (w, force) = (rates.angular_rate.components().z, rates.specific_force.components());
        let middle = angle + 0.5 * w * interval;
        angle += w * interval;
        least = least.min(angle);
        most = most.max(angle);
        let neighbour =
            |at: usize| samples[at.min(samples.len() - 1)].rates().angular_rate.components().z;
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
        }
        along += force.z * interval;
        duration += interval;
    }
    if most - least < std::f64::consts::TAU {
        return None;
    }
    normal.fill_upper_triangle_with_lower_triangle();
    let solved = normal.cholesky()?.solve(&right);
    let up = Vector3::new(solved[0], solved[1], along / duration).normalize();
    // The third row of C_s^n is up: -cos(pitch) sin(roll), sin(pitch), cos(pitch) cos(roll).
    let pitch = up.y.clamp(-1.0, 1.0).asin();
    let roll = (-up.x).atan2(up.z);
    Some(EulerAngles { roll, pitch, yaw }.dcm())
}
