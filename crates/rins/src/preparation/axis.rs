//! The angle reference of a log, and the attitude of its axis.

use std::ops::Range;

use anyhow::Context;
use rins_calibration::{Setup, table_angles};
use rins_estimation::{
    AXIS_BY_GRAVITY, AxisSeen, InSequence, LEAST_TILT, Reference, axis_from_gravity, turning_span,
};
use rins_frames::units::DEG;
use rins_frames::{Body, Dcm, Nav, Table};
use rins_inspection::StaticIntervals;
use rins_io::Loaded;
use rins_motion::Recording;
use rins_report::number::decimal;

use super::attitude::{Attitude, FOUND_HERE, aligned};
use super::rests::{self, OnAxis, Rests, Still};
use crate::align::{ANY_AZIMUTH, found};

/// Without an angle reference, a body with a smaller total rotation counts as handled, not as rotated on an axis \[rad\].
const LEAST_SPIN: f64 = 2.0 * std::f64::consts::TAU;

/// The angle reference of the samples and the attitude of the axis.
pub(super) struct Axis {
    /// The part of the log that is used, if not all of it is.
    pub(super) part: Option<Recording>,
    /// The table angles corrected for the latency, if there is one.
    pub(super) brought_forward: Option<Vec<f64>>,
    pub(super) reference: Reference,
    pub(super) nav_from_table: Dcm<Nav, Table>,
    /// Other static intervals.
    pub(super) others: Vec<Still>,
    /// The static intervals in use, if they are not all intervals or the longest one.
    pub(super) rests_used: Option<Vec<Range<usize>>>,
    /// The place of the samples among the static intervals.
    pub(super) in_sequence: Option<InSequence>,
    pub(super) attitude: Attitude,
    pub(super) remarks: Vec<String>,
}

impl Axis {
    /// The whole log, without further intervals.
    fn of(reference: Reference, nav_from_table: Dcm<Nav, Table>, attitude: Attitude) -> Self {
        Self {
            part: None,
            brought_forward: None,
            reference,
            nav_from_table,
            others: Vec::new(),
            rests_used: None,
            in_sequence: None,
            attitude,
            remarks: Vec::new(),
        }
    }
}

/// The angle reference of a log and the attitude of its axis.
pub(super) fn axis(
    loaded: &Loaded,
    setup: &Setup,
    statics: &StaticIntervals,
) -> anyhow::Result<Axis> {
    let recording = &loaded.recording;
    let reference = match (&recording.table_angle, &recording.table_rate) {
        (Some(_), _) => Reference::Encoder { noise: setup.table.angle_noise },
        (None, Some(_)) => Reference::Command { noise: setup.table.rate_noise },
        (None, None) => return unread(loaded, statics),
    };
    let angles = table_angles(recording, setup.table.latency).unwrap_or_default();
    let late = recording.table_angle.is_some() && setup.table.latency != 0.0;
    let brought_forward = late.then(|| angles[1..].to_vec());
    if let Some(given) = loaded.rig.attitude {
        let axis = Axis::of(reference, given.angles.dcm(), Attitude::within(given.sigma));
        return Ok(Axis { brought_forward, ..axis });
    }
    let rest = found(loaded).context("the rig gives no [attitude], and none can be found")?;
    let table_from_body = Dcm::<Table, Body>::about_z(angles[rest.span.start]);
    let nav_from_table = rest.nav_from_body * table_from_body.inverse();
    // If north is not found, the uncertainty of the azimuth belongs to a parameter, and does not enter the tilt.
    let (east, north, up) = rest.sigma;
    let is_shown = up.is_some_and(|up| FOUND_HERE * up < ANY_AZIMUTH);
    let about_up = if is_shown { up } else { Some(north) };
    let azimuth = (!is_shown).then_some(ANY_AZIMUTH);
    let attitude = Attitude { azimuth, ..aligned(&nav_from_table, (east, north, about_up)) };
    let remarks = vec![format!(
        "The attitude of the axis was found over the static interval from {} s to {} s.",
        decimal(rest.start, 0),
        decimal(loaded.recording.times[rest.span.end - 1], 0)
    )];
    Ok(Axis { brought_forward, remarks, ..Axis::of(reference, nav_from_table, attitude) })
}

