//! Static intervals of an IMU: one search for everything that needs them.
//!
//! The log is divided into cells of a tenth of a second. Cells that scatter no more than the quietest parts of the log form
//! runs; a run is split where its mean rate changes. Gravity must have a constant direction in the body over each part. A
//! rotation about the vertical, which only the mean rate shows, is distinguished from a bias by the size of biases and by the
//! other parts of the log. Finally ends are trimmed to the noise, and parts are joined over disturbances that do not change
//! the attitude.

mod bias;
mod cells;
mod drift;
mod interval;
mod noise;
mod options;
mod search;
mod split;
mod stated;
mod table;
mod wander;

use std::ops::Range;

pub use interval::{NotStatic, StaticInterval};
pub use options::{SensorFigures, StaticOptions};

use self::search::Search;
use rins_motion::Recording;

/// The static intervals of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StaticIntervals {
    /// Those that are used and the rejected candidates, in order of time.
    pub all: Vec<StaticInterval>,
}

impl StaticIntervals {
    /// Those that the user states or, if none are stated, those found in the samples.
    ///
    /// ```
    /// use rins_frames::{InFrame, Rates};
    /// use rins_inspection::{StaticIntervals, StaticOptions};
    /// use rins_motion::Recording;
    /// let still = Rates { angular_rate: InFrame::new(0.0, 0.0, 0.01), specific_force: InFrame::new(0.0, 0.0, 9.8) };
    /// let turning = Rates { angular_rate: InFrame::new(0.0, 0.0, 0.5), ..still };
    /// let increments = [still, turning].map(|rates| vec![rates.over(0.01); 300]).concat();
    /// let times = (1..=increments.len()).map(|count| 0.01 * count as f64).collect();
    /// let recording = Recording { times, increments, ..Recording::default() };
    /// let found = StaticIntervals::of(&recording, &StaticOptions::default());
    /// assert_eq!(found.spans(2.0), [0..300]);
    /// ```
    pub fn of(recording: &Recording, options: &StaticOptions) -> Self {
        if recording.is_empty() {
            return Self::default();
        }
        let search = Search::new(recording, options);
        let all = if options.stated.is_empty() { search.found() } else { search.stated() };
        Self { all }
    }

    /// Those that are used.
    pub fn used(&self) -> impl Iterator<Item = &StaticInterval> {
        self.all.iter().filter(|interval| interval.used())
    }

    /// The samples of those that are used and have at least the duration `shortest` \[s\].
    pub fn spans(&self, shortest: f64) -> Vec<Range<usize>> {
        let long = |interval: &&StaticInterval| interval.duration() >= shortest * (1.0 - 1e-9);
        self.used().filter(long).map(|interval| interval.span.clone()).collect()
    }

    /// The longest one that is used.
    pub fn longest(&self) -> Option<&StaticInterval> {
        self.used().max_by(|a, b| a.duration().total_cmp(&b.duration()))
    }
}
