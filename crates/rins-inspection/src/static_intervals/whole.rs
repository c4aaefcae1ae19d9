//! Whole numbers of cells.

/// A ratio of positive durations as a whole number, one at least.
pub(super) fn whole(ratio: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is positive, and at most the number of samples"
    )]
    let whole = ratio.round() as usize;
    whole.max(1)
}
