//! The static intervals of a log: of an IMU that was turned over from one attitude to the next, by hand or on anything, and of a wheel
//! before and after it turns.

use std::ops::Range;

use nalgebra::Vector3;
use rins_estimation::AXIS_BY_GRAVITY;
use rins_frames::units::DEG;
use rins_frames::{Dcm, Nav, Table};
use rins_inspection::StaticIntervals;
use rins_io::Loaded;
use rins_motion::Recording;

use crate::align::{AlignmentSolution, found_over};

/// The shortest rest that is used \[s\].
pub(super) const SHORTEST: f64 = 2.0;

/// Rests between which gravity turns by less stand alike \[rad\].
const ALIKE: f64 = 5.0 * DEG;

/// In fewer attitudes gravity hardly shows more than over the longest static interval.
const FEWEST_ATTITUDES: usize = 3;

/// A rest of an IMU on an axis about which it turns in the rest of the log.
pub(super) struct OnAxis {
    pub(super) span: Range<usize>,
    /// The attitude of the body, the table angle taken for zero.
    pub(super) nav_from_table: Dcm<Nav, Table>,
}

/// The static intervals of a log outside of `turning` in which the axis leans as it does while it turns, to within three times what
/// [`AXIS_BY_GRAVITY`] allows: gravity tells how far the body is turned about it.
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

/// The static intervals of one log, how each stands, and in how many attitudes.
pub(crate) struct Rests {
    /// In order of time.
    pub(super) found: Vec<AlignmentSolution>,
    /// How many attitudes gravity distinguishes.
    pub(super) attitudes: usize,
    /// From when to when there are rests \[s\].
    pub(super) lasting: [f64; 2],
}

impl Rests {
    /// Those of a log that rests in several attitudes.
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

    /// The longest.
    pub(super) fn longest(&self) -> usize {
        let length = |place: &usize| self.found[*place].span.len();
        (0..self.found.len()).max_by_key(length).unwrap_or_default()
    }

    /// How many there are and when, in words.
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
