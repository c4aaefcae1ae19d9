//! A log prepared for the estimation: its angle reference, and the attitude of its axis.

use anyhow::Context;
use rins_calibration::{Setup, likely_wobble};
use rins_estimation::{AngleSteps, Reference, Rig, Run};
use rins_frames::units::ARCSEC;
use rins_imu::ImuSpec;
use rins_inspection::{CHANNELS, Repeats, StaticIntervals};
use rins_io::{Loaded, shown};

use super::attitude::Attitude;
use super::axis::{Axis, axis};
use super::rests;
use crate::basis::BasisResult;
use crate::check::refuse_mistaken;
use crate::log::{
    Log, StaticIntervalResult, lasting, only, setup, static_intervals, statics_in_words,
    statics_result,
};
use crate::options::NoiseChoice;

/// The initial value of the wobble of an axis without encoder, on a floor or in a hand \[rad\].
const UNREAD_WOBBLE: f64 = 20.0 * ARCSEC;

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
    /// Its basis: inputs, repairs and assumptions.
    pub(crate) basis: BasisResult,
}

/// The station, table and IMU of a rig, after a check for gross errors of units, signs and axes, and what was assumed of
/// data sheet and site; every estimation starts here.
pub(crate) fn screened(loaded: &Loaded) -> anyhow::Result<(Setup, Vec<String>)> {
    let setup = setup(loaded);
    refuse_mistaken(loaded)?;
    Ok(setup)
}

impl Prepared {
    /// Prepares a log.
    pub(crate) fn of(log: Log, noise: NoiseChoice) -> anyhow::Result<Self> {
        let (mut setup, assumptions) = screened(&log.loaded)?;
        let basis = BasisResult::of_log(&log).assuming(assumptions.iter().cloned());
        let Log { name, mut loaded, .. } = log;
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
        run.in_sequence = axis.in_sequence;
        let others = axis.others.into_iter().map(|still| {
            let rig =
                Rig { nav_from_table: still.nav_from_table, reference: Reference::Rest, ..rig };
            let mut run = Run::new(rig, still.recording).with_context(log)?.with_axes(axes);
            run.in_sequence = still.in_sequence;
            anyhow::Ok(run)
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
        Ok(Self {
            name,
            loaded,
            imu,
            run,
            others,
            repeats,
            attitude,
            static_intervals,
            remarks,
            basis,
        })
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
        self.run.in_sequence = None;
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
