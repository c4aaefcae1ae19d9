//! Validity checks of scenarios.

use core::f64::consts::{FRAC_PI_2, TAU};

use rins_imu::{ImuNoiseError, TriadError};
use rins_terms::{Need, TermInstance};

use crate::scenario::{Encoder, Scenario, TableRecord};
use crate::temperature::Temperature;

/// The maximum number of samples of a run: 8 gigabytes, or 11 days at 100 Hz.
const MOST_SAMPLES: f64 = 1e8;

/// The reason why a scenario cannot be simulated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScenarioError {
    /// A quantity is infinite, NaN, or out of range.
    #[error("{quantity} is {value}; it must be {expected}")]
    Quantity {
        /// The quantity.
        quantity: &'static str,
        /// Its value, in SI units and radians.
        value: f64,
        /// The permitted range.
        expected: &'static str,
    },
    /// An effect's parameter is infinite or NaN.
    #[error("the effect {effect} has {value} as its {name}; it must be a finite number")]
    EffectParameter {
        /// The effect's id.
        effect: &'static str,
        /// The parameter.
        name: &'static str,
        /// Its value, in SI units.
        value: f64,
    },
    /// An effect's setting is out of range.
    #[error("the effect {effect} has {value} as its {name}; it must be from {low} to {high}")]
    EffectSetting {
        /// The effect's id.
        effect: &'static str,
        /// The setting.
        name: &'static str,
        /// Its value, in SI units.
        value: f64,
        /// The lower limit.
        low: f64,
        /// The upper limit.
        high: f64,
    },
    /// An effect is not defined in this run.
    #[error("the effect {effect} needs {what}, which this run does not have")]
    EffectNeeds {
        /// The effect's id.
        effect: &'static str,
        /// What the run lacks.
        what: &'static str,
    },
    /// The run contains no sample.
    #[error("a profile of {duration} s holds no whole interval of {interval} s")]
    TooShort {
        /// The profile's duration \[s\].
        duration: f64,
        /// The interval \[s\].
        interval: f64,
    },
    /// The run has too many samples.
    #[error("the run would hold {n_samples} samples; shorten it or lengthen the interval")]
    TooLong {
        /// The number of samples.
        n_samples: f64,
    },
    /// The table rotates by more than one turn within an interval.
    #[error(
        "at {time} s the table rotates at {rate} rad/s, more than one revolution per sample of {interval} s"
    )]
    TooFast {
        /// The time \[s\].
        time: f64,
        /// The rate \[rad/s\].
        rate: f64,
        /// The interval \[s\].
        interval: f64,
    },
    /// There is not enough memory for the run.
    #[error("not enough memory for the {n_samples} samples of the run")]
    OutOfMemory {
        /// The number of samples.
        n_samples: usize,
    },
    /// A noise model is invalid.
    #[error(transparent)]
    Noise(#[from] ImuNoiseError),
}

impl Scenario {
    /// Checks everything but the noise; returns the number of samples or one more.
    pub(crate) fn check(&self) -> Result<usize, ScenarioError> {
        self.check_place()?;
        self.check_sensors()?;
        self.effects.terms.iter().try_for_each(|chosen| self.check_effect(chosen))?;
        self.check_sampling()
    }

    fn check_place(&self) -> Result<(), ScenarioError> {
        let site = self.station.site;
        demand("latitude", site.latitude, "within ±π/2", |x| x.abs() <= FRAC_PI_2)?;
        finite("longitude", site.longitude)?;
        // From the deepest mine to above any aircraft: the normal gravity is a series in height.
        demand("height", site.height, "within ±100 km", |x| x.abs() <= 1e5)?;
        demand("gravity", self.station.gravity, "positive", |x| x > 0.0)?;
        let attitude = self.nav_from_table.matrix();
        attitude.iter().try_for_each(|&x| finite("an element of the axis attitude", x))
    }

    fn check_sensors(&self) -> Result<(), ScenarioError> {
        let all_finite = |quantity, error: &TriadError| {
            error.bias.iter().chain(&error.matrix).try_for_each(|&x| finite(quantity, x))
        };
        all_finite("a gyro error", &self.imu_error.gyro)?;
        all_finite("an accelerometer error", &self.imu_error.accel)?;
        self.temperature.iter().try_for_each(check_temperature)?;
        let TableRecord::Angle(Encoder { noise, resolution, zero }) = self.table else {
            return Ok(());
        };
        demand("encoder noise", noise, "at least zero", |x| x >= 0.0)?;
        demand("encoder resolution", resolution.unwrap_or(1.0), "positive", |x| x > 0.0)?;
        finite("encoder zero", zero)
    }

    fn check_effect(&self, chosen: &TermInstance) -> Result<(), ScenarioError> {
        let effect = chosen.term.id;
        for (parameter, &value) in chosen.term.parameters.iter().zip(&chosen.values) {
            if !value.is_finite() {
                return Err(ScenarioError::EffectParameter { effect, name: parameter.name, value });
            }
        }
        for (setting, &value) in chosen.term.settings.iter().zip(&chosen.settings) {
            let (low, high) = setting.within;
            if !(low..=high).contains(&value) {
                let name = setting.name;
                return Err(ScenarioError::EffectSetting { effect, name, value, low, high });
            }
        }
        let needs = |need| chosen.term.needs.contains(&need);
        if needs(Need::Temperature) && self.temperature.is_none() {
            return Err(ScenarioError::EffectNeeds { effect, what: "a temperature" });
        }
        if needs(Need::TableAngle) && !matches!(self.table, TableRecord::Angle(_)) {
            return Err(ScenarioError::EffectNeeds { effect, what: "a measured table angle" });
        }
        Ok(())
    }

    fn check_sampling(&self) -> Result<usize, ScenarioError> {
        let (interval, duration) = (self.interval, self.profile.duration());
        demand("interval", interval, "positive", |x| x > 0.0)?;
        let n_samples = (duration / interval).ceil();
        if n_samples > MOST_SAMPLES {
            return Err(ScenarioError::TooLong { n_samples });
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it lies between zero and the most samples"
        )]
        let n_samples = n_samples as usize;
        // Two checks per sample, because a rate may last less than an interval.
        for half in 0..=2 * n_samples {
            let time = 0.5 * interval * half as f64;
            let rate = self.profile.rate(time);
            if rate.abs() * interval > TAU {
                return Err(ScenarioError::TooFast { time, rate, interval });
            }
        }
        Ok(n_samples)
    }
}

fn check_temperature(temperature: &Temperature) -> Result<(), ScenarioError> {
    match *temperature {
        Temperature::Constant(value) => finite("temperature", value),
        Temperature::Ramp { start, rate } => {
            finite("temperature", start)?;
            finite("rate of temperature", rate)
        }
        Temperature::WarmUp { start, rise, time_constant } => {
            finite("temperature", start)?;
            finite("rise of temperature", rise)?;
            demand("time constant of temperature", time_constant, "positive", |x| x > 0.0)
        }
        Temperature::Sinus { start, amplitude, period } => {
            finite("temperature", start)?;
            finite("amplitude of temperature", amplitude)?;
            demand("period of temperature", period, "positive", |x| x > 0.0)
        }
    }
}

fn finite(quantity: &'static str, value: f64) -> Result<(), ScenarioError> {
    demand(quantity, value, "a finite number", |_| true)
}

fn demand(
    quantity: &'static str,
    value: f64,
    expected: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), ScenarioError> {
    if value.is_finite() && holds(value) {
        Ok(())
    } else {
        Err(ScenarioError::Quantity { quantity, value, expected })
    }
}
