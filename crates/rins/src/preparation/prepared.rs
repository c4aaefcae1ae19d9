//! A log prepared for the estimation: its angle reference, and the attitude of its axis.

use std::ops::Range;

use anyhow::Context;
use rins_calibration::{Setup, likely_wobble, table_angles};
use rins_estimation::{
    AXIS_BY_GRAVITY, AngleSteps, AxisSeen, LEAST_TILT, Reference, Rig, Run, axis_from_gravity,
    turning_span,
};
use rins_frames::units::{ARCSEC, DEG};
use rins_frames::{Body, Dcm, Nav, Table};
use rins_imu::ImuSpec;
use rins_inspection::{CHANNELS, Repeats, StaticIntervals};
use rins_io::{Loaded, shown};
use rins_motion::Recording;

use super::attitude::{Attitude, FOUND_HERE, aligned};
use super::rests::{self, OnAxis, Rests};
use crate::align::{ANY_AZIMUTH, AlignmentSolution, found};
use crate::check::refuse_mistaken;
use crate::log::{
    Log, StaticIntervalResult, lasting, only, setup, static_intervals, statics_in_words,
    statics_result,
};
use crate::options::NoiseChoice;

/// The initial value of the wobble of an axis without encoder, on a floor or in a hand \[rad\].
const UNREAD_WOBBLE: f64 = 20.0 * ARCSEC;

/// Without an angle reference, a body with a smaller total rotation counts as handled, not as rotated on an axis \[rad\].
const LEAST_SPIN: f64 = 2.0 * std::f64::consts::TAU;

/// A log with its rig file, prepared for the estimation.
#[derive(Debug)]
pub(crate) struct Prepared {
    /// The name: the path of the rig file.
    pub(crate) name: String,
    /// The content of the files; if the whole log is used, its samples are moved to `run`.
    pub(crate) loaded: Loaded,
    /// The data sheet.
    pub(crate) imu: ImuSpec,
    /// The samples in use; of several static intervals the longest.
    pub(crate) run: Run,
    /// The other static intervals.
    pub(crate) others: Vec<Run>,
    /// The repeated samples in the log, which are removed from the samples in use.
    pub(crate) repeats: Option<Repeats>,
    /// The prior uncertainty of the attitude of the axis.
    pub(crate) attitude: Attitude,
    /// The static intervals of the log, for the JSON result.
    pub(crate) static_intervals: Vec<StaticIntervalResult>,
    /// Remarks on the preparation.
    pub(crate) remarks: Vec<String>,
}

/// The angle reference of the samples and the attitude of the axis.
struct Axis {
    /// The part of the log that is used, if not all of it is.
    part: Option<Recording>,
    /// The table angles corrected for the latency, if there is one.
    brought_forward: Option<Vec<f64>>,
    reference: Reference,
    nav_from_table: Dcm<Nav, Table>,
    /// Other static intervals, each with its attitude.
    others: Vec<(Recording, Dcm<Nav, Table>)>,
    /// The static intervals in use, if they are not all intervals or the longest one.
    rests_used: Option<Vec<Range<usize>>>,
    attitude: Attitude,
    remarks: Vec<String>,
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
            attitude,
            remarks: Vec::new(),
        }
    }
}

/// The station, table and IMU of a rig, after a check for gross errors of units, signs and axes, and what was assumed of
/// data sheet and site; every estimation starts here.
pub(crate) fn screened(loaded: &Loaded) -> anyhow::Result<(Setup, Vec<String>)> {
    let setup = setup(loaded)?;
    refuse_mistaken(loaded)?;
    Ok(setup)
}

