//! A rig made ready to be estimated from: what tells the table's angle, and how its axis stands.

use std::path::Path;

use anyhow::Context;
use nalgebra::{Matrix3, Vector3};
use rins_calibration::{Setup, likely_wobble, table_angles};
use rins_estimation::{
    AXIS_BY_GRAVITY, AngleSteps, Reference, Rig, Run, axis_from_gravity, turning_span,
};
use rins_frames::units::{ARCSEC, DEG};
use rins_frames::{Body, Dcm, Nav, Table};
use rins_imu::ImuSpec;
use rins_io::Loaded;
use rins_motion::{CHANNELS, Recording, Repeats, StaticIntervals};
use serde_json::Value;

use crate::args::NoiseChoice;
use crate::commands::align::{ANY_AZIMUTH, Found, found};
use crate::commands::calibrate::rests::{self, Rests};
use crate::commands::check::refuse_mistaken;
use crate::commands::setup::setup;
use crate::commands::statics::{lasting, only, static_intervals, statics_in_words, statics_json};
use rins_io::shown;

/// An attitude that was found in the same data is counted again by a hundredth of its information.
const FOUND_HERE: f64 = 10.0;

/// The first guess of how a floor or a hand lets an axis tremble on which no encoder sits \[rad\].
const UNREAD_WOBBLE: f64 = 20.0 * ARCSEC;

/// A body that turns by less, without anything that says how far, is taken to be handled \[rad\].
const LEAST_SPIN: f64 = 2.0 * std::f64::consts::TAU;

/// A rig, its log, and the run that is estimated from.
pub(crate) struct Prepared {
    /// What it is called: the path of its rig file.
    pub(crate) name: String,
    /// The files' content; where the whole log is used its samples are those of `run`, and not here.
    pub(crate) loaded: Loaded,
    /// What the data sheet says.
    pub(crate) imu: ImuSpec,
    /// The samples that are used; of several rests the longest.
    pub(crate) run: Run,
    /// The other rests.
    pub(crate) others: Vec<Run>,
    /// What repeated in the log, and was taken out of the samples that are used.
    pub(crate) repeats: Option<Repeats>,
    /// How well the axis' attitude is known beforehand.
    pub(crate) attitude: Attitude,
    /// The static intervals of the log, for a machine.
    pub(crate) static_intervals: Value,
    /// What a reader must know of how it was prepared.
    pub(crate) remarks: Vec<String>,
}

/// How well the attitude of an axis is known before anything is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Attitude {
    /// The 1σ of its error about each axis of the axis frame \[rad\]; none if it is a definition.
    pub(crate) sigma: [Option<f64>; 3],
}

impl Attitude {
    /// Known to `sigma` about any axis \[rad\].
    const fn within(sigma: f64) -> Self {
        Self { sigma: [Some(sigma); 3] }
    }
}

/// What is known of the table, as far as the samples go.
struct Axis {
    /// The part of the log that is used, if not all of it is.
    part: Option<Recording>,
    /// The table's angles brought forward by its latency, if it has one.
    brought_forward: Option<Vec<f64>>,
    reference: Reference,
    nav_from_table: Dcm<Nav, Table>,
    /// Other rests, and how each stands.
    others: Vec<(Recording, Dcm<Nav, Table>)>,
    attitude: Attitude,
    remarks: Vec<String>,
}

impl Axis {
    /// Over the whole log, with nothing beside it.
    fn of(reference: Reference, nav_from_table: Dcm<Nav, Table>, attitude: Attitude) -> Self {
        Self {
            part: None,
            brought_forward: None,
            reference,
            nav_from_table,
            others: Vec::new(),
            attitude,
            remarks: Vec::new(),
        }
    }
}

