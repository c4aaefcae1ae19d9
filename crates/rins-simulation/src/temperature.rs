//! The temperature of an IMU during a run.

use std::f64::consts::TAU;

/// The temperature of a run, which is recorded with every sample, and on which effects depend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Temperature {
    /// A constant temperature \[°C\].
    Constant(f64),
    /// `start + rate t`.
    Ramp {
        /// The temperature at time zero \[°C\].
        start: f64,
        /// The rate of change \[K/s\].
        rate: f64,
    },
    /// `start + rise (1 - exp(-t/T))`: an exponential transient after turn-on, from the heat of the electronics.
    WarmUp {
        /// The temperature at time zero \[°C\].
        start: f64,
        /// The total rise \[K\].
        rise: f64,
        /// The time constant `T`, in which the remaining rise decreases by a factor e \[s\].
        time_constant: f64,
    },
    /// `start + amplitude sin(2π t/period)`: a room with periodic heating.
    Sinus {
        /// The temperature at time zero, and the mean \[°C\].
        start: f64,
        /// The amplitude \[K\].
        amplitude: f64,
        /// The period \[s\].
        period: f64,
    },
}

impl Temperature {
    /// The temperature at `time` \[°C\].
    ///
    /// ```
    /// use rins_simulation::Temperature;
    /// let warming = Temperature::WarmUp { start: 20.0, rise: 10.0, time_constant: 600.0 };
    /// assert_eq!(warming.at(0.0), 20.0);
    /// assert!((warming.at(6000.0) - 30.0).abs() < 1e-3);
    /// ```
    pub fn at(&self, time: f64) -> f64 {
        match *self {
            Self::Constant(value) => value,
            Self::Ramp { start, rate } => start + rate * time,
            Self::WarmUp { start, rise, time_constant } => {
                start - rise * libm::expm1(-time / time_constant)
            }
            Self::Sinus { start, amplitude, period } => {
                start + amplitude * libm::sin(TAU * time / period)
            }
        }
    }
}
