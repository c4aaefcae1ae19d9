//! Medians: a robust average that a few outliers do not change.

/// The median of some values; the upper of the two central values if their number is even; `None` if there are none.
///
/// ```
/// assert_eq!(rins_motion::median([3.0, 1.0, 1e9]), Some(3.0));
/// assert_eq!(rins_motion::median([4.0, 1.0, 3.0, 2.0]), Some(3.0));
/// assert_eq!(rins_motion::median([]), None);
/// ```
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    let middle = values.len() / 2;
    let has_one = !values.is_empty();
    has_one.then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
