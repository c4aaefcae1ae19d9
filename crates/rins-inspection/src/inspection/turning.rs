//! The change of the specific force in the body by rotation.

use nalgebra::Vector3;
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

/// Two successive parts of a rotation: the specific force in the middle \[m/s²\], its change, and the rotation \[rad\].
struct Step {
    force: Vector3<f64>,
    change: Vector3<f64>,
    turn: Vector3<f64>,
}

/// The rotations in a recording.
pub(super) struct Turning {
    steps: Vec<Step>,
}

/// The regression of the change of the specific force on `-θ × f`.
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
    end: usize,
    start: usize,
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
                });
            }
            last = Some(part);
        }
        let turned: f64 = steps.iter().map(|step| step.turn.norm()).sum();
        let force: f64 = steps.iter().map(|step| step.force.norm_squared()).sum();
        let moved: f64 = steps
            .iter()
            .map(|step| (step.turn.cross(&step.force) / step.turn.norm()).norm_squared())
            .sum();
        (turned > LEAST_TURN && moved > LEAST_TILT.powi(2) * force).then_some(Self { steps })
    }

    pub(super) fn regression(&self, hypothesis: &Hypothesis) -> Regression {
        let (mut product, mut expected, mut seen) = (0.0, 0.0, 0.0);
        for step in &self.steps {
            let force = hypothesis.accel.apply(&step.force);
            let change = hypothesis.accel.apply(&step.change);
            let moved = -hypothesis.gyro.apply(&step.turn).cross(&force);
            product += change.dot(&moved);
            expected += moved.norm_squared();
            seen += change.norm_squared();
        }
        Regression { ratio: product / expected, correlation: product / (expected * seen).sqrt() }
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
                return Some(Part { force: velocity / time, turn, start: first, end: *start });
            }
        }
        if *start >= recording.len() {
            return None;
        }
    }
}