impl Prepared {
    /// Makes a rig ready.
    pub(crate) fn of(path: &Path, mut loaded: Loaded, noise: NoiseChoice) -> anyhow::Result<Self> {
        let mut setup = setup(&loaded)?;
        refuse_mistaken(&loaded)?;
        let name = shown(&loaded.rig.log.path);
        let log = || name.clone();
        let has_wobble = loaded.rig.table.as_ref().is_some_and(|table| table.wobble.is_some());
        let axis = axis(&loaded, &setup).with_context(log)?;
        let statics = static_intervals(&loaded);
        let told = statics_in_words(&statics, &loaded.rig);
        let unused = match axis.reference {
            Reference::Rest if axis.others.is_empty() => None,
            _ => Some(rests::SHORTEST),
        };
        let static_intervals = statics_of(&statics, unused);
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
        // Angles that are brought forward stand on no comb any more, and a run knows nothing of what is stated.
        let stated = loaded.rig.log.table_angle().and_then(|angle| angle.resolution);
        let steps = match axis.reference {
            Reference::Encoder { noise } if axis.brought_forward.is_some() || stated.is_some() => {
                AngleSteps::of(&loaded.recording, noise, stated)
            }
            _ => None,
        };
        // A day's samples are kept once.
        let whole = || std::mem::take(&mut loaded.recording);
        let mut recording = axis.part.unwrap_or_else(whole);
        if let Some(angles) = axis.brought_forward {
            recording.table_angle = Some(angles);
        }
        let repeats = recording.take_out_repeats();
        let axes = loaded.rig.spin.into();
        let mut run = Run::new(rig, recording).with_context(log)?.with_axes(axes);
        run.angle_steps = steps.or(run.angle_steps);
        let others = axis.others.into_iter().map(|(recording, nav_from_table)| {
            let run = Run::new(Rig { nav_from_table, ..rig }, recording).with_context(log)?;
            anyhow::Ok(run.with_axes(axes))
        });
        let others = others.collect::<anyhow::Result<Vec<Run>>>()?;
        let (attitude, mut remarks, imu) = (axis.attitude, axis.remarks, setup.imu);
        match remarks.first_mut() {
            Some(first) if !told.is_empty() => *first = format!("{first} {}", told.join(" ")),
            _ => remarks.extend(told),
        }
        remarks.extend(repeats.map(repeats_in_words));
        remarks.extend(run.angle_steps.map(|AngleSteps { step, .. }| {
            format!(
                "The encoder reads in steps of {:.3} arcsec, coarse beside its noise: its angle is trusted as far as their \
                 rounding allows.",
                step / ARCSEC
            )
        }));
        Ok(Self {
            name: shown(path),
            loaded,
            imu,
            run,
            others,
            repeats,
            attitude,
            static_intervals,
            remarks,
        })
    }

    /// How many samples are used.
    pub(crate) fn samples(&self) -> usize {
        self.rests().map(|run| run.recording.len()).sum()
    }

    /// The samples that are used, the longest rest first.
    pub(crate) fn rests(&self) -> impl Iterator<Item = &Run> {
        std::iter::once(&self.run).chain(&self.others)
    }

    /// The same with the longest rest only.
    pub(crate) fn of_longest_rest(mut self) -> Self {
        if !self.others.is_empty() {
            self.others.clear();
            self.remarks.push("Of these only the longest is used here.".into());
        }
        self
    }
}

/// The static intervals for a machine: all that last so long are used, or only the longest.
fn statics_of(found: &StaticIntervals, shortest: Option<f64>) -> Value {
    match (shortest, found.longest()) {
        (None, Some(longest)) => statics_json(found, only(&longest.span)),
        (shortest, _) => statics_json(found, lasting(shortest.unwrap_or_default())),
    }
}

/// What was taken out of a log, in words.
pub(super) fn repeats_in_words(Repeats { samples, rows, alone, .. }: Repeats) -> String {
    let alone = CHANNELS.into_iter().zip(alone).filter(|(_, alone)| *alone);
    let channels: Vec<&str> = alone.map(|(name, _)| name).collect();
    let which = match channels[..] {
        [] => "all six readings".to_owned(),
        _ => format!("all six readings, or that of {},", channels.join(" or ")),
    };
    format!(
        "{samples} samples, in {rows} row(s), repeat {which} of the one before: they are taken for lost."
    )
}

