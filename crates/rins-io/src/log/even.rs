//! Time stamps of an even clock that were rounded when they were written.

use rins_motion::median;

use super::summary::Rounded;

/// The smallest decimal unit of a second to which stamps are rounded, as a power of ten.
const FINEST: i32 = 9;

/// The maximum difference between rounded stamps and those of an even clock, as peak and rms, in units of the last decimal.
/// Rounding gives at most half a unit, and 0.29 rms, or 0.36 rms if every second tick is half a unit off. The stamps of a clock
/// that alternates by a unit are all half a unit off.
const APART: (f64, f64) = (0.6, 0.4);

/// Steps with a smaller difference, in the same units, count as even.
const EVEN: f64 = 0.01;

/// If a step is longer than this number of medians, the mean step is not meaningful.
const GAP: f64 = 2.5;

/// Replaces `times` \[s\] by the stamps of an even clock, if they differ from these by rounding only.
///
/// Rounded stamps of, say, 1/123.4 s are early and late in a periodic pattern, and the intervals have twice the error: an angle
/// computed from a rate and an interval would have spectral lines. A clock with the `nominal` interval \[s\] is used if it fits.
pub(super) fn undo_rounding(times: &mut [f64], nominal: Option<f64>) -> Option<Rounded> {
    let unit = last_decimal(times)?;
    let steps = || times.windows(2).map(|pair| pair[1] - pair[0]);
    let median = median(steps())?;
    let (count, sum) = steps()
        .filter(|step| *step < GAP * median)
        .fold((0.0, 0.0), |(count, sum), step| (count + 1.0, sum + step));
    let mean = nominal.unwrap_or(sum / count);
    let ticks = || {
        let tick = |tick: &mut f64, step: f64| {
            *tick += (step / mean).round();
            Some(*tick)
        };
        std::iter::once(0.0).chain(steps().scan(0.0, tick))
    };
    // A step below half the mean would repeat a tick; and steps that are multiples of the median were not rounded.
    let multiple = |step: f64| (step - (step / median).round() * median).abs() < EVEN * unit;
    let kept = |step: f64| step >= GAP * median || multiple(step);
    if steps().any(|step| step < 0.5 * mean) || steps().all(kept) {
        return None;
    }
    let fits = |&(start, interval): &(f64, f64)| {
        let off = |(time, tick): (&f64, f64)| (time - start - interval * tick).abs() / unit;
        let add = |(most, sum): (f64, f64), off: f64| (most.max(off), sum + off * off);
        let (most, sum) = times.iter().zip(ticks()).map(off).fold((0.0, 0.0), add);
        most < APART.0 && sum < APART.1 * APART.1 * times.len() as f64
    };
    let clocks = [nominal.map(|interval| clock(times, ticks, interval)), fitted(times, ticks)];
    let (start, interval) = clocks.into_iter().flatten().find(fits)?;
    let even: Vec<f64> = ticks().map(|tick| start + interval * tick).collect();
    times.copy_from_slice(&even);
    Some(Rounded { unit, interval })
}

/// The decimal unit \[s\] of which all times are multiples, to double precision.
fn last_decimal(times: &[f64]) -> Option<f64> {
    let largest = times.iter().fold(0.0, |most: f64, time| most.max(time.abs()));
    let is_multiple = |time: f64, per_second: f64| {
        let ticks = time * per_second;
        (ticks - ticks.round()).abs() <= 8.0 * f64::EPSILON * ticks.abs()
    };
    let decimals = (0..=FINEST).find(|&decimals| {
        let per_second = 10_f64.powi(decimals);
        times.iter().all(|&time| is_multiple(time, per_second))
    })?;
    let unit = 10_f64.powi(-decimals);
    // For large times, double precision is not sufficient for this conclusion.
    (times.len() > 2 && 8.0 * f64::EPSILON * largest < EVEN * unit).then_some(unit)
}

/// Start and interval \[s\] of the clock with this interval that is nearest to `times`.
fn clock<I: Iterator<Item = f64>>(
    times: &[f64],
    ticks: impl Fn() -> I,
    interval: f64,
) -> (f64, f64) {
    let sum: f64 = times.iter().zip(ticks()).map(|(time, tick)| time - interval * tick).sum();
    (sum / times.len() as f64, interval)
}

/// Start and interval \[s\] of the least-squares clock of `times`.
fn fitted<I: Iterator<Item = f64>>(times: &[f64], ticks: impl Fn() -> I) -> Option<(f64, f64)> {
    let count = times.len() as f64;
    let middle = ticks().sum::<f64>() / count;
    let (mut across, mut along) = (0.0, 0.0);
    for (time, tick) in times.iter().zip(ticks()) {
        across += (tick - middle) * (time - times[0]);
        along += (tick - middle) * (tick - middle);
    }
    (along > 0.0).then(|| clock(times, ticks, across / along))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamps(rate: f64, unit: f64, count: u32) -> Vec<f64> {
        // As parsed from text: the double nearest to a decimal.
        let per_second = unit.recip().round();
        let rounded = |tick| (f64::from(tick) / rate / unit).round_ties_even() / per_second;
        (0..count).map(rounded).collect()
    }

    #[test]
    fn rounded_stamps_are_those_of_the_even_clock() {
        for (rate, unit) in
            [(123.4, 1e-6), (123.4, 1e-3), (300.0, 1e-6), (75.0, 1e-3), (128.0, 1e-6)]
        {
            for nominal in [None, Some(1.0 / rate)] {
                let mut times = stamps(rate, unit, 40_000);
                let rounded = undo_rounding(&mut times, nominal).unwrap();
                assert!((rounded.unit / unit - 1.0).abs() < 1e-12);
                assert!((rounded.interval * rate - 1.0).abs() < 1e-9, "{rounded:?}");
                let steps = times.windows(2).map(|pair| (pair[1] - pair[0]) * rate - 1.0);
                assert!(steps.fold(0.0, |most: f64, off| most.max(off.abs())) < 1e-6);
            }
        }
    }

    #[test]
    fn lost_samples_stay_lost() {
        let mut times = stamps(123.4, 1e-3, 2_000);
        times.drain(700..703);
        undo_rounding(&mut times, None).unwrap();
        assert!(((times[700] - times[699]) * 123.4 - 4.0).abs() < 1e-3);
    }

    #[test]
    fn even_and_uneven_stamps_are_left_alone() {
        let uneven = |tick: u32| f64::from(tick * 10_000 + tick % 2) / 1e6;
        for mut times in [stamps(100.0, 1e-3, 500), (0..500).map(uneven).collect(), vec![0.1, 0.2]]
        {
            let before = times.clone();
            assert_eq!(undo_rounding(&mut times, None), None);
            assert_eq!(times, before);
        }
        // A clock that was never rounded.
        let mut exact: Vec<f64> = (0..500).map(|tick| f64::from(tick) / 123.4).collect();
        assert_eq!(undo_rounding(&mut exact, None), None);
    }
}
