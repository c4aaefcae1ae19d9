//! The static intervals of a log: of an IMU that was placed in several attitudes, by hand or on a fixture, or of one on a spin
//! axis before and after the rotation.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::Vector3;
use rins_estimation::{AXIS_BY_GRAVITY, InSequence, StatedTurn, Turn, rotation};
use rins_frames::units::DEG;
use rins_frames::{Body, Dcm, Increments, Nav, Table};
use rins_inspection::StaticIntervals;
use rins_io::{Loaded, StatedRotation};
use rins_motion::Recording;
use rins_report::number::decimal;

use super::attitude::aligned;
use crate::align::{AlignmentSolution, found_over};
use crate::log::table_accuracy;

/// The shortest static interval that is used \[s\].
pub(super) const SHORTEST: f64 = 2.0;

/// Static intervals count as one attitude if the direction of gravity in the body differs by less \[rad\].
const ALIKE: f64 = 5.0 * DEG;

/// The longest time by which a reading may be taken after the end of a static interval, or before its start \[s\].
const AT_REST: f64 = 0.2;

/// A gyro that reads its largest rate in this number of successive samples is at the limit of its range.
const CLIPPED: usize = 3;

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

/// A static interval, its attitude, and its place among others.
pub(super) struct Still {
    pub(super) recording: Recording,
    pub(super) nav_from_table: Dcm<Nav, Table>,
    pub(super) in_sequence: Option<InSequence>,
}

/// The static intervals of one log, their attitudes, and the number of distinct attitudes.
pub(crate) struct Rests {
    /// In order of time.
    pub(super) found: Vec<AlignmentSolution>,
    /// The attitude in each, with headings that the gyros lead from one to the next where none shows north.
    nav_from_body: Vec<Dcm<Nav, Body>>,
    /// The rotation from the one before to each.
    turns: Vec<Option<Turn>>,
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
        let is_turned = !loaded.rotations.is_empty() && spans.len() > 1;
        if ways.len() < FEWEST_ATTITUDES && !is_turned {
            return Ok(None);
        }
        let found = spans.into_iter().map(|span| found_over(loaded, span));
        let found = found.collect::<anyhow::Result<Vec<AlignmentSolution>>>()?;
        let end = found.last().map_or(0.0, |last| recording.times[last.span.end - 1]);
        let lasting = [found.first().map_or(0.0, |first| first.start), end];
        let (nav_from_body, turns) = connected(loaded, &found);
        Ok(Some(Self { found, nav_from_body, turns, attitudes: ways.len(), lasting }))
    }

    /// The static interval at this place.
    pub(super) fn still(&self, recording: &Recording, place: usize) -> Still {
        let span = &self.found[place].span;
        Still {
            recording: recording.slice(span.start, span.end),
            nav_from_table: self.nav_from_table(place),
            in_sequence: Some(InSequence { number: place, turn: self.turns[place].clone() }),
        }
    }

    /// The 1σ of the attitude at this place about the axes of the body \[rad\].
    pub(super) fn prior(&self, place: usize) -> [Option<f64>; 3] {
        aligned(&self.nav_from_table(place), self.found[place].sigma).sigma
    }

    /// The attitude at this place, with the table angle defined as zero.
    fn nav_from_table(&self, place: usize) -> Dcm<Nav, Table> {
        self.nav_from_body[place] * Dcm::<Table, Body>::about_z(0.0).inverse()
    }

    /// The index of the longest.
    pub(super) fn longest(&self) -> usize {
        let length = |place: &usize| self.found[*place].span.len();
        (0..self.found.len()).max_by_key(length).unwrap_or_default()
    }

    /// Their number and time span as a sentence.
    pub(super) fn in_words(&self) -> String {
        let [from, to] = self.lasting.map(|time| decimal(time, 0));
        let count = |number: usize, one: &str| {
            format!("{number} {one}{}", if number == 1 { "" } else { "s" })
        };
        let turns: Vec<&Turn> = self.turns.iter().flatten().collect();
        let stated = turns.iter().filter(|turn| turn.stated.is_some()).count();
        let stated = match stated {
            0 => String::new(),
            _ => format!(", {stated} of them by a known angle"),
        };
        format!(
            "The log has no table angle during rotation: {} in {}, from {from} s to {to} s, and {} between them{stated} are used. The \
             attitude in each interval is estimated too, and not listed.",
            count(self.found.len(), "static interval"),
            count(self.attitudes, "attitude"),
            count(turns.len(), "rotation"),
        )
    }
}

