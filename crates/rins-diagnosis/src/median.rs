//! Medians: a few values far from the others do not move them.

/// The median of some values; of none it is no number.
pub(crate) fn median(values: &[f64]) -> f64 {
    rins_motion::median(values.iter().copied()).unwrap_or(f64::NAN)
}

/// The median of those up to `reach` places from one, itself among them.
pub(crate) fn median_about(values: &[f64], place: usize, reach: usize) -> f64 {
    median(&values[place.saturating_sub(reach)..values.len().min(place + reach + 1)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    #[test]
    fn half_of_the_values_are_below() {
        assert_close!(median(&[3.0, 1.0, 1e9]), 3.0, 1e-12);
        assert_close!(median(&[4.0, 1.0, 3.0, 2.0]), 3.0, 1e-12);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn only_what_is_near_counts() {
        let values = [9.0, 1.0, 2.0, 3.0, 8.0, 7.0];
        assert_close!(median_about(&values, 2, 1), 2.0, 1e-12);
        assert_close!(median_about(&values, 0, 1), 9.0, 1e-12);
        assert_close!(median_about(&values, 5, 2), 7.0, 1e-12);
    }
}