impl Prepared {
    /// Prepares a log.
    pub(crate) fn of(log: Log, noise: NoiseChoice) -> anyhow::Result<Self> {
        let Log { name, mut loaded } = log;
        let (mut setup, assumptions) = screened(&loaded)?;
        let path = shown(&loaded.rig.log.path);
        let log = || path.clone();
        let has_wobble = loaded.rig.table.as_ref().is_some_and(|table| table.wobble.is_some());
        let statics = static_intervals(&loaded);
        let axis = axis(&loaded, &setup, &statics).with_context(log)?;
        let told = statics_in_words(&statics, &loaded.rig);
        let static_intervals = statics_of(&statics, &axis);
        let turned = matches!(axis.reference, Reference::Encoder { .. });
        if noise == NoiseChoice::Given && !has_wobble && turned {
            setup.table.wobble = likely_wobble(&loaded.recording, &setup).with_context(log)?;
        }
        let unread = matches!(axis.reference, Reference::Gravity | Reference::Rest);
        if unread && !has_wobble {
            setup.table.wobble = UNREAD_WOBBLE;
        }
        let rig = Rig {
            station: loaded.station,
            nav_from_table: axis.nav_from_table,
            reference: axis.reference,
            wobble: setup.table.wobble,
            velocity: setup.velocity_noise,
        };
        // Angles corrected for latency are no longer on the quantization grid, and a run does not hold the stated resolution.
        let stated = loaded.rig.log.table_angle().and_then(|angle| angle.resolution);
        let steps = match axis.reference {
            Reference::Encoder { noise } if axis.brought_forward.is_some() || stated.is_some() => {
                AngleSteps::of(&loaded.recording, noise, stated)
            }
            _ => None,
        };
        // Only one copy of the samples is kept: a log may last a day.
        let whole = || std::mem::take(&mut loaded.recording);
        let mut recording = axis.part.unwrap_or_else(whole);
        if let Some(angles) = axis.brought_forward {
            recording.table_angle = Some(angles);
        }
        let repeats = Repeats::take_out_of(&mut recording);
        let axes = loaded.rig.spin.into();
        let mut run = Run::new(rig, recording).with_context(log)?.with_axes(axes);
        run.angle_steps = steps.or(run.angle_steps);
        let others = axis.others.into_iter().map(|(recording, nav_from_table)| {
            let rig = Rig { nav_from_table, reference: Reference::Rest, ..rig };
            let run = Run::new(rig, recording).with_context(log)?;
            anyhow::Ok(run.with_axes(axes))
        });
        let others = others.collect::<anyhow::Result<Vec<Run>>>()?;
        let (attitude, mut remarks, imu) = (axis.attitude, axis.remarks, setup.imu);
        match remarks.first_mut() {
            Some(first) if !told.is_empty() => *first = format!("{first} {}", told.join(" ")),
            _ => remarks.extend(told),
        }
        remarks.extend(assumptions);
        remarks.extend(repeats.map(repeats_in_words));
        remarks.extend(run.angle_steps.map(|AngleSteps { step, .. }| {
            format!(
                "The encoder reads in steps of {:.3} arcsec, coarse beside its noise: its angle is trusted as far as their \
                 rounding allows.",
                step / ARCSEC
            )
        }));
        Ok(Self { name, loaded, imu, run, others, repeats, attitude, static_intervals, remarks })
    }

    /// The number of samples in use.
    pub(crate) fn samples(&self) -> usize {
        self.rests().map(|run| run.recording.len()).sum()
    }

    /// The runs in use, the longest static interval first.
    pub(crate) fn rests(&self) -> impl Iterator<Item = &Run> {
        std::iter::once(&self.run).chain(&self.others)
    }

    /// The same without the other static intervals.
    pub(crate) fn alone(mut self) -> Self {
        if self.others.is_empty() {
            return self;
        }
        self.others.clear();
        if self.run.rig.reference == Reference::Gravity {
            self.attitude.sigma[2] = None;
            self.remarks.push("The static intervals are not used here.".into());
        } else {
            self.remarks.push("Of these only the longest is used here.".into());
        }
        self
    }
}

