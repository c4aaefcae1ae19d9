//! A log of many rests: an IMU that was turned over from one attitude to the next, by hand or on anything.

use nalgebra::Vector3;
use rins_frames::units::DEG;
use rins_io::Loaded;

use crate::commands::align::{Found, found_over};
use crate::commands::statics::static_intervals;

/// The shortest rest that is used \[s\].
pub(super) const SHORTEST: f64 = 2.0;

/// Rests between which gravity turns by less stand alike \[rad\].
const ALIKE: f64 = 5.0 * DEG;

/// In fewer attitudes gravity tells hardly more than at the longest rest.
const FEWEST_ATTITUDES: usize = 3;

/// The rests of one log, how each stands, and in how many attitudes.
pub(crate) struct Rests {
    /// In order of time.
    pub(super) found: Vec<Found>,
    /// How many attitudes gravity tells apart.
    pub(super) attitudes: usize,
    /// From when to when there are rests \[s\].
    pub(super) lasting: [f64; 2],
}

impl Rests {
    /// Those of a log that rests in several attitudes.
    pub(super) fn of(loaded: &Loaded) -> anyhow::Result<Option<Self>> {
        let recording = &loaded.recording;
        let mut ways: Vec<Vector3<f64>> = Vec::new();
        let spans = static_intervals(loaded).spans(SHORTEST);
        for span in &spans {
            let gained = recording.increments[span.clone()].iter().map(|s| s.velocity.components());
            let up: Vector3<f64> = gained.sum();
            if ways.iter().all(|way| way.angle(&up) > ALIKE) {
                ways.push(up);
            }
        }
        if ways.len() < FEWEST_ATTITUDES {
            return Ok(None);
        }
        let found = spans.into_iter().map(|span| found_over(loaded, span));
        let found = found.collect::<anyhow::Result<Vec<Found>>>()?;
        let end = found.last().map_or(0.0, |last| recording.times[last.span.end - 1]);
        let lasting = [found.first().map_or(0.0, |first| first.start), end];
        Ok(Some(Self { found, attitudes: ways.len(), lasting }))
    }

    /// The longest.
    pub(super) fn longest(&self) -> usize {
        let length = |place: &usize| self.found[*place].span.len();
        (0..self.found.len()).max_by_key(length).unwrap_or_default()
    }

    /// How many there are and when, in words.
    pub(super) fn in_words(&self) -> String {
        let [from, to] = self.lasting;
        format!(
            "Nothing reads a table and nothing turns about the axis: {} rests in {} attitudes, from {from:.0} s to {to:.0} s, \
             are used. How each stands is estimated too, and not listed.",
            self.found.len(),
            self.attitudes
        )
    }
}
