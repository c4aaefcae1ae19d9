//! When an IMU is stationary: one search for all that needs static intervals.
//!
//! The search goes from the inside out. The log is cut into cells of a tenth of a second. Cells that scatter no more than
//! the quietest parts of the log form runs; a run is split where its mean rate changes; gravity must keep its direction in
//! the body over each part, and what only the mean rate shows, a turn about the vertical, is judged by the size of biases
//! and by the other parts of the log. Ends are then trimmed to noise, and parts joined over disturbances that leave the
//! attitude as it was.

mod bias;
mod cells;
mod drift;
mod noise;
mod options;
mod search;
mod split;
mod stated;
mod table;
mod wander;

use std::fmt;
use std::ops::Range;

use rins_frames::units::{DEG, DEG_PER_SECOND};

pub use options::{SensorFigures, StaticOptions};

use self::search::Search;
use rins_motion::Recording;

/// Why a span is not a static interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotStatic {
    /// It is short.
    TooShort {
        /// How long it must be \[s\].
        shortest: f64,
    },
    /// Gravity changes its direction in the body.
    GravityTurns {
        /// How far, from one end to the other or the farthest \[rad\].
        angle: f64,
    },
    /// The gyros turn and turn back.
    Rotates {
        /// How far, the mean rate removed \[rad\].
        angle: f64,
    },
    /// The mean rate about the vertical is no bias.
    RateBeyondBias {
        /// The rate \[rad/s\].
        rate: f64,
        /// The largest that is taken for a bias \[rad/s\].
        limit: f64,
        /// Whether the limit follows from the data sheet.
        stated: bool,
    },
    /// The mean rate about the vertical is not that of the other static intervals.
    RateDiffers {
        /// By how much \[rad/s\].
        apart: f64,
        /// By how much it may \[rad/s\].
        allowed: f64,
    },
    /// The table turns.
    TableTurns,
    /// The recording holds no sample of it.
    NoSamples,
}

impl fmt::Display for NotStatic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = |rate: f64| rate / DEG_PER_SECOND;
        match *self {
            Self::TooShort { shortest } => write!(f, "shorter than {shortest:.1} s"),
            Self::GravityTurns { angle } => {
                write!(f, "moves: gravity turns in the body by {:.2} deg", angle / DEG)
            }
            Self::Rotates { angle } => {
                write!(f, "moves: the gyros, their mean removed, turn by {:.2} deg", angle / DEG)
            }
            Self::RateBeyondBias { rate: seen, limit, stated } => write!(
                f,
                "moves: {:.3} deg/s about the vertical, where {} allows a bias of {:.3} deg/s",
                rate(seen),
                if stated { "bias_sigma" } else { "the assumption made without a bias_sigma" },
                rate(limit)
            ),
            Self::RateDiffers { apart, allowed } => write!(
                f,
                "moves: the rate about the vertical differs from the other static intervals' by {:.4} deg/s, and {:.4} \
                 deg/s are allowed",
                rate(apart),
                rate(allowed)
            ),
            Self::TableTurns => write!(f, "moves: the table turns"),
            Self::NoSamples => write!(f, "holds no samples"),
        }
    }
}

/// A span that was taken for a static interval or looked like one.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticInterval {
    /// The samples.
    pub span: Range<usize>,
    /// When the first sample's interval starts \[s\].
    pub start: f64,
    /// When the last one's ends \[s\].
    pub end: f64,
    /// Why it is none, if it is none; of a stated interval, what contradicts the statement.
    pub why: Option<NotStatic>,
    /// Whether the user states it.
    pub stated: bool,
    /// The samples in it during which something disturbed the IMU, or nothing was measured; the attitude is the same after
    /// each.
    pub disturbances: Vec<Range<usize>>,
}

impl StaticInterval {
    /// Whether it is used: what is found is static, and what is stated is believed.
    pub const fn used(&self) -> bool {
        self.stated || self.why.is_none()
    }

    /// How long it lasts \[s\].
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }

    /// What a reader must know of it: why it is not used, or what speaks against it or disturbs it.
    pub fn remark(&self) -> Option<String> {
        match (&self.why, self.stated, self.disturbances.len()) {
            (Some(why), true, _) => Some(format!("stated as static, but it {why}")),
            (Some(why), false, _) => Some(why.to_string()),
            (None, _, 0) => None,
            (None, _, count) => Some(format!(
                "bridged over {count} disturbance(s) or gap(s) that leave the attitude unchanged"
            )),
        }
    }
}

/// The static intervals of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StaticIntervals {
    /// Those that are used and those that look like one and are none, in order of time.
    pub all: Vec<StaticInterval>,
}

impl StaticIntervals {
    /// Those that the user states or, if none is stated, those that the samples show.
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

    /// The samples of those that are used and last as long as `shortest` \[s\].
    pub fn spans(&self, shortest: f64) -> Vec<Range<usize>> {
        let long = |interval: &&StaticInterval| interval.duration() >= shortest * (1.0 - 1e-9);
        self.used().filter(long).map(|interval| interval.span.clone()).collect()
    }

    /// The longest that is used.
    pub fn longest(&self) -> Option<&StaticInterval> {
        self.used().max_by(|a, b| a.duration().total_cmp(&b.duration()))
    }
}
/// The runs of true.
fn runs(flags: &[bool]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (index, _) in flags.iter().enumerate().filter(|(_, flag)| **flag) {
        match runs.last_mut() {
            Some(run) if run.end == index => run.end = index + 1,
            _ => runs.push(index..index + 1),
        }
    }
    runs
}

/// A ratio of positive durations as a whole number, one at least.
fn whole(ratio: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is positive, and at most the number of samples"
    )]
    let whole = ratio.round() as usize;
    whole.max(1)
}
