//! How fast a slow reading changes.

/// The time on either side of a sample over which a temperature's slope is taken \[s\].
///
/// From one sample to the next a thermometer's resolution, 0.001 K in 0.01 s, is a hundred times what a warm-up does.
/// Heat takes longer than this to go through a sensor.
const REACH: f64 = 5.0;

/// As little as is taken near an end of the run, where there is no more on one side \[s\].
const LEAST_REACH: f64 = 2.0;

/// The slope of `values` at each of `times`, a unit of theirs a second: of the means before and after, over the
/// [`REACH`] on either side, or as much of it as there is on both.
///
/// Times rise; a value that stands alone has no slope.
pub(crate) fn slopes(times: &[f64], values: &[f64]) -> Vec<f64> {
    let (time_sums, value_sums) = (sums(times), sums(values));
    let mean = |sums: &[f64], from: usize, to: usize| (sums[to] - sums[from]) / (to - from) as f64;
    let (mut first, mut end) = (0, 0);
    let slope = |&time: &f64| {
        let both = f64::min(time - times[0], times[times.len() - 1] - time);
        let reach = both.clamp(LEAST_REACH, REACH);
        while times[first] < time - reach {
            first += 1;
        }
        while end < times.len() && times[end] <= time + reach {
            end += 1;
        }
        let middle = usize::midpoint(first, end);
        if first == middle {
            return 0.0;
        }
        let across = |sums: &[f64]| mean(sums, middle, end) - mean(sums, first, middle);
        across(&value_sums) / across(&time_sums)
    };
    times.iter().map(slope).collect()
}

/// The sums of all that come before each, and of all; from the first one on, which keeps them small.
fn sums(list: &[f64]) -> Vec<f64> {
    let first = list.first().copied().unwrap_or_default();
    let sum = |sum: &mut f64, &value: &f64| {
        *sum += value - first;
        Some(*sum)
    };
    std::iter::once(0.0).chain(list.iter().scan(0.0, sum)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A warm-up of 4 K in 3 min, read every 10 ms to 0.001 K.
    fn read() -> (Vec<f64>, Vec<f64>) {
        let times: Vec<f64> = (1..=36_000).map(|sample| 0.01 * f64::from(sample)).collect();
        let warmth = |time: &f64| (4000.0 * (1.0 - (-time / 180.0).exp())).round() / 1000.0;
        let values = times.iter().map(warmth).collect();
        (times, values)
    }

    #[test]
    fn a_resolution_does_not_hide_a_warm_up() {
        let (times, values) = read();
        for (time, slope) in times.iter().zip(slopes(&times, &values)) {
            let rate = 4.0 / 180.0 * (-time / 180.0).exp();
            // At the ends the slope is that of the two seconds there.
            let allowed = if (10.0..350.0).contains(time) { 0.01 } else { 0.03 };
            assert!((slope - rate).abs() < allowed * rate, "{time}: {slope}, {rate}");
        }
    }

    #[test]
    fn gaps_and_short_runs_have_the_slope_that_they_show() {
        let times = [0.0, 1.0, 2.0, 100.0, 101.0, 300.0];
        let line: Vec<f64> = times.iter().map(|time| 20.0 + 0.5 * time).collect();
        assert_eq!(slopes(&times, &line), [0.5, 0.5, 0.5, 0.5, 0.5, 0.0]);
        assert_eq!(slopes(&[], &[]), [0.0; 0]);
    }
}
