//! What to write into a rig file to put wrong axes right.

use rins_io::{Axes, Rig};
use rins_motion::{Correction, Inspection, SignedAxes, Suspicion};

/// A change of the rig file that would put all right that is seen of signs and axes.
pub(crate) struct Mend {
    /// `axes` under `[log] gyro`, if they are to change.
    pub(crate) gyro: Option<Axes>,
    /// The same under `[log] accel`.
    pub(crate) accel: Option<Axes>,
}

/// The changes of which one is right; none if nothing is wrong, or something else than axes is.
pub(crate) fn mends(inspection: &Inspection, rig: &Rig) -> Vec<Mend> {
    let corrections =
        inspection.suspicions.iter().map(Suspicion::corrections).find(|c| !c.is_empty());
    corrections.unwrap_or_default().iter().filter_map(|correction| mend(correction, rig)).collect()
}

fn mend(correction: &Correction, rig: &Rig) -> Option<Mend> {
    // The correction is of axes with z along the spin axis, the rig file's are those before.
    let changed = |axes: &SignedAxes, now: &Axes| {
        let corrected = Axes::from(*axes).after(&rig.spin.after(now));
        Some(rig.spin.inverse().after(&corrected))
    };
    let (gyro, accel) = match correction {
        Correction::Gyro(axes) => (changed(axes, &rig.log.gyro_axes), None),
        Correction::Accel(axes) => (None, changed(axes, &rig.log.accel_axes)),
        Correction::Imu(axes) => {
            (changed(axes, &rig.log.gyro_axes), changed(axes, &rig.log.accel_axes))
        }
        _ => return None,
    };
    Some(Mend { gyro, accel })
}

impl Mend {
    fn in_words(&self) -> String {
        let set = |axes: &Option<Axes>, sensor: &str| {
            axes.map(|axes| format!("axes = {:?} under [log] {sensor}", axes.names()))
        };
        let parts: Vec<String> =
            [set(&self.gyro, "gyro"), set(&self.accel, "accel")].into_iter().flatten().collect();
        parts.join(" and ")
    }
}

/// The changes as one sentence; `None` if there are none, or too many to choose from.
pub(crate) fn mends_in_words(mends: &[Mend]) -> Option<String> {
    let words: Vec<String> = mends.iter().map(Mend::in_words).collect();
    (1..=super::words::TOLD).contains(&words.len()).then(|| format!("set {}", words.join("; or ")))
}
