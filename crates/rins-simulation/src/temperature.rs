//! How the temperature of an IMU goes over a run.

use std::f64::consts::TAU;

/// The temperature of a run, which is recorded with every sample, and on which effects depend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Temperature {
    /// The same all the time \[°C\].
    Constant(f64),
    /// `start + rate t`.
    Ramp {
        /// At time zero \[°C\].
        start: f64,
        /// How fast it rises \[K/s\].
        rate: f64,
    },
    /// `start + rise (1 - exp(-t/T))`: an IMU that takes up the heat of its own electronics.
    WarmUp {
        /// At time zero \[°C\].
        start: f64,
        /// How far it rises in the end \[K\].
        rise: f64,
        /// `T`, the time in which what is left to rise falls by e \[s\].
        time_constant: f64,
    },
    /// `start + amplitude sin(2π t/period)`: a room that is heated on and off.
    Sinus {
        /// At time zero, and the mean \[°C\].
        start: f64,
        /// How far it leaves the mean \[K\].
        amplitude: f64,
        /// How long it takes to come back \[s\].
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
