//! The static intervals of a log: of an IMU that was placed in several attitudes, by hand or on a fixture, or of one on a spin
//! axis before and after the rotation.

use std::ops::Range;

use nalgebra::Vector3;
use rins_estimation::AXIS_BY_GRAVITY;
use rins_frames::units::DEG;
use rins_frames::{Dcm, Nav, Table};
use rins_inspection::StaticIntervals;
use rins_io::Loaded;
use rins_motion::Recording;

use crate::align::{AlignmentSolution, found_over};

/// The shortest static interval that is used \[s\].
pub(super) const SHORTEST: f64 = 2.0;

/// Static intervals count as one attitude if the direction of gravity in the body differs by less \[rad\].
const ALIKE: f64 = 5.0 * DEG;

/// With fewer attitudes, gravity gives hardly more information than the longest static interval.
pub(super) const FEWEST_ATTITUDES: usize = 3;

/// A static interval of an IMU on an axis about which it rotates in the other part of the log.
pub(super) struct OnAxis {
    pub(super) span: Range<usize>,
    /// The attitude of the body at rest, with the table angle defined as zero.
    pub(super) nav_from_table: Dcm<Nav, Table>,
}

/// The static intervals of a log outside of `turning` in which the inclination of the axis is that of the rotation, within three
/// times [`AXIS_BY_GRAVITY`]; gravity then gives the angle of the body about the axis.
pub(super) fn on_axis(
    recording: &Recording,
    statics: &StaticIntervals,
    turning: &Range<usize>,
    nav_from_table: &Dcm<Nav, Table>,
) -> Vec<OnAxis> {
    let up: Vector3<f64> = nav_from_table.matrix().row(2).transpose();
    let rest = |span: Range<usize>| {
        if span.start < turning.end && turning.start < span.end {
            return None;
        }
        let felt = up_in_body(recording, span.clone());
        let leans_alike = (felt.z.acos() - up.z.acos()).abs() <= 3.0 * AXIS_BY_GRAVITY;
        let angle = up.y.atan2(up.x) - felt.y.atan2(felt.x);
        leans_alike.then(|| OnAxis {
            span,
            nav_from_table: *nav_from_table * Dcm::<Table, Table>::about_z(angle),
        })
    };
    statics.spans(SHORTEST).into_iter().filter_map(rest).collect()
}

/// The direction of the mean specific force, in the body.
fn up_in_body(recording: &Recording, span: Range<usize>) -> Vector3<f64> {
    let gained = recording.increments[span].iter().map(|sample| sample.velocity.components());
    gained.sum::<Vector3<f64>>().normalize()
}

/// The static intervals of one log, their attitudes, and the number of distinct attitudes.
pub(crate) struct Rests {
    /// In order of time.
    pub(super) found: Vec<AlignmentSolution>,
    /// The number of attitudes that gravity distinguishes.
    pub(super) attitudes: usize,
    /// The start of the first static interval and the end of the last \[s\].
    pub(super) lasting: [f64; 2],
}

impl Rests {
    /// The static intervals of a log that has several attitudes; `None` if it has too few.
    pub(super) fn of(loaded: &Loaded, statics: &StaticIntervals) -> anyhow::Result<Option<Self>> {
        let recording = &loaded.recording;
        let mut ways: Vec<Vector3<f64>> = Vec::new();
        let spans = statics.spans(SHORTEST);
        for span in &spans {
            let up = up_in_body(recording, span.clone());
            if ways.iter().all(|way| way.angle(&up) > ALIKE) {
                ways.push(up);
            }
        }
        if ways.len() < FEWEST_ATTITUDES {
            return Ok(None);
        }
        let found = spans.into_iter().map(|span| found_over(loaded, span));
        let found = found.collect::<anyhow::Result<Vec<AlignmentSolution>>>()?;
        let end = found.last().map_or(0.0, |last| recording.times[last.span.end - 1]);
        let lasting = [found.first().map_or(0.0, |first| first.start), end];
        Ok(Some(Self { found, attitudes: ways.len(), lasting }))
    }

    /// The index of the longest.
    pub(super) fn longest(&self) -> usize {
        let length = |place: &usize| self.found[*place].span.len();
        (0..self.found.len()).max_by_key(length).unwrap_or_default()
    }

    /// Their number and time span as a sentence.
    pub(super) fn in_words(&self) -> String {
        let [from, to] = self.lasting;
        format!(
            "The log has no table angle and no rotation about the axis: {} static intervals in {} attitudes, from {from:.0} s to {to:.0} s, \
             are used. The attitude in each is estimated too, and not listed.",
            self.found.len(),
            self.attitudes
        )
    }
}
