//! Anomalies of a run that are not errors but deserve attention.

use rins_inspection::{CHANNELS, Inspection, Suspicion};
use rins_io::Loaded;

use super::inspected::longest;
use super::words::suspicion_in_words;
use crate::log::repairs;

/// The relative error of the measured gravity above which it is reported: that of a calibrated accelerometer is much smaller.
const LARGEST_GRAVITY_ERROR: f64 = 0.005;

/// The relative difference between gyro and table rotation about the spin axis above which it is reported.
const LARGEST_SPIN_ERROR: f64 = 0.01;

/// The anomalies, one sentence each; suspected errors come first.
pub(super) fn oddities(inspection: &Inspection, loaded: &Loaded) -> Vec<String> {
    let mut found: Vec<String> = inspection.suspicions.iter().map(suspicion_in_words).collect();
    found.extend(repairs(&loaded.rig, &loaded.summary));
    let suspected = |suspicion: &Suspicion| matches!(suspicion, Suspicion::Gravity { .. });
    if let Some(rest) = longest(inspection)
        && !inspection.suspicions.iter().any(suspected)
    {
        let off = rest.mean.rates.specific_force.norm() / loaded.station.gravity - 1.0;
        if off.abs() > LARGEST_GRAVITY_ERROR {
            found.push(format!(
                "gravity is {:+.1} % off in the longest static interval: the accelerometers are not calibrated",
                off * 100.0
            ));
        }
    }
    let spin_suspected = inspection.suspicions.iter().any(|suspicion| {
        matches!(suspicion, Suspicion::SpinScale { .. } | Suspicion::SpinAxis { .. })
    });
    if let Some(ratio) = inspection.spin_ratio.filter(|_| !spin_suspected)
        && (ratio - 1.0).abs() > LARGEST_SPIN_ERROR
    {
        found.push(format!(
            "the rotation by the gyro about the axis of rotation is {:+.1} % off the table's: its scale, or the table's unit or profile, is wrong",
            (ratio - 1.0) * 100.0
        ));
    }
    if inspection.rests.is_empty() {
        found.push("never static for a second: nothing to align on".into());
    }
    for (channel, &run) in inspection.longest_repeat.iter().enumerate() {
        if run > 20 && run < loaded.recording.len() && inspection.resolution[channel].is_none() {
            found.push(format!("{} repeats one reading {run} times in a row", CHANNELS[channel]));
        }
    }
    found
}
