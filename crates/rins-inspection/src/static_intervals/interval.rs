//! A span that is a static interval, or why it is none.

use std::fmt;
use std::ops::Range;

use rins_frames::units::{DEG, DEG_PER_SECOND};

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