/// A run without an angle reference of the table: gravity is the reference, or the run is static.
fn unread(loaded: &Loaded, statics: &StaticIntervals) -> anyhow::Result<Axis> {
    let recording = &loaded.recording;
    let given = loaded.rig.attitude;
    let turning = turning_span(recording).map(|span| (recording.slice(span.start, span.end), span));
    if let Some((turning, span)) = turning
        && loaded.rotations.is_empty()
        && spin(&turning) > LEAST_SPIN
        && let Some(AxisSeen { nav_from_table, heading_known }) =
            axis_from_gravity(&turning, given.map(|given| given.angles))
        && across_axis(1.0, &nav_from_table) >= LEAST_TILT
    {
        let angles = nav_from_table.euler_angles();
        let mut remarks = vec![format!(
            "The log has no table angle: gravity, {:.2} m/s² of it across the axis (roll {:.1}, pitch {:.1} deg), is the angle \
             reference from {:.1} s to {:.1} s, {:.1} turns. The table angle is zero where it begins.",
            across_axis(loaded.station.gravity, &nav_from_table),
            angles.roll / DEG,
            angles.pitch / DEG,
            recording.times[span.start],
            recording.times[span.end - 1],
            spin(&turning) / (360.0 * DEG)
        )];
        let rests = rests::on_axis(recording, statics, &span, &nav_from_table);
        let (rests_used, others): (Vec<_>, Vec<_>) = rests
            .into_iter()
            .map(|OnAxis { span, nav_from_table }| {
                let recording = recording.slice(span.start, span.end);
                (span, Still { recording, nav_from_table, in_sequence: None })
            })
            .unzip();
        let wide = Some(AXIS_BY_GRAVITY);
        // In a static interval gravity gives the angle about the axis only to the accuracy of the accelerometers.
        let about_axis = (!others.is_empty()).then_some(ANY_AZIMUTH);
        if !others.is_empty() {
            let lasting = rests_used
                .iter()
                .map(|rest| recording.times[rest.end - 1] - recording.times[rest.start]);
            remarks.push(format!(
                "The static intervals on the same axis, {} of them with {:.0} s in all, are used too.",
                others.len(),
                lasting.sum::<f64>()
            ));
        }
        let heading = given.filter(|_| heading_known).map_or(ANY_AZIMUTH, |given| given.sigma);
        let azimuth = (heading > AXIS_BY_GRAVITY).then_some(heading);
        let attitude = Attitude { sigma: [wide, wide, about_axis], azimuth };
        let axis = Axis::of(Reference::Gravity, nav_from_table, attitude);
        return Ok(Axis {
            part: Some(turning),
            others,
            rests_used: Some(rests_used),
            remarks,
            ..axis
        });
    }
    if let Some(rests) = Rests::of(loaded, statics)? {
        return Ok(turned_over(loaded, &rests));
    }
    let rest = found(loaded)
        .context("the log has no table angle, and there are no two turns about the axis that gravity would show")?;
    let mut remarks = vec![format!(
        "The log has no table angle and no rotation about a tilted axis, of which gravity would show the angle: only the longest static \
         interval, from {} s to {} s, is used.",
        decimal(rest.start, 0),
        decimal(recording.times[rest.span.end - 1], 0)
    )];
    if statics.spans(rests::SHORTEST).len() > 1 {
        remarks.push(format!(
            "The static intervals have fewer than {} attitudes: with more, set on different sides, scale errors and misalignments are \
             observable.",
            rests::FEWEST_ATTITUDES
        ));
    }
    let (nav_from_table, attitude) = match loaded.rig.attitude {
        Some(given) => (given.angles.dcm(), Attitude::within(given.sigma)),
        None => {
            let nav_from_table = rest.nav_from_body * Dcm::<Table, Body>::about_z(0.0).inverse();
            (nav_from_table, aligned(&nav_from_table, rest.sigma))
        }
    };
    let part = Some(recording.slice(rest.span.start, rest.span.end));
    Ok(Axis { part, remarks, ..Axis::of(Reference::Rest, nav_from_table, attitude) })
}

/// A run of several static intervals, each with its own attitude.
fn turned_over(loaded: &Loaded, rests: &Rests) -> Axis {
    let longest = rests.longest();
    let Still { recording, nav_from_table, in_sequence } = rests.still(&loaded.recording, longest);
    let others = (0..rests.found.len()).filter(|place| *place != longest);
    let others = others.map(|place| rests.still(&loaded.recording, place)).collect();
    // All intervals share one prior, the widest.
    let sigmas = (0..rests.found.len()).map(|place| rests.prior(place));
    let wide = sigmas.fold([None; 3], |wide, of| [0, 1, 2].map(|axis| wider(wide[axis], of[axis])));
    let axis = Axis::of(Reference::Rest, nav_from_table, Attitude { sigma: wide, azimuth: None });
    Axis { part: Some(recording), others, in_sequence, remarks: vec![rests.in_words()], ..axis }
}

/// The larger of two sigmas.
fn wider(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter().chain(other).reduce(f64::max)
}

/// The total rotation of a body about z \[rad\].
fn spin(recording: &Recording) -> f64 {
    recording.increments.iter().map(|sample| sample.angle.components().z).sum::<f64>().abs()
}

/// The component of gravity in the plane of rotation \[m/s²\].
pub(crate) fn across_axis(gravity: f64, nav_from_table: &Dcm<Nav, Table>) -> f64 {
    gravity * nav_from_table.matrix()[(2, 0)].hypot(nav_from_table.matrix()[(2, 1)])
}