/// The static intervals for the JSON result. Those in use are: for a run with gravity as angle reference, the selected ones;
/// otherwise all that are long enough, or only the longest.
fn statics_of(found: &StaticIntervals, axis: &Axis) -> Vec<StaticIntervalResult> {
    if let Some(used) = &axis.rests_used {
        return statics_result(found, |interval| {
            let is_used = used.contains(&interval.span);
            (!is_used).then(|| {
                format!(
                    "static, but shorter than {} s, or its axis leans otherwise than where it turns",
                    rests::SHORTEST
                )
            })
        });
    }
    let is_one_rest = axis.reference == Reference::Rest && axis.others.is_empty();
    match found.longest() {
        Some(longest) if is_one_rest => statics_result(found, only(&longest.span)),
        _ => statics_result(found, lasting(if is_one_rest { 0.0 } else { rests::SHORTEST })),
    }
}

/// A sentence on the repeated samples of a log.
pub(crate) fn repeats_in_words(Repeats { samples, rows, alone, .. }: Repeats) -> String {
    let alone = CHANNELS.into_iter().zip(alone).filter(|(_, alone)| *alone);
    let channels: Vec<&str> = alone.map(|(name, _)| name).collect();
    let which = match channels[..] {
        [] => "all six readings".to_owned(),
        _ => format!("all six readings, or that of {},", channels.join(" or ")),
    };
    format!(
        "{samples} samples, in {rows} row(s), repeat {which} of the one before: they are treated as lost."
    )
}

fn axis(loaded: &Loaded, setup: &Setup, statics: &StaticIntervals) -> anyhow::Result<Axis> {
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
        "The attitude of the axis was found over the static interval from {:.0} s to {:.0} s.",
        rest.start,
        loaded.recording.times[rest.span.end - 1]
    )];
    Ok(Axis { brought_forward, remarks, ..Axis::of(reference, nav_from_table, attitude) })
}

/// A run without an angle reference of the table: gravity is the reference, or the run is static.
fn unread(loaded: &Loaded, statics: &StaticIntervals) -> anyhow::Result<Axis> {
    let recording = &loaded.recording;
    let given = loaded.rig.attitude;
    let turning = turning_span(recording).map(|span| (recording.slice(span.start, span.end), span));
    if let Some((turning, span)) = turning
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
                (span, (recording, nav_from_table))
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
         interval, from {:.0} s to {:.0} s, is used.",
        rest.start,
        recording.times[rest.span.end - 1]
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
    let stood = |found: &AlignmentSolution| {
        let recording = loaded.recording.slice(found.span.start, found.span.end);
        let nav_from_table = found.nav_from_body * Dcm::<Table, Body>::about_z(0.0).inverse();
        (recording, nav_from_table)
    };
    let longest = rests.longest();
    let (recording, nav_from_table) = stood(&rests.found[longest]);
    let others = rests.found.iter().enumerate().filter(|(place, _)| *place != longest);
    let others = others.map(|(_, found)| stood(found)).collect();
    // All intervals share one prior, the widest.
    let sigmas = rests.found.iter().map(|found| aligned(&stood(found).1, found.sigma).sigma);
    let wide = sigmas.fold([None; 3], |wide, of| [0, 1, 2].map(|axis| wider(wide[axis], of[axis])));
    let axis = Axis::of(Reference::Rest, nav_from_table, Attitude { sigma: wide, azimuth: None });
    Axis { part: Some(recording), others, remarks: vec![rests.in_words()], ..axis }
}

/// The larger of two sigmas.
fn wider(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter().chain(other).reduce(f64::max)
}

/// The component of gravity in the plane of rotation \[m/s²\].
pub(crate) fn across_axis(gravity: f64, nav_from_table: &Dcm<Nav, Table>) -> f64 {
    gravity * nav_from_table.matrix()[(2, 0)].hypot(nav_from_table.matrix()[(2, 1)])
}

/// The total rotation of a body about z \[rad\].
fn spin(recording: &Recording) -> f64 {
    recording.increments.iter().map(|sample| sample.angle.components().z).sum::<f64>().abs()
}
