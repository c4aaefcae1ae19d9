//! Mistakes that data point to.

use super::correction::Correction;

/// A mistake that the data point to, and the factor or sign by which they do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Suspicion {
    /// The specific force at rest is not gravity.
    Gravity {
        /// Its magnitude at rest \[m/s²\].
        seen: f64,
        /// What the station has \[m/s²\].
        expected: f64,
        /// The mistake that would explain it.
        cause: Option<String>,
    },
    /// The turn that the gyro counts is not the table's.
    SpinScale {
        /// The gyro's turn over the table's.
        ratio: f64,
        /// The mistake that would explain it.
        cause: Option<String>,
    },
    /// The accelerometers follow the table's turn and the gyros do not: their columns are exchanged.
    Triads {
        /// The closest that a gyro follows the table's rate, as a correlation.
        gyro: f64,
        /// The same of an accelerometer.
        accel: f64,
    },
    /// While the table turns the gyros show a vector that stands, which is gravity, and the
    /// accelerometers none: their columns are exchanged.
    TurningTriads {
        /// What of the gyros' readings stands across the table's axis, as a share.
        gyro: f64,
        /// The same of the accelerometers.
        accel: f64,
    },
    /// Another axis than z counts the table's turn.
    SpinAxis {
        /// The channel that follows the table.
        channel: &'static str,
        /// Its turn over the table's.
        ratio: f64,
    },
    /// The z gyro's turn leaves the table's, though both agree on the whole: the table moved
    /// otherwise, or at another time, than is said of it.
    SpinProfile {
        /// By how much the one gains on the other within ten seconds \[rad\].
        apart: f64,
        /// The end of those ten seconds \[s\].
        time: f64,
    },
    /// A channel repeats one value throughout: while another of its triad is noisy, or all three zero.
    StuckChannel {
        /// The channel.
        channel: &'static str,
    },
    /// A channel that goes on otherwise repeats one reading for longer than a driver's hiccup lasts.
    Sticks {
        /// The channel.
        channel: &'static str,
        /// In how many rows of samples.
        rows: usize,
        /// How many samples the longest of them has.
        count: usize,
        /// The time at which that begins \[s\].
        time: f64,
    },
    /// Single readings lie far outside of what comes before and after them.
    Spike {
        /// The channel.
        channel: &'static str,
        /// How many there are.
        count: usize,
        /// The time of the largest \[s\].
        time: f64,
        /// Its reading as a mean rate \[rad/s\] or specific force \[m/s²\].
        reading: f64,
    },
    /// Readings are at or beyond what the sensor can read.
    Saturated {
        /// The channel.
        channel: &'static str,
        /// How many there are.
        count: usize,
        /// The time of the first \[s\].
        time: f64,
        /// The sensor's range \[rad/s\] or \[m/s²\].
        range: f64,
    },
    /// The largest or least reading is repeated in a row where no other is: cut off.
    FlatTop {
        /// The channel.
        channel: &'static str,
        /// How many times in a row.
        count: usize,
        /// The time of the first \[s\].
        time: f64,
        /// The reading \[rad/s\] or \[m/s²\].
        reading: f64,
    },
    /// The specific force at rest does not point where the axis' attitude has it.
    Level {
        /// The angle between the two \[rad\].
        off: f64,
        /// How large it may be \[rad\].
        limit: f64,
        /// The single mistakes that would explain this and all else that is seen.
        corrections: Vec<Correction>,
    },
    /// The mean rate at rest is as large as the Earth's but does not point along it.
    EarthRate {
        /// The magnitude of the difference \[rad/s\].
        off: f64,
        /// How large it may be \[rad/s\].
        limit: f64,
        /// The single mistakes that would explain this and all else that is seen.
        corrections: Vec<Correction>,
    },
    /// The angle between the Earth's rate and gravity is that of another latitude.
    Latitude {
        /// What is seen \[rad\].
        seen: f64,
        /// The station's \[rad\].
        expected: f64,
        /// The single mistakes that would explain this and all else that is seen.
        corrections: Vec<Correction>,
    },
    /// Turning does not move the specific force in the body as it must, by `f' = -ω × f`.
    Handedness {
        /// The regression of the one on the other, which should be 1.
        ratio: f64,
        /// The correlation between the two, which should be near 1.
        correlation: f64,
        /// The single mistakes that would explain this and all else that is seen.
        corrections: Vec<Correction>,
    },
}

impl Suspicion {
    /// The single mistakes that would explain what is seen, the most likely ones; none if there is no such one.
    pub fn corrections(&self) -> &[Correction] {
        match self {
            Self::Level { corrections, .. }
            | Self::EarthRate { corrections, .. }
            | Self::Latitude { corrections, .. }
            | Self::Handedness { corrections, .. } => corrections,
            _ => &[],
        }
    }
}
