//! A static interval, or a candidate with the reason for its rejection.

use std::fmt;
use std::ops::Range;

use rins_frames::units::{DEG, DEG_PER_SECOND};

/// The reason why a span is not a static interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotStatic {
    /// It is too short.
    TooShort {
        /// The shortest duration \[s\].
        shortest: f64,
    },
    /// Gravity changes its direction in the body.
    GravityTurns {
        /// The largest change, between the ends or to any point \[rad\].
        angle: f64,
    },
    /// The gyros measure a rotation forth and back.
    Rotates {
        /// The largest angle, after removal of the mean rate \[rad\].
        angle: f64,
    },
    /// The mean rate about the vertical exceeds a bias.
    RateBeyondBias {
        /// The rate \[rad/s\].
        rate: f64,
        /// The largest rate that may be a bias \[rad/s\].
        limit: f64,
        /// Whether the limit follows from the data sheet.
        stated: bool,
    },
    /// The mean rate about the vertical differs from that of the other static intervals.
    RateDiffers {
        /// The difference \[rad/s\].
        apart: f64,
        /// The limit of the difference \[rad/s\].
        allowed: f64,
    },
    /// The table rotates.
    TableTurns,
    /// The recording has no sample in it.
    NoSamples,
}

impl fmt::Display for NotStatic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = |rate: f64| rate / DEG_PER_SECOND;
        match *self {
            Self::TooShort { shortest } => write!(f, "shorter than {shortest:.1} s"),
            Self::GravityTurns { angle } => {
                write!(f, "moves: gravity rotates in the body frame by {:.2} deg", angle / DEG)
            }
            Self::Rotates { angle } => {
                write!(f, "moves: the gyros, their mean removed, rotate by {:.2} deg", angle / DEG)
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
                "moves: the rate about the vertical differs from that of the other static intervals by \
                 {:.4} deg/s; {:.4} deg/s are allowed",
                rate(apart),
                rate(allowed)
            ),
            Self::TableTurns => write!(f, "moves: the table rotates"),
            Self::NoSamples => write!(f, "holds no samples"),
        }
    }
}

/// A static interval, or a span that resembles one.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticInterval {
    /// The samples.
    pub span: Range<usize>,
    /// The start of the first sample's interval \[s\].
    pub start: f64,
    /// The end of the last sample's interval \[s\].
    pub end: f64,
    /// The reason for its rejection, if any; for a stated interval, the contradiction to the statement.
    pub why: Option<NotStatic>,
    /// Whether the user states it.
    pub stated: bool,
    /// The samples in it during which the IMU was disturbed, or without measurements; the attitude is the same after each.
    pub disturbances: Vec<Range<usize>>,
}

impl StaticInterval {
    /// Whether it is used: it was found to be static, or it is stated.
    pub const fn used(&self) -> bool {
        self.stated || self.why.is_none()
    }

    /// The duration \[s\].
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }

    /// A remark for the user: the reason for its rejection, or a contradiction, or disturbances.
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
