//! Changes of the rig file that correct wrong axes or a wrong direction of rotation.

use rins_frames::SignedAxes;
use rins_inspection::{Correction, Inspection, Suspicion};
use rins_io::{Axes, LogFormat, Rig};

use super::words::TOLD;

/// A change of the rig file that corrects all detected errors of signs and axes.
#[derive(Debug)]
pub(crate) struct Mend {
    /// The new value of `axes` under `[log] gyro`, if it changes.
    pub(crate) gyro: Option<Axes>,
    /// The new value of `axes` under `[log] accel`, if it changes.
    pub(crate) accel: Option<Axes>,
    /// The new direction of rotation of the table, if it changes.
    pub(crate) table: Option<Sense>,
}

/// The direction of rotation of a table, and the place of the rig file that states it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sense {
    place: Place,
    name: &'static str,
}

#[derive(Clone, Copy, Debug)]
enum Place {
    Angle,
    Rate,
    Profile,
}

/// The ratios of gyro rotation to table rotation about the spin axis at which only the direction of rotation is wrong.
const REVERSED: std::ops::Range<f64> = -1.4..-0.7;

/// The possible corrections; empty if nothing is wrong, or if something else is.
pub(crate) fn mends(inspection: &Inspection, rig: &Rig) -> Vec<Mend> {
    let suspicions = &inspection.suspicions;
    if let Some(corrections) = suspicions.iter().map(Suspicion::corrections).find(|c| !c.is_empty())
    {
        return corrections.iter().filter_map(|correction| mend(correction, rig)).collect();
    }
    let reversed = |suspicion: &Suspicion| matches!(suspicion, Suspicion::SpinScale { ratio, .. } if REVERSED.contains(ratio));
    match (&suspicions[..], sense(rig)) {
        ([only], Some(sense)) if reversed(only) => {
            vec![Mend { gyro: None, accel: None, table: Some(sense) }]
        }
        _ => Vec::new(),
    }
}

fn mend(correction: &Correction, rig: &Rig) -> Option<Mend> {
    let changed = |axes: &SignedAxes, now: &Axes| Some(Axes::from(*axes).after(now));
    let gyro = |axes: &SignedAxes| changed(axes, &rig.log.gyro_axes);
    let accel = |axes: &SignedAxes| changed(axes, &rig.log.accel_axes);
    let (gyro, accel, table) = match correction {
        Correction::Gyro(axes) => (gyro(axes), None, None),
        Correction::Accel(axes) => (None, accel(axes), None),
        Correction::Imu(axes) => (gyro(axes), accel(axes), None),
        Correction::TableSense => (None, None, Some(sense(rig)?)),
        Correction::GyroAndTableSense(axes) => (gyro(axes), None, Some(sense(rig)?)),
        _ => return None,
    };
    Some(Mend { gyro, accel, table })
}

/// The opposite direction of rotation of a rig's table; `None` if the rig has none.
fn sense(rig: &Rig) -> Option<Sense> {
    let of = |place, factor: f64| {
        let name = if factor < 0.0 { "forward" } else { "reversed" };
        Some(Sense { place, name })
    };
    if let LogFormat::Columns(columns) = &rig.log.format {
        if let Some(angle) = &columns.table_angle {
            return of(Place::Angle, angle.factor);
        }
        if let Some(rate) = &columns.table_rate {
            return of(Place::Rate, rate.factor);
        }
    }
    let table = rig.table.as_ref().filter(|table| table.profile.is_some())?;
    of(Place::Profile, table.sense)
}

impl Sense {
    /// The new value of the key `sense`.
    pub(crate) fn name(&self) -> &'static str {
        self.name
    }

    fn in_words(self) -> String {
        match self.place {
            Place::Angle => format!("sense = {:?} under [log] table_angle", self.name),
            Place::Rate => format!("sense = {:?} under [log] table_rate", self.name),
            Place::Profile => format!("sense = {:?} under [table]", self.name),
        }
    }
}

impl Mend {
    fn in_words(&self) -> String {
        let set = |axes: &Option<Axes>, sensor: &str| {
            axes.map(|axes| format!("axes = {:?} under [log] {sensor}", axes.names()))
        };
        let table = self.table.map(Sense::in_words);
        let parts: Vec<String> = [set(&self.gyro, "gyro"), set(&self.accel, "accel"), table]
            .into_iter()
            .flatten()
            .collect();
        parts.join(" and ")
    }
}

/// The corrections as one sentence; `None` if there are none, or too many to choose from.
pub(crate) fn mends_in_words(mends: &[Mend]) -> Option<String> {
    let words: Vec<String> = mends.iter().map(Mend::in_words).collect();
    (1..=TOLD).contains(&words.len()).then(|| format!("set {}", words.join("; or ")))
}
