//! Thinned histories: enough points to draw, whatever the length of the run.

/// How many points a history keeps, at most.
const MOST_POINTS: usize = 4000;

/// Which samples of a run a history keeps: every `stride`-th, and the last.
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
