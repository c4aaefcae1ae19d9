//! Mean and standard deviation of a sample.

/// Mean and standard deviation of some numbers, in their unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    /// The number of numbers.
    pub(crate) count: usize,
    /// The mean.
    pub(crate) mean: f64,
    /// The standard deviation about the mean, with the divisor `count - 1`.
    pub(crate) deviation: f64,
}

impl Sample {
    /// The sample of these numbers, in their order; the mean of no numbers is NaN.
    pub(crate) fn of(numbers: impl IntoIterator<Item = f64>) -> Self {
        // Welford's algorithm.
        let (mut count, mut mean, mut squares) = (0_usize, 0.0, 0.0);
        for number in numbers {
            count += 1;
            let off = number - mean;
            mean += off / count as f64;
            squares += off * (number - mean);
        }
        if count == 0 {
            return Self { count, mean: f64::NAN, deviation: f64::NAN };
        }
        let deviation = if count > 1 { (squares / (count - 1) as f64).sqrt() } else { 0.0 };
        Self { count, mean, deviation }
    }

    /// The distance of `value` from the mean, in standard deviations.
    pub(crate) fn deviations_to(&self, value: f64) -> f64 {
        (value - self.mean) / self.deviation
    }
}

/// The root mean square of some numbers.
pub(crate) fn root_mean_square(numbers: &[f64]) -> f64 {
    (numbers.iter().map(|number| number * number).sum::<f64>() / numbers.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    #[test]
    fn mean_and_deviation_are_those_of_a_small_example() {
        let sample = Sample::of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert_eq!(sample.count, 8);
        assert_close!(sample.mean, 5.0, 1e-15);
        assert_close!(sample.deviation, (32.0_f64 / 7.0).sqrt(), 1e-15);
        assert_close!(sample.deviations_to(5.0 + sample.deviation), 1.0, 1e-15);
        assert_close!(root_mean_square(&[3.0, 4.0]), 12.5_f64.sqrt(), 1e-15);
    }
}
