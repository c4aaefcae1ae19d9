//! The conditions of runs, from what their files say.

use std::collections::BTreeMap;

use rins_history::Conditions;
use rins_io::Measured;

use crate::log::DAY;

/// The conditions of all runs: units by serial number, power-ons by series.
pub(crate) fn conditions(measured: &[Measured]) -> Vec<Conditions> {
    let mut units: BTreeMap<Option<&String>, usize> = BTreeMap::new();
    for one in measured {
        let next = units.len();
        units.entry(one.serial.as_ref()).or_insert(next);
    }
    // The first start of each power-on that several runs share.
    let mut first: BTreeMap<(Option<&String>, &String), f64> = BTreeMap::new();
    for one in measured {
        if let (Some(series), Some(started)) = (&one.series, &one.started) {
            let earliest = first.entry((one.serial.as_ref(), series)).or_insert(started.seconds);
            *earliest = earliest.min(started.seconds);
        }
    }
    let mut power_ons: Vec<(Option<&String>, &String)> = Vec::new();
    let mut all = Vec::with_capacity(measured.len());
    for (place, one) in measured.iter().enumerate() {
        let power_on = match &one.series {
            // A run without a series has a power-on of its own.
            None => measured.len() + place,
            Some(series) => {
                let key = (one.serial.as_ref(), series);
                power_ons.iter().position(|other| *other == key).unwrap_or_else(|| {
                    power_ons.push(key);
                    power_ons.len() - 1
                })
            }
        };
        let started = one.started.as_ref().map(|started| started.seconds);
        let since_first = one
            .series
            .as_ref()
            .and_then(|series| Some(started? - first.get(&(one.serial.as_ref(), series))?));
        all.push(Conditions {
            unit: units[&one.serial.as_ref()],
            power_on,
            date: started.map(|seconds| seconds / DAY),
            since_power_on: one.since_power_on.or(since_first),
            temperature: one.temperature,
            warming: one.warming,
        });
    }
    all
}
