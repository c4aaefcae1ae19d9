//! Slow rotations that resemble a gyro bias, and that gravity reveals.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::{DEG, DEG_PER_SECOND};

use rins_motion::median;

/// The angle from which a steady drift is a rotation \[rad\] ...
const LARGEST_STEADY: f64 = 0.1 * DEG;

/// ... if it is not slower than this \[rad/s\]: an accelerometer that warms up drifts too.
const SLOWEST_STEADY: f64 = 0.002 * DEG_PER_SECOND;

/// The number of windows that are averaged to one direction.
const AVERAGED: usize = 10;

/// In a rotation, the difference of the directions before and after a window from which the rotation continues there \[rad\].
const LEAST_STEP: f64 = 0.05 * DEG;

/// The number of sigmas from which windows differ by more than noise.
const SIGMAS: f64 = 6.0;

/// The parts of a quiet span over which gravity has a constant direction in the body, apart from the sway of the base
/// \[rad\]. The span is given by the mean specific forces in its windows of duration `window` \[s\].
pub(super) fn parts(forces: &[Vector3<f64>], window: f64, largest_sway: f64) -> Vec<Range<usize>> {
    let up: Vec<Vector3<f64>> =
        forces.iter().map(|force| force.try_normalize(0.0).unwrap_or_default()).collect();
    let averaged = AVERAGED.min(up.len() / 2);
    let whole = 0..up.len();
    if averaged == 0 {
        return vec![whole];
    }
    // The scatter of a window's direction, from successive windows so that it does not contain a drift.
    let step = median(up.windows(2).map(|pair| (pair[1] - pair[0]).norm()));
    let scatter = step.unwrap_or_default() / 2.0_f64.sqrt();
    let noise = |count: usize| SIGMAS * scatter * (2.0 / count as f64).sqrt();
    let strays = strays(&up, averaged, largest_sway + noise(averaged));
    if !strays && !drifts(&up, window, noise(up.len().div_ceil(4))) {
        return vec![whole];
    }

    let step = |index: usize| {
        let (before, after) =
            (mean(&up[index - averaged..index]), mean(&up[index..index + averaged]));
        (after - before).norm()
    };
    let turns = |index: usize| {
        // At the ends, the nearest complete difference is used.
        step(index.clamp(averaged, up.len() - averaged)) > LEAST_STEP + noise(averaged)
    };
    let mut parts: Vec<Range<usize>> = Vec::new();
    for index in (0..up.len()).filter(|&index| !turns(index)) {
        match parts.last_mut() {
            // A rotation too slow to be visible between successive windows ends a part too.
            Some(part)
                if part.end == index
                    && (up[index] - mean(&up[part.start..(part.start + averaged).min(index)]))
                        .norm()
                        < largest_sway + SIGMAS * scatter =>
            {
                part.end = index + 1;
            }
            _ => parts.push(index..index + 1),
        }
    }
    parts
}

fn mean(vectors: &[Vector3<f64>]) -> Vector3<f64> {
    vectors.iter().sum::<Vector3<f64>>() / vectors.len() as f64
}

/// Whether the direction is ever far from that at the start.
fn strays(up: &[Vector3<f64>], averaged: usize, allowed: f64) -> bool {
    let start = mean(&up[..averaged]);
    up.windows(averaged).any(|part| (mean(part) - start).norm() > allowed)
}

/// Whether the direction changes steadily, by similar angles in each quarter.
fn drifts(up: &[Vector3<f64>], window: f64, noise: f64) -> bool {
    let quarters: Vec<Vector3<f64>> = up.chunks(up.len().div_ceil(4)).map(mean).collect();
    let moves: Vec<Vector3<f64>> = quarters.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let total = moves.iter().sum::<Vector3<f64>>();
    let even = moves.iter().all(|step| {
        let along = step.dot(&total) / total.norm_squared() * moves.len() as f64;
        let across = step.cross(&total).norm() / total.norm_squared() * moves.len() as f64;
        (0.6..1.4).contains(&along) && across < 0.4
    });
    // From the middle of the first quarter to that of the last.
    let lasting = 0.75 * up.len() as f64 * window;
    let least = LARGEST_STEADY.max(SLOWEST_STEADY * lasting) * 0.75 + noise;
    moves.len() == 3 && total.norm() > least && even
}
