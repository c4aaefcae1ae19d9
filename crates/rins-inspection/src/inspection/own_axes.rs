//! The inspection of a run with any spin axis, under the names of the sensors' own axes.

use rins_frames::SignedAxes;

use super::{CHANNELS, Correction, Inspection, Suspicion};

/// The channel along the sensors' own axes that `channel` of a run with these axes contains.
fn own_place(channel: usize, axes: &SignedAxes) -> usize {
    3 * (channel / 3) + axes.source[channel % 3]
}

/// The same by name; other names do not change.
fn own_name(name: &'static str, axes: &SignedAxes) -> &'static str {
    let channel = CHANNELS.iter().position(|channel| *channel == name);
    channel.map_or(name, |channel| CHANNELS[own_place(channel, axes)])
}

impl Inspection {
    /// The same along the sensors' own axes, if it is that of a run with these axes, whose z is the spin axis.
    ///
    /// Rotations and the data that are compared with them stay those of the spin axis, and so do the means over the static
    /// intervals.
    #[must_use]
    pub fn along_own(&self, axes: &SignedAxes) -> Self {
        let mut own = self.clone();
        for channel in 0..CHANNELS.len() {
            let there = own_place(channel, axes);
            own.resolution[there] = self.resolution[channel];
            own.longest_repeat[there] = self.longest_repeat[channel];
        }
        for suspicion in &mut own.suspicions {
            suspicion.turn_to_own(axes);
        }
        own
    }
}

impl Suspicion {
    fn turn_to_own(&mut self, axes: &SignedAxes) {
        match self {
            Self::SpinAxis { channel, .. }
            | Self::StuckChannel { channel }
            | Self::Sticks { channel, .. }
            | Self::Saturated { channel, .. } => *channel = own_name(channel, axes),
            Self::Spike { channel, reading, .. } | Self::FlatTop { channel, reading, .. } => {
                let place = CHANNELS.iter().position(|name| name == channel).unwrap_or_default();
                *reading *= axes.sign[place % 3];
                *channel = own_name(channel, axes);
            }
            Self::Level { corrections, .. }
            | Self::EarthRate { corrections, .. }
            | Self::Latitude { corrections, .. }
            | Self::Handedness { corrections, .. } => {
                for correction in corrections {
                    correction.turn_to_own(axes);
                }
            }
            Self::Gravity { .. }
            | Self::SpinScale { .. }
            | Self::Triads { .. }
            | Self::TurningTriads { .. }
            | Self::SpinProfile { .. } => {}
        }
    }
}

impl Correction {
    fn turn_to_own(&mut self, axes: &SignedAxes) {
        match self {
            Self::Gyro(corrected)
            | Self::Accel(corrected)
            | Self::Imu(corrected)
            | Self::GyroAndTableSense(corrected) => {
                *corrected = axes.inverse().after(&corrected.after(axes));
            }
            Self::RollAndPitch
            | Self::RollSign
            | Self::PitchSign
            | Self::YawSign
            | Self::LatitudeSign
            | Self::TableSense => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    /// Gyro x of the sensor is along the spin axis, and thus gyro z of the run.
    const ABOUT_X: SignedAxes = SignedAxes { source: [1, 2, 0], sign: [1.0, -1.0, -1.0] };

    #[test]
    fn channels_have_the_sensors_own_names() {
        let mut spike = Suspicion::Spike { channel: "gyro.z", count: 1, time: 1.0, reading: 2.0 };
        spike.turn_to_own(&ABOUT_X);
        let own = Suspicion::Spike { channel: "gyro.x", count: 1, time: 1.0, reading: -2.0 };
        assert_eq!(spike, own);
        let mut stuck = Suspicion::StuckChannel { channel: "accel.y" };
        stuck.turn_to_own(&ABOUT_X);
        assert_eq!(stuck, Suspicion::StuckChannel { channel: "accel.z" });
    }

    /// Corrected along the sensors' own axes and then transformed, or transformed and then corrected: the readings are equal.
    #[test]
    fn a_correction_is_the_same_along_any_axes() {
        let reading = Vector3::new(1.0, 2.0, 3.0);
        for axes in SignedAxes::all() {
            let mut own = Correction::Imu(axes);
            own.turn_to_own(&ABOUT_X);
            let Correction::Imu(own) = own else { unreachable!() };
            let first = ABOUT_X.apply(&own.apply(&reading));
            assert_eq!(first, axes.apply(&ABOUT_X.apply(&reading)));
            assert_eq!(ABOUT_X.undo(&ABOUT_X.apply(&reading)), reading);
        }
    }
}
