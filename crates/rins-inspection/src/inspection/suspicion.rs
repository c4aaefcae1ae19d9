//! Probable gross errors in the data.

use super::correction::Correction;

/// A probable gross error in the data, with the factor or sign that indicates it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Suspicion {
    /// The static specific force differs from gravity.
    Gravity {
        /// Its static magnitude \[m/s²\].
        seen: f64,
        /// The gravity of the station \[m/s²\].
        expected: f64,
        /// The error that would explain it.
        cause: Option<String>,
    },
    /// The angle of rotation of the gyro differs from that of the table.
    SpinScale {
        /// The ratio of the gyro's to the table's angle of rotation.
        ratio: f64,
        /// The error that would explain it.
        cause: Option<String>,
    },
    /// The accelerometers follow the table's rotation and the gyros do not: their columns are exchanged.
    Triads {
        /// The largest correlation of a gyro with the table rate.
        gyro: f64,
        /// The same for an accelerometer.
        accel: f64,
    },
    /// During a rotation the gyros measure a vector that is fixed to the table, which is gravity, and the accelerometers do
    /// not: their columns are exchanged.
    TurningTriads {
        /// The fraction of the gyros' readings that is fixed perpendicular to the table's axis.
        gyro: f64,
        /// The same for the accelerometers.
        accel: f64,
    },
    /// Another axis than z measures the table's rotation.
    SpinAxis {
        /// The channel that follows the table.
        channel: &'static str,
        /// The ratio of its angle of rotation to the table's.
        ratio: f64,
    },
    /// The angle of the z gyro departs from the table's, although both agree on average: the table moved differently, or at
    /// another time, than stated.
    SpinProfile {
        /// The change of the difference of the angles within ten seconds \[rad\].
        apart: f64,
        /// The end of those ten seconds \[s\].
        time: f64,
    },
    /// A channel repeats one value throughout, while another of its triad is noisy, or all three are zero.
    StuckChannel {
        /// The channel.
        channel: &'static str,
    },
    /// A channel that otherwise changes repeats one reading for longer than a delay of a driver.
    Sticks {
        /// The channel.
        channel: &'static str,
        /// The number of spans of samples.
        rows: usize,
        /// The number of samples in the longest span.
        count: usize,
        /// The start of the longest span \[s\].
        time: f64,
    },
    /// Single readings far outside of the previous and the next ones.
    Spike {
        /// The channel.
        channel: &'static str,
        /// The number of spikes.
        count: usize,
        /// The time of the largest \[s\].
        time: f64,
        /// Its reading as a mean rate \[rad/s\] or specific force \[m/s²\].
        reading: f64,
    },
    /// Readings at or beyond the range of the sensor.
    Saturated {
        /// The channel.
        channel: &'static str,
        /// The number of such readings.
        count: usize,
        /// The time of the first one \[s\].
        time: f64,
        /// The sensor's range \[rad/s\] or \[m/s²\].
        range: f64,
    },
    /// The largest or smallest reading is repeated as no other is: the readings are clipped.
    FlatTop {
        /// The channel.
        channel: &'static str,
        /// The number of repetitions in succession.
        count: usize,
        /// The time of the first one \[s\].
        time: f64,
        /// The reading \[rad/s\] or \[m/s²\].
        reading: f64,
    },
    /// The direction of the static specific force differs from the vertical of the axis' attitude.
    Level {
        /// The angle between the two \[rad\].
        off: f64,
        /// The limit of the angle \[rad\].
        limit: f64,
        /// The single errors that would explain this and all other deviations.
        corrections: Vec<Correction>,
    },
    /// The static mean rate has the magnitude of the Earth's rate but another direction.
    EarthRate {
        /// The magnitude of the difference \[rad/s\].
        off: f64,
        /// The limit of the difference \[rad/s\].
        limit: f64,
        /// The single errors that would explain this and all other deviations.
        corrections: Vec<Correction>,
    },
    /// The angle between the Earth's rate and gravity is that of another latitude.
    Latitude {
        /// The measured latitude \[rad\].
        seen: f64,
        /// The station's \[rad\].
        expected: f64,
        /// The single errors that would explain this and all other deviations.
        corrections: Vec<Correction>,
    },
    /// A rotation does not change the specific force in the body by `f' = -ω × f`.
    Handedness {
        /// The regression of the one on the other, which should be 1.
        ratio: f64,
        /// The correlation between the two, which should be near 1.
        correlation: f64,
        /// The single errors that would explain this and all other deviations.
        corrections: Vec<Correction>,
    },
}

impl Suspicion {
    /// The single errors that would explain the data, the most probable ones; empty if there is none.
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
