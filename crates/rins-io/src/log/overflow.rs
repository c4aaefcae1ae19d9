//! Time columns that start again from zero: counters of a limited width, times of day, GPS seconds of week.

use rins_motion::median;

/// The widths of counters \[bit\].
const WIDTHS: [i32; 4] = [8, 16, 24, 32];

/// The periods of times of day and of GPS seconds of week \[s\].
const PERIODS: [f64; 2] = [86_400.0, 604_800.0];

/// The largest difference of the step over an overflow from the median step, in median steps.
const TOLERANCE: f64 = 0.5;

/// An overflow of a time column, after which its values are continued.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overflow {
    /// The row after the overflow, from zero.
    pub row: usize,
    /// The period of the column, in its own unit.
    pub period: f64,
}

/// Continues times over the overflows of their column, of which one unit is `unit` \[s\]: none for a counter of samples.
///
/// An overflow is a step back that the addition of one period makes a usual step. Other steps back are left as they are.
pub(crate) fn continued(times: &mut [f64], unit: Option<f64>) -> Vec<Overflow> {
    let has_step_back = times.windows(2).any(|pair| pair[1] < pair[0]);
    let forward = times.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0);
    let Some(usual) = median(forward).filter(|_| has_step_back) else { return Vec::new() };
    let unit_length = unit.unwrap_or(1.0);
    let counters = WIDTHS.map(|width| 2_f64.powi(width));
    let clocks = PERIODS.into_iter().filter(|_| unit.is_some()).map(|period| period / unit_length);
    let periods: Vec<f64> = counters.into_iter().chain(clocks).collect();
    let mut overflows = Vec::new();
    let (mut offset, mut before) = (0.0, times[0]);
    for (row, time) in times.iter_mut().enumerate() {
        let step_back = *time < before;
        if step_back {
            let fits = |period: &&f64| {
                let length = *period * unit_length;
                let step = *time + length - before;
                (step - usual).abs() <= TOLERANCE * usual && *time >= 0.0 && before < length
            };
            if let Some(period) = periods.iter().find(fits) {
                offset += period * unit_length;
                overflows.push(Overflow { row, period: *period });
            }
        }
        before = *time;
        *time += offset;
    }
    overflows
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Whatever its width, rate and start, a counter goes on over its overflows as if it had none.
        #[test]
        fn overflows_are_continued(
            width in prop::sample::select(WIDTHS.to_vec()),
            step in 1_u64..5000,
            start in any::<u64>(),
            jitter in 0_u64..3,
        ) {
            let period = 1_u64 << width;
            // Fewer than three steps in a period are no counter that can be followed.
            prop_assume!(step * 4 < period);
            let unit = 1e-6;
            let start = start % period;
            let counts: Vec<u64> =
                (0..400).map(|row| start + row * step + if step > 8 { (row * 7) % (jitter + 1) } else { 0 }).collect();
            let seconds = |count: u64| count as f64 * unit;
            let mut times: Vec<f64> = counts.iter().map(|count| seconds(count % period)).collect();
            let overflows = continued(&mut times, Some(unit));
            let turns = counts[399] / period;
            prop_assert_eq!(overflows.len() as u64, turns);
            for (time, count) in times.iter().zip(&counts) {
                prop_assert!((time - seconds(*count)).abs() < 1e-3 * unit, "{time} {count}");
            }
        }
    }

    #[test]
    fn steps_back_that_are_no_overflow_stay() {
        for at in [0.3, 0.9, 4000.0] {
            let mut times: Vec<f64> = (0..200).map(|row| at + 0.01 * f64::from(row)).collect();
            times[100] -= 0.25;
            let before = times.clone();
            assert_eq!(continued(&mut times, Some(1e-6)), []);
            assert_eq!(times, before);
        }
    }

    #[test]
    fn days_and_weeks_end() {
        for period in PERIODS {
            let mut times: Vec<f64> =
                (0..100).map(|row| (period - 0.5 + 0.01 * f64::from(row)) % period).collect();
            assert_eq!(continued(&mut times, Some(1.0)), [Overflow { row: 50, period }]);
            assert!(times.windows(2).all(|pair| (pair[1] - pair[0] - 0.01).abs() < 1e-9));
        }
    }
}
