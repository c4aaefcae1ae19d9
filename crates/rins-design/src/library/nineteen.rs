//! The schedule of 19 positions, which are reached by rotations of 90 deg about all three axes of the IMU.

use rins_frames::{Body, Dcm, EulerAngles, Nav, SignedAxes, Table};
use rins_motion::{Profile, Segment};

use crate::candidate::Candidate;
use crate::limits::{Limits, transit};
use crate::planned::Planned;

/// The rotations about one axis of the IMU, from the position that the ones before lead to.
struct Part {
    /// The axis of the IMU along the spin axis.
    axis: usize,
    /// How often the IMU was turned by 90 deg about the vertical before.
    quarters_before: f64,
    /// Rotations in units of 90 deg, each to one more position.
    quarters: &'static [f64],
}

/// Six rotations about y, one about z, six about x, five about z; x is east, y north and z up at first, and the axis of rotation is
/// horizontal for x and y.
const PARTS: [Part; 4] = [
    Part { axis: 1, quarters_before: 0.0, quarters: &[1.0, 1.0, 1.0, -1.0, -1.0, -1.0] },
    Part { axis: 2, quarters_before: 0.0, quarters: &[1.0] },
    Part { axis: 0, quarters_before: 1.0, quarters: &[1.0, 1.0, 1.0, -1.0, -1.0, -1.0] },
    Part { axis: 2, quarters_before: 1.0, quarters: &[1.0, 1.0, -1.0, -1.0, -1.0] },
];

/// 19 positions of equal duration as four runs in one power-on, each about one axis of the IMU; `None` if the IMU cannot be mounted with
/// each of its axes along the spin axis, or if a rotation takes longer than the positions.
pub(super) fn nineteen_positions(
    given: &Planned,
    limits: &Limits,
    mountings: &[SignedAxes],
) -> Option<Candidate> {
    let quarter = std::f64::consts::FRAC_PI_2;
    let rotations: Vec<f64> = PARTS.iter().flat_map(|part| part.quarters).copied().collect();
    let positions = 1.0 + rotations.len() as f64;
    let turning: f64 = rotations
        .iter()
        .flat_map(|quarters| transit(quarters * quarter, limits))
        .map(|segment| segment.duration)
        .sum();
    let dwell = (limits.duration - turning) / positions;
    let rest = |duration: f64| Segment { rate: 0.0, duration };
    let yaw = given.nav_from_table().euler_angles().yaw;
    let (mut runs, mut all) = (Vec::new(), Vec::new());
    for (place, part) in PARTS.iter().enumerate() {
        let axes = *mountings.iter().find(|axes| axes.source[2] == part.axis)?;
        // The position between two runs belongs to both, half of it to each.
        let share = |is_end: bool| rest(if is_end { dwell } else { 0.5 * dwell });
        let mut segments = vec![share(place == 0)];
        for (step, quarters) in part.quarters.iter().enumerate() {
            segments.extend(transit(quarters * quarter, limits));
            let is_last = step + 1 == part.quarters.len();
            segments.push(if is_last { share(place + 1 == PARTS.len()) } else { rest(dwell) });
        }
        let turned = yaw + part.quarters_before * quarter;
        // The IMU has x, y and z to the east, north and up before it is turned about the vertical.
        let nav_from_body = EulerAngles { roll: 0.0, pitch: 0.0, yaw: turned }.dcm::<Nav, Body>();
        let profile = Profile::new(&segments, Some(limits.acceleration)).ok()?;
        let attitude =
            Dcm::<Nav, Table>::from_matrix(nav_from_body.matrix() * axes.inverse().matrix())
                .ok()?;
        runs.push(given.moved(profile, attitude).with_axes(axes).since(0));
        all.extend(segments);
    }
    let words = "19 positions".into();
    Some(Candidate { words, runs, segments: all, duration: limits.duration })
}
