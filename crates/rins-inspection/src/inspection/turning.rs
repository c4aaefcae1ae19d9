//! The change of the specific force in the body by rotation.

use nalgebra::{Matrix3, Vector3};
use rins_frames::units::DEG;

use super::correction::Hypothesis;
use rins_motion::Recording;

/// The angle of rotation over which the specific force is averaged \[rad\].
const PART: f64 = 0.2;

/// The duration of such a part \[s\] above which a gyro's bias might explain it.
const LONGEST_PART: f64 = 60.0;

/// The uniformity of the rotation in a part: the fraction of its first half.
const EVEN: core::ops::Range<f64> = 0.4..0.6;

/// The smallest total angle of rotation \[rad\] from which the change of the specific force is determined.
const LEAST_TURN: f64 = 90.0 * DEG;

/// The smallest tilt of the axis of rotation \[rad\]: about the vertical, nothing changes.
const LEAST_TILT: f64 = 3.0 * DEG;

/// The smallest singular value of the normal matrix of a lever arm, relative to its norm, that is not zero.
const SINGULAR: f64 = 1e-9;

/// Two successive parts of a rotation: the specific force in the middle \[m/s²\], its change, the rotation \[rad\] and its rate
/// \[rad/s\].
struct Step {
    force: Vector3<f64>,
    change: Vector3<f64>,
    turn: Vector3<f64>,
    rate: f64,
}

/// A vector for each step.
type Changes = Vec<Vector3<f64>>;

/// The rotations in a recording.
pub(super) struct Turning {
    steps: Vec<Step>,
}

/// The regression of the change of the specific force on `-θ × f`, with a lever arm as a nuisance parameter.
///
/// The centripetal specific force at a lever arm is constant in the body while the rate is: it is part of `f`, and does not
/// change. Its part of `-θ × f`, `θ × k ω²` with a constant `k`, is therefore eliminated from both sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Regression {
    pub(super) ratio: f64,
    pub(super) correlation: f64,
}

impl Regression {
    /// Whether the axes may be right. On a table the ratio is 1; if an IMU is moved, or rotates far from its accelerometers,
    /// other forces are added, but these do not change the sign.
    pub(super) fn plausible(&self, on_table: bool) -> bool {
        if on_table { self.certain() } else { self.correlation > -0.5 || self.ratio > -0.4 }
    }

    /// Whether the axes are certainly right.
    pub(super) fn certain(&self) -> bool {
        self.correlation > 0.8 && (0.6..1.6).contains(&self.ratio)
    }
}

/// The means over a part of a rotation.
struct Part {
    force: Vector3<f64>,
    turn: Vector3<f64>,
    time: f64,
    end: usize,
    start: usize,
}

impl Part {
    /// The mean rate \[rad/s\].
    fn rate(&self) -> f64 {
        self.turn.norm() / self.time
    }
}

impl Turning {
    /// `None` if there is little rotation, or only about the vertical. `stands` marks the samples in static intervals.
    pub(super) fn of(recording: &Recording, stands: &[bool]) -> Option<Self> {
        let mut steps = Vec::new();
        let mut last: Option<Part> = None;
        let mut start = 0;
        while let Some(part) = part(recording, stands, &mut start) {
            if let Some(last) = last.filter(|last| last.end == part.start) {
                steps.push(Step {
                    force: (last.force + part.force) / 2.0,
                    change: part.force - last.force,
                    turn: (last.turn + part.turn) / 2.0,
                    rate: 0.5 * (last.rate() + part.rate()),
                });
            }
            last = Some(part);
        }
        let turned: f64 = steps.iter().map(|step| step.turn.norm()).sum();
        let force: f64 = steps.iter().map(|step| step.force.norm_squared()).sum();
        let turning = Self { steps };
        let (_, moved) = turning.sides(&Hypothesis::AS_READ);
        let moved: f64 = moved
            .iter()
            .zip(&turning.steps)
            .map(|(moved, step)| (moved / step.turn.norm()).norm_squared())
            .sum();
        (turned > LEAST_TURN && moved > LEAST_TILT.powi(2) * force).then_some(turning)
    }

    pub(super) fn regression(&self, hypothesis: &Hypothesis) -> Regression {
        let (changes, moved) = self.sides(hypothesis);
        let product: f64 =
            changes.iter().zip(&moved).map(|(change, moved)| change.dot(moved)).sum();
        let square = |of: &Changes| -> f64 { of.iter().map(Vector3::norm_squared).sum() };
        let (expected, seen) = (square(&moved), square(&changes));
        Regression { ratio: product / expected, correlation: product / (expected * seen).sqrt() }
    }

    /// The changes of the specific force and `-θ × f`, both without what a lever arm can explain.
    fn sides(&self, hypothesis: &Hypothesis) -> (Changes, Changes) {
        let (mut changes, mut moved, mut levers) = (Vec::new(), Vec::new(), Vec::new());
        for step in &self.steps {
            let turn = hypothesis.gyro.apply(&step.turn);
            changes.push(hypothesis.accel.apply(&step.change));
            moved.push(-turn.cross(&hypothesis.accel.apply(&step.force)));
            levers.push(turn.cross_matrix() * step.rate.powi(2));
        }
        let normal: Matrix3<f64> = levers.iter().map(|lever| lever.transpose() * lever).sum();
        let inverse = normal.pseudo_inverse(SINGULAR * normal.norm()).expect("no negative limit");
        let eliminated = |side: Changes| -> Changes {
            let product: Vector3<f64> =
                levers.iter().zip(&side).map(|(lever, one)| lever.transpose() * one).sum();
            let arm = inverse * product;
            levers.iter().zip(&side).map(|(lever, one)| one - lever * arm).collect()
        };
        (eliminated(changes), eliminated(moved))
    }
}

/// The next part of a rotation at or after sample `start`, which is moved to its end.
fn part(recording: &Recording, stands: &[bool], start: &mut usize) -> Option<Part> {
    loop {
        while *stands.get(*start)? {
            *start += 1;
        }
        let first = *start;
        let (mut turn, mut velocity, mut time) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        let mut half = Vec::new();
        for (index, sample) in recording.increments.iter().enumerate().skip(first) {
            turn += sample.angle.components();
            velocity += sample.velocity.components();
            time += sample.interval;
            half.push((time, turn));
            *start = index + 1;
            if turn.norm() >= PART || time > LONGEST_PART || stands[index] {
                break;
            }
        }
        if turn.norm() >= PART {
            let middle = half.partition_point(|(elapsed, _)| *elapsed < time / 2.0);
            let (before, by_then) =
                middle.checked_sub(1).map_or((0.0, Vector3::zeros()), |before| half[before]);
            let (after, at_end) = half[middle.min(half.len() - 1)];
            let within = (time / 2.0 - before) / (after - before);
            let midway = by_then + (at_end - by_then) * within;
            let even = EVEN.contains(&(midway.dot(&turn) / turn.norm_squared()));
            // A part of one sample may have a large angle of rotation.
            if even && turn.norm() < 3.0 * PART {
                return Some(Part {
                    force: velocity / time,
                    turn,
                    time,
                    start: first,
                    end: *start,
                });
            }
        }
        if *start >= recording.len() {
            return None;
        }
    }
}
