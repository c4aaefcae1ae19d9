//! The data sheet of a log whose rig file states none: that of a grade.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::{DEG_PER_HOUR, MILLI_G};
use rins_frames::{EARTH_RATE, Increments};
use rins_imu::{GRADES, ImuSpec, Preset};
use rins_io::Loaded;
use rins_motion::Recording;
use rins_report::number::figure;

use super::statics::longest;

/// The shortest static interval from which a grade is assumed \[s\].
const SHORTEST: f64 = 1.0;

/// What a grade leaves to the readings at rest: biases, and errors of the magnitude of gravity, of up to this many of its sigmas.
const LARGEST: f64 = 2.0;

/// How much more noise than that of its grade an IMU may have, since a table and a building vibrate.
const NOISIER: f64 = 2.0;

/// The last grade that is assumed, in [`GRADES`]: a narrower one would have to be stated.
const NARROWEST: &str = "fog";

/// The data sheet of a log, and what was assumed of it.
pub(crate) struct DataSheet {
    pub(crate) imu: ImuSpec,
    /// The assumption in a sentence.
    pub(crate) assumption: Option<String>,
}

impl DataSheet {
    /// The data sheet that the rig file states, or that of the narrowest grade which the readings at rest do not contradict.
    ///
    /// # Errors
    /// If none is stated and the log has no static interval.
    pub(crate) fn of(loaded: &Loaded) -> anyhow::Result<Self> {
        if loaded.rig.imu.is_none()
            && let Some(rest) = longest(loaded, SHORTEST)
        {
            let seen = AtRest::of(&loaded.recording, rest);
            let preset = seen.grade(loaded.station.gravity);
            return Ok(Self { imu: preset.imu, assumption: Some(seen.in_words(preset)) });
        }
        let assumption = loaded.rig.preset.map(|preset| {
            format!(
                "Values of the data sheet that the rig file does not state are those of {}: {}.",
                preset.name, preset.source
            )
        });
        Ok(Self { imu: *loaded.rig.require_imu()?, assumption })
    }
}

/// What the sensors read over a static interval.
struct AtRest {
    /// The density of the gyros' noise \[rad/s/√Hz\].
    noise: f64,
    /// The magnitude of the mean angular rate \[rad/s\] and of the mean specific force \[m/s²\].
    rate: f64,
    force: f64,
}

impl AtRest {
    fn of(recording: &Recording, rest: Range<usize>) -> Self {
        let samples = &recording.increments[rest];
        let lasting: f64 = samples.iter().map(|sample| sample.interval).sum();
        let mean = |of: fn(&Increments) -> Vector3<f64>| {
            samples.iter().map(of).sum::<Vector3<f64>>() / lasting
        };
        let rate_of = |sample: &Increments| sample.angle.components() / sample.interval;
        // A difference of neighbors has twice the variance, and nothing of a slow drift.
        let difference =
            |pair: &[Increments]| (rate_of(&pair[1]) - rate_of(&pair[0])).norm_squared();
        let differences: f64 = samples.windows(2).map(difference).sum();
        let count = samples.len().max(2) as f64;
        Self {
            noise: (differences / (6.0 * (count - 1.0)) * lasting / count).sqrt(),
            rate: mean(|sample| *sample.angle.components()).norm(),
            force: mean(|sample| *sample.velocity.components()).norm(),
        }
    }

    /// The narrowest grade that these readings do not contradict, or the widest.
    fn grade(&self, gravity: f64) -> &'static Preset {
        let allows = |preset: &&Preset| {
            let ImuSpec { gyro, accel } = preset.imu;
            self.noise <= NOISIER * gyro.noise_density
                && self.rate <= EARTH_RATE + LARGEST * gyro.bias_sigma
                && (self.force - gravity).abs()
                    <= LARGEST * accel.bias_sigma.hypot(accel.scale_sigma * gravity)
        };
        let assumed = GRADES.iter().position(|grade| grade.name == NARROWEST).unwrap_or_default();
        GRADES[..=assumed].iter().rev().find(allows).unwrap_or(&GRADES[0])
    }

    fn in_words(&self, preset: &Preset) -> String {
        let ImuSpec { gyro, accel } = preset.imu;
        format!(
            "The rig file states no data sheet. At rest the gyros have a noise of {} deg/h/√Hz and read {} deg/h: the grade {} is \
             assumed, with biases of ± {} deg/h and ± {} mg (1σ). State [imu] grade, sensor, or the values of a data sheet.",
            figure(self.noise / DEG_PER_HOUR, 2),
            figure(self.rate / DEG_PER_HOUR, 2),
            preset.name,
            figure(gyro.bias_sigma / DEG_PER_HOUR, 2),
            figure(accel.bias_sigma / MILLI_G, 2)
        )
    }
}