/// The attitudes in static intervals and the rotation to each from the one before.
///
/// A rotation counts if every sample of it is there and no gyro is at its limit. Where the gyros do not show north, the heading of
/// an interval is that to which the rotation leads from the interval before.
fn connected(
    loaded: &Loaded,
    found: &[AlignmentSolution],
) -> (Vec<Dcm<Nav, Body>>, Vec<Option<Turn>>) {
    let recording = &loaded.recording;
    let mut attitudes: Vec<Dcm<Nav, Body>> = Vec::with_capacity(found.len());
    let mut turns = Vec::with_capacity(found.len());
    for (place, here) in found.iter().enumerate() {
        let before = place.checked_sub(1).map(|before| {
            let span = found[before].span.end..here.span.start;
            (&found[before], attitudes[before], span)
        });
        let Some((earlier, nav_from_earlier, span)) =
            before.filter(|(.., span)| is_whole(recording, span))
        else {
            attitudes.push(here.nav_from_body);
            turns.push(None);
            continue;
        };
        let between = recording.slice(span.start, span.end);
        let led = nav_from_earlier * rotation(&between, &mean_rate(recording, &earlier.span));
        let attitude = if here.north_found() {
            here.nav_from_body
        } else {
            heading_of(&led, &here.nav_from_body)
        };
        attitudes.push(attitude);
        let times = [recording.times[span.start], recording.times[span.end - 1]];
        let stated = stated(loaded, table_accuracy(&loaded.rig).0, times);
        turns.push(Some(Turn { recording: Arc::new(between), stated }));
    }
    (attitudes, turns)
}

/// The sum of the stated rotations whose middle lies between two times \[s\]: hands are not as punctual as a profile. Readings must
/// have been taken before and after, at rest; `mark` is their 1σ \[rad\].
fn stated(loaded: &Loaded, mark: f64, [from, to]: [f64; 2]) -> Option<StatedTurn> {
    let inside = |turn: &&StatedRotation| (from..to).contains(&(0.5 * (turn.start + turn.end)));
    let found: Vec<&StatedRotation> = loaded.rotations.iter().filter(inside).collect();
    let (first, last) = (found.first()?, found.last()?);
    let is_read = first.read;
    if is_read && (first.start > from + AT_REST || last.end < to - AT_REST) {
        return None;
    }
    Some(StatedTurn {
        angle: found.iter().map(|turn| turn.angle).sum(),
        sigma: found.iter().map(|turn| turn.sigma.powi(2)).sum::<f64>().sqrt(),
        mark: if is_read { mark } else { 0.0 },
    })
}

/// Whether no sample of a span is lost, and no gyro stays at its largest reading, as at the limit of its range.
fn is_whole(recording: &Recording, span: &Range<usize>) -> bool {
    let with_neighbors = span.start.max(1)..(span.end + 1).min(recording.len());
    let is_gap = |sample: usize| {
        let elapsed = recording.times[sample] - recording.times[sample - 1];
        elapsed > 1.5 * recording.increments[sample].interval
    };
    let samples = &recording.increments[span.clone()];
    let rate = |sample: &Increments, axis: usize| sample.angle.components()[axis] / sample.interval;
    let is_clipped = |axis: usize| {
        let largest = samples.iter().map(|sample| rate(sample, axis).abs()).fold(0.0, f64::max);
        let at_limit = |sample: &Increments| rate(sample, axis).abs() >= largest * (1.0 - 1e-6);
        largest > 0.0 && samples.windows(CLIPPED).any(|run| run.iter().all(at_limit))
    };
    !span.is_empty() && !with_neighbors.clone().any(is_gap) && !(0..3).any(is_clipped)
}

/// The mean reading of the gyros over a span \[rad/s\].
fn mean_rate(recording: &Recording, span: &Range<usize>) -> Vector3<f64> {
    let samples = &recording.increments[span.clone()];
    let lasting: f64 = samples.iter().map(|sample| sample.interval).sum();
    samples.iter().map(|sample| sample.angle.components()).sum::<Vector3<f64>>() / lasting
}

/// An attitude with the tilt of `level` and the heading that is nearest to `led`.
fn heading_of(led: &Dcm<Nav, Body>, level: &Dcm<Nav, Body>) -> Dcm<Nav, Body> {
    let apart = led.matrix() * level.matrix().transpose();
    let heading = (apart[(1, 0)] - apart[(0, 1)]).atan2(apart[(0, 0)] + apart[(1, 1)]);
    Dcm::<Nav, Nav>::about_z(heading) * *level
}
