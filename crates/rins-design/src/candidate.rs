//! A schedule of the library.

use rins_motion::Segment;

use crate::planned::Planned;

/// A schedule of the library.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Its description.
    pub words: String,
    /// Its runs, one for each direction of the axis.
    pub runs: Vec<Planned>,
    /// The rates and durations in each run \[rad/s, s\].
    pub segments: Vec<Segment>,
    /// The total duration \[s\].
    pub duration: f64,
}

impl Candidate {
    /// Whether it has the same duration and the same number of directions of the axis.
    pub(crate) fn is_as_long_as(&self, other: &Self) -> bool {
        self.runs.len() == other.runs.len() && self.duration.total_cmp(&other.duration).is_eq()
    }
}