fn axis(loaded: &Loaded, setup: &Setup) -> anyhow::Result<Axis> {
    let recording = &loaded.recording;
    let reference = match (&recording.table_angle, &recording.table_rate) {
        (Some(_), _) => Reference::Encoder { noise: setup.table.angle_noise },
        (None, Some(_)) => Reference::Command { noise: setup.table.rate_noise },
        (None, None) => return unread(loaded),
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
    let attitude = aligned(&nav_from_table, rest.sigma);
    let remarks = vec![format!(
        "The attitude of the axis was found over the rest from {:.0} s to {:.0} s.",
        rest.start,
        loaded.recording.times[rest.span.end - 1]
    )];
    Ok(Axis { brought_forward, remarks, ..Axis::of(reference, nav_from_table, attitude) })
}

/// A run whose table nothing reads: it turns by gravity, or rests.
fn unread(loaded: &Loaded) -> anyhow::Result<Axis> {
    let recording = &loaded.recording;
    let surveyed = loaded.rig.attitude.map(|given| given.angles);
    let turning = turning_span(recording).map(|span| (recording.slice(span.start, span.end), span));
    if let Some((turning, span)) = turning
        && spin(&turning) > LEAST_SPIN
        && let Some(nav_from_table) = axis_from_gravity(&turning, surveyed)
    {
        let angles = nav_from_table.euler_angles();
        let remarks = vec![format!(
            "Nothing reads the table: gravity, {:.2} m/s² of it across the axis (roll {:.1}, pitch {:.1} deg), is the angle \
             reference from {:.1} s to {:.1} s, {:.1} turns. The table angle is zero where it begins.",
            across_axis(loaded.station.gravity, &nav_from_table),
            angles.roll / DEG,
            angles.pitch / DEG,
            recording.times[span.start],
            recording.times[span.end - 1],
            spin(&turning) / (360.0 * DEG)
        )];
        let wide = Some(AXIS_BY_GRAVITY);
        let attitude = Attitude { sigma: [wide, wide, None] };
        let axis = Axis::of(Reference::Gravity, nav_from_table, attitude);
        return Ok(Axis { part: Some(turning), remarks, ..axis });
    }
    if let Some(rests) = Rests::of(loaded)? {
        return Ok(turned_over(loaded, &rests));
    }
    let rest = found(loaded)
        .context("nothing reads the table, and there are no two turns about its axis that gravity would show")?;
    let remarks = vec![format!(
        "Nothing reads a table and nothing turns about the axis: only the longest rest, from {:.0} s to {:.0} s, is used.",
        rest.start,
        recording.times[rest.span.end - 1]
    )];
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

/// A run of many rests, each with an attitude of its own.
fn turned_over(loaded: &Loaded, rests: &Rests) -> Axis {
    let stood = |found: &Found| {
        let recording = loaded.recording.slice(found.span.start, found.span.end);
        let nav_from_table = found.nav_from_body * Dcm::<Table, Body>::about_z(0.0).inverse();
        (recording, nav_from_table)
    };
    let longest = rests.longest();
    let (recording, nav_from_table) = stood(&rests.found[longest]);
    let others = rests.found.iter().enumerate().filter(|(place, _)| *place != longest);
    let others = others.map(|(_, found)| stood(found)).collect();
    // One prior for all: the widest.
    let sigmas = rests.found.iter().map(|found| aligned(&stood(found).1, found.sigma).sigma);
    let wide = sigmas.fold([None; 3], |wide, of| [0, 1, 2].map(|axis| wider(wide[axis], of[axis])));
    let axis = Axis::of(Reference::Rest, nav_from_table, Attitude { sigma: wide });
    Axis { part: Some(recording), others, remarks: vec![rests.in_words()], ..axis }
}

/// What an alignment's 1σ about east, north and up are about the axes of the axis frame, widened since the
/// estimate uses the same data.
fn aligned(nav_from_table: &Dcm<Nav, Table>, sigma: (f64, f64, Option<f64>)) -> Attitude {
    let (east, north, up) = sigma;
    let wide = |sigma: f64| (FOUND_HERE * sigma).min(ANY_AZIMUTH);
    let about = Vector3::new(wide(east), wide(north), up.map_or(ANY_AZIMUTH, wide));
    let covariance = Matrix3::from_diagonal(&about.map(|sigma| sigma * sigma));
    let turned = nav_from_table.matrix().transpose() * covariance * nav_from_table.matrix();
    Attitude { sigma: [0, 1, 2].map(|axis| Some(turned[(axis, axis)].sqrt())) }
}

/// The larger of two sigmas.
fn wider(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter().chain(other).reduce(f64::max)
}

/// How much of gravity turns in the plane of rotation \[m/s²\].
pub(super) fn across_axis(gravity: f64, nav_from_table: &Dcm<Nav, Table>) -> f64 {
    gravity * nav_from_table.matrix()[(2, 0)].hypot(nav_from_table.matrix()[(2, 1)])
}

/// How far a body turns about z on the whole \[rad\].
fn spin(recording: &Recording) -> f64 {
    recording.increments.iter().map(|sample| sample.angle.components().z).sum::<f64>().abs()
}
