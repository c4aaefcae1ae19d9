//! Thinned histories: enough points for a plot, whatever the length of the run.

/// The largest number of points in a history.
const MOST_POINTS: usize = 4000;

/// The samples of a run in a history: every `stride`-th, and the last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thinning {
    stride: usize,
    last: usize,
}

impl Thinning {
    pub(crate) fn of(samples: usize) -> Self {
        Self { stride: samples.div_ceil(MOST_POINTS).max(1), last: samples.saturating_sub(1) }
    }

    pub(crate) const fn keeps(&self, index: usize) -> bool {
        index.is_multiple_of(self.stride) || index == self.last
    }
}
