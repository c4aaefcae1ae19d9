//! The sway of a carrier: sinusoids of roll, pitch, yaw and heave.

use core::f64::consts::TAU;

use nalgebra::ComplexField;

use super::course::CarrierError;

/// A sinusoid `a sin(2π t/T + φ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// The amplitude `a` \[rad or m\].
    pub amplitude: f64,
    /// The period `T` \[s\].
    pub period: f64,
    /// The phase `φ` at the start \[rad\].
    pub phase: f64,
}

/// Oscillations about the course. The default is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sway {
    /// Roll, about the forward axis \[rad\].
    pub roll: Option<Oscillation>,
    /// Pitch, about the axis to the right \[rad\].
    pub pitch: Option<Oscillation>,
    /// Yaw, counter-clockwise from above \[rad\].
    pub yaw: Option<Oscillation>,
    /// Heave, upwards \[m\].
    pub heave: Option<Oscillation>,
}

impl Oscillation {
    /// The value at `time` and its first two derivatives.
    pub(super) fn at(&self, time: f64) -> [f64; 3] {
        let rate = TAU / self.period;
        let (sin, cos) = ComplexField::sin_cos(rate * time + self.phase);
        let amplitude = self.amplitude;
        [amplitude * sin, amplitude * rate * cos, -amplitude * rate * rate * sin]
    }
}

impl Sway {
    fn each(&self) -> impl Iterator<Item = &Oscillation> {
        [&self.roll, &self.pitch, &self.yaw, &self.heave].into_iter().flatten()
    }

    pub(super) fn shortest_period(&self) -> Option<f64> {
        self.each().map(|one| one.period).reduce(f64::min)
    }

    pub(super) fn check(&self) -> Result<(), CarrierError> {
        for one in self.each() {
            let numbers = [one.amplitude, one.phase, one.period];
            if !(numbers.iter().copied().all(f64::is_finite) && one.period > 0.0) {
                return Err(CarrierError::Sway { amplitude: one.amplitude, period: one.period });
            }
        }
        Ok(())
    }
}
