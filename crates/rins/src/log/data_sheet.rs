//! The data sheet of a log whose rig file states none: that of a grade.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::{DEG_PER_HOUR, MILLI_G};
use rins_frames::{EARTH_RATE, Increments};
use rins_imu::{GRADES, ImuSpec, Preset};
use rins_io::Loaded;
use rins_motion::{Recording, median, whole};
use rins_report::number::figure;

use super::statics::longest;

/// The shortest static interval from which a grade is assumed \[s\].
const SHORTEST: f64 = 1.0;

/// What a grade leaves to the readings at rest: biases, and errors of the magnitude of gravity, of up to this many of its sigmas.
const LARGEST: f64 = 2.0;

/// How much more noise than that of its grade an IMU may have, since a table and a building vibrate.
const NOISIER: f64 = 2.0;

/// The averaging times of which the one with the smallest noise density counts \[s\].
const AVERAGED: [f64; 3] = [0.0, 0.1, 1.0];

/// The smallest number of averages.
const FEWEST: usize = 10;

/// The median of chi-square with three degrees of freedom.
const MEDIAN_OF_THREE: f64 = 2.366;

/// The request to replace an assumption.
const STATE: &str = "State [imu] grade, sensor, or the values of a data sheet.";

/// The last grade that is assumed, in [`GRADES`]: a narrower one would have to be stated.
const NARROWEST: &str = "fog";

/// The data sheet of a log, and what was assumed of it.
pub(crate) struct DataSheet {
    pub(crate) imu: ImuSpec,
    /// The assumption in a sentence.
    pub(crate) assumption: Option<String>,
}

impl DataSheet {
    /// The data sheet that the rig file states, or that of the narrowest grade which the readings at rest do not contradict; the
    /// widest without a static interval.
    pub(crate) fn of(loaded: &Loaded) -> Self {
        if let Some(imu) = loaded.rig.imu {
            let assumption = loaded.rig.preset.map(|preset| {
                format!(
                    "Values of the data sheet that the rig file does not state are those of {}: {}.",
                    preset.name, preset.source
                )
            });
            return Self { imu, assumption };
        }
        let Some(rest) = longest(loaded, SHORTEST) else {
            let widest = &GRADES[0];
            let assumption = format!(
                "The rig file states no data sheet, and the log has no static interval: the grade {} is assumed. {STATE}",
                widest.name
            );
            return Self { imu: widest.imu, assumption: Some(assumption) };
        };
        let seen = AtRest::of(&loaded.recording, rest);
        let preset = seen.grade(loaded.station.gravity);
        Self { imu: preset.imu, assumption: Some(seen.in_words(preset)) }
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

/// The density of the gyros' noise by the median difference of successive averages over `block` samples \[rad/s/√Hz\], which a
/// few disturbances do not change.
fn density(samples: &[Increments], block: usize) -> Option<f64> {
    let means: Vec<(Vector3<f64>, f64)> = samples
        .chunks_exact(block)
        .map(|block| {
            let lasting: f64 = block.iter().map(|sample| sample.interval).sum();
            let turned: Vector3<f64> = block.iter().map(|sample| sample.angle.components()).sum();
            (turned / lasting, lasting)
        })
        .collect();
    if means.len() < FEWEST {
        return None;
    }
    // A difference of neighbors has twice the variance, and nothing of a slow drift.
    let square = |pair: &[(Vector3<f64>, f64)]| {
        (pair[1].0 - pair[0].0).norm_squared() * 0.5 * (pair[0].1 + pair[1].1)
    };
    let middle = median(means.windows(2).map(square))?;
    Some((middle / (2.0 * MEDIAN_OF_THREE)).sqrt())
}

impl AtRest {
    fn of(recording: &Recording, rest: Range<usize>) -> Self {
        let samples = &recording.increments[rest];
        let lasting: f64 = samples.iter().map(|sample| sample.interval).sum();
        let mean = |of: fn(&Increments) -> Vector3<f64>| {
            samples.iter().map(of).sum::<Vector3<f64>>() / lasting
        };
        let interval = lasting / samples.len() as f64;
        let noise = |averaged: &f64| density(samples, whole(averaged / interval).max(1));
        // Rounding and the dither of laser gyros add to the short averages, motion of the base to the long ones.
        let least = AVERAGED.iter().filter_map(noise).reduce(f64::min);
        Self {
            noise: least.unwrap_or_default(),
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
             assumed, with biases of ± {} deg/h and ± {} mg (1σ). {STATE}",
            figure(self.noise / DEG_PER_HOUR, 2),
            figure(self.rate / DEG_PER_HOUR, 2),
            preset.name,
            figure(gyro.bias_sigma / DEG_PER_HOUR, 2),
            figure(accel.bias_sigma / MILLI_G, 2)
        )
    }
}
