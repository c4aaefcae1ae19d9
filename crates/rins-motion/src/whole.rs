//! Integer numbers of samples.

/// A ratio of positive durations or angles as a number of samples: rounded to the nearest integer, at least one.
///
/// ```
/// assert_eq!(rins_motion::whole(0.1 / 0.01), 10);
/// assert_eq!(rins_motion::whole(0.2), 1);
/// ```
pub fn whole(ratio: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is positive, and at most the number of samples"
    )]
    let whole = ratio.round() as usize;
    whole.max(1)
}
