//! When and how a log was made, for its calibration.

use rins_io::{Measured, Rig};
use rins_motion::Recording;

/// What the rig file and the recordings of one run, in the order of time, say of when and how it was made.
pub(crate) fn measured<'r>(
    rig: &Rig,
    recordings: impl IntoIterator<Item = &'r Recording>,
) -> Measured {
    let run = &rig.run;
    let recordings: Vec<&Recording> = recordings.into_iter().collect();
    let end = recordings.last().and_then(|last| last.times.last());
    let start = recordings.first().and_then(|first| first.times.first());
    let duration = end.zip(start).map_or(0.0, |(end, start)| end - start);
    let temperature: Vec<f64> =
        recordings.iter().filter_map(|one| one.temperature.as_deref()).flatten().copied().collect();
    Measured {
        serial: run.serial.clone(),
        series: run.series.clone(),
        started: run.started.clone(),
        since_power_on: run.since_power_on.map(|start| start + 0.5 * duration),
        temperature: mean(&temperature),
        warming: warming(&temperature),
        laboratory: rig.laboratory.clone(),
    }
}

/// What several runs of one calibration have in common, and when the first of them started.
pub(crate) fn measured_together(each: &[Measured]) -> Measured {
    let [first, others @ ..] = each else { return Measured::default() };
    if others.is_empty() {
        return first.clone();
    }
    let same = |of: fn(&Measured) -> Option<&String>| {
        of(first).filter(|own| others.iter().all(|other| of(other) == Some(own))).cloned()
    };
    let started = each.iter().filter_map(|one| one.started.as_ref());
    Measured {
        serial: same(|one| one.serial.as_ref()),
        series: same(|one| one.series.as_ref()),
        started: started.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).cloned(),
        laboratory: first.laboratory.clone(),
        ..Measured::default()
    }
}

/// The mean; `None` of nothing.
fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The direction in which a temperature changed: from the first to the last third of a run by more than it scatters within a third.
fn warming(temperature: &[f64]) -> Option<f64> {
    let third = temperature.len() / 3;
    let (first, last) = (&temperature[..third], &temperature[temperature.len() - third..]);
    let (from, to) = (mean(first)?, mean(last)?);
    let variance = |values: &[f64], mean: f64| {
        values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64
    };
    let scatter = variance(first, from).max(variance(last, to)).sqrt();
    ((to - from).abs() > scatter).then(|| (to - from).signum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn temperature_that_scatters_neither_rises_nor_falls() {
        let ramp =
            |slope: f64| -> Vec<f64> { (0..300).map(|at| 20.0 + slope * f64::from(at)).collect() };
        assert_eq!(warming(&ramp(0.01)), Some(1.0));
        assert_eq!(warming(&ramp(-0.01)), Some(-1.0));
        let noise = (0..300).map(|at: i32| 20.0 + f64::from(at % 7) + 0.001 * f64::from(at));
        assert_eq!(warming(&noise.collect::<Vec<f64>>()), None);
        assert_eq!(warming(&[]), None);
    }
}
