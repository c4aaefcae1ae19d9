//! A table, an IMU and a schedule as a laboratory might have them.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_distr::{Distribution, StandardNormal};
use rins_blind::{
    Drive, Effect, Encoder, Experiment, Known, Noise, Place, Random, Ripple, Rounding, Segment,
    Sensors, SensorsKnown, Temperature,
};
use rins_terms::{Term, catalogue};
use serde::{Deserialize, Serialize};

const DEGREE: f64 = PI / 180.0;
const ARCSECOND: f64 = DEGREE / 3600.0;
const DEGREE_PER_HOUR: f64 = DEGREE / 3600.0;
const MICRO_G: f64 = 9.80665e-6;

/// How the table turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Schedule {
    /// At one rate, which it has when the log begins.
    Constant,
    /// At one rate, both ways.
    Reversal,
    /// At three rates, both ways each.
    ThreeRates,
}

/// How real the world is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// White noise only.
    White,
    /// And flicker: 0.005 deg/h of the gyros, 2 µg of the accelerometers.
    Flicker,
    /// And a table that wobbles, with an encoder that has harmonics.
    Table,
    /// And least bits, and an encoder that is read at slightly wrong times.
    Coarse,
}

/// The grade of an IMU: its noise and its constant errors are so many times those of a navigation-grade one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Grade {
    /// Gyro noise of 0.005 to 0.05 deg/h/√Hz.
    #[default]
    Navigation,
    /// 30 times the gyro noise, 3 times that of the accelerometers.
    Tactical,
    /// 1000 times the gyro noise, 10 times that of the accelerometers.
    Industrial,
}

impl Grade {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Navigation, Self::Tactical, Self::Industrial];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Navigation => "navigation",
            Self::Tactical => "tactical",
            Self::Industrial => "industrial",
        }
    }

    /// The factors of the errors of gyros and accelerometers.
    const fn factors(self) -> (f64, f64) {
        match self {
            Self::Navigation => (1.0, 1.0),
            Self::Tactical => (30.0, 3.0),
            Self::Industrial => (1000.0, 10.0),
        }
    }
}

impl Schedule {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Constant, Self::Reversal, Self::ThreeRates];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Reversal => "reversal",
            Self::ThreeRates => "three rates",
        }
    }
}

/// The flicker of both triads.
static FLICKER: [&Term; 2] =
    [&catalogue::GYRO_BIAS_INSTABILITY, &catalogue::ACCEL_BIAS_INSTABILITY];

/// The bias instability and the LSB of both triads, and jitter.
static COARSE: [&Term; 5] = [
    &catalogue::GYRO_BIAS_INSTABILITY,
    &catalogue::ACCEL_BIAS_INSTABILITY,
    &catalogue::GYRO_QUANTISATION,
    &catalogue::ACCEL_QUANTISATION,
    &catalogue::TIMESTAMP_JITTER,
];

impl Level {
    /// What the data sheet does not say of the noise.
    pub(crate) const fn scatter(self) -> &'static [&'static Term] {
        match self {
            Self::White => &[],
            Self::Flicker | Self::Table => &FLICKER,
            Self::Coarse => &COARSE,
        }
    }

    /// All of them.
    pub const ALL: [Self; 4] = [Self::White, Self::Flicker, Self::Table, Self::Coarse];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::White => "white noise",
            Self::Flicker => "and bias instability",
            Self::Table => "and an imperfect table",
            Self::Coarse => "and quantization, jitter",
        }
    }
}

/// How long a run is, and how often a second it is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// As it is drawn: 360 to 540 s, mostly at 50 Hz, or at 100 Hz.
    Drawn,
    /// 720 s at 100 Hz.
    Longest,
    /// 240 s at 50 Hz.
    Short,
}

/// A laboratory: what is true there before anything is hidden, and what it knows.
#[derive(Clone, Debug)]
pub struct Laboratory {
    /// What is true.
    pub experiment: Experiment,
    /// What is known.
    pub known: Known,
}

fn normal(random: &mut Random) -> f64 {
    StandardNormal.sample(random)
}

/// A number between `low` and `high`, every factor as likely as another.
pub(crate) fn log_uniform(random: &mut Random, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.random::<f64>())
}

fn uniform(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * random.random::<f64>()
}

impl Laboratory {
    /// One that is drawn at random.
    pub fn draw(
        (schedule, length): (Schedule, Length),
        (level, grade): (Level, Grade),
        seed: u64,
        random: &mut Random,
    ) -> Self {
        let place = Place::at(uniform(random, -60.0, 60.0) * DEGREE);
        let tilt = uniform(random, 15.0, 35.0) * DEGREE;
        let toward = uniform(random, -PI, PI);
        let attitude = [tilt * toward.cos(), tilt * toward.sin(), uniform(random, -PI, PI)];
        let (of_gyro, of_accel) = grade.factors();
        let gyro = SensorsKnown {
            noise: log_uniform(random, 0.005, 0.05) * of_gyro * DEGREE_PER_HOUR,
            bias: log_uniform(random, 0.02, 1.0) * of_gyro * DEGREE_PER_HOUR,
            scale: log_uniform(random, 10e-6, 1000e-6),
            misalignment: log_uniform(random, 10.0, 400.0) * ARCSECOND,
        };
        let accel = SensorsKnown {
            noise: log_uniform(random, 10.0, 60.0) * of_accel * MICRO_G,
            bias: log_uniform(random, 20.0, 1000.0) * of_accel * MICRO_G,
            scale: log_uniform(random, 30e-6, 1000e-6),
            misalignment: log_uniform(random, 10.0, 400.0) * ARCSECOND,
        };
        let encoder = log_uniform(random, 0.2, 1.0) * ARCSECOND;
        let known = Known {
            place,
            attitude: attitude.map(|angle| angle + 0.03 * DEGREE * normal(random)),
            attitude_sigma: 0.1 * DEGREE,
            gyro,
            accel,
            encoder_noise: encoder,
            // Half of the makers of air bearings say how well they run.
            wobble: random.random_bool(0.5).then_some(5e-9),
        };
        let smallest = gyro.misalignment.min(accel.misalignment);
        let seldom = random.random_bool(0.2) && length == Length::Drawn;
        let experiment = Experiment {
            place,
            base_rate: 0.0,
            attitude,
            drive: drive(schedule, length, random),
            mounting: [0.3 * smallest * normal(random), 0.3 * smallest * normal(random)],
            gyro: sensors(&gyro, level, 0.005 * of_gyro * DEGREE_PER_HOUR, random),
            accel: sensors(&accel, level, 2.0 * of_accel * MICRO_G, random),
            encoder: Encoder { noise: encoder, resolution: 0.0 },
            temperature: temperature(random),
            interval: if length == Length::Longest || seldom { 0.01 } else { 0.02 },
            substeps: 20,
            effects: Vec::new(),
            unknowns: Vec::new(),
            seed,
        };
        let mut laboratory = Self { experiment, known };
        if matches!(level, Level::Table | Level::Coarse) {
            laboratory.wear(random);
        }
        if level == Level::Coarse {
            laboratory.coarsen(random);
        }
        laboratory
    }

    /// A bearing that wobbles and an encoder that is off centre.
    fn wear(&mut self, random: &mut Random) {
        let mut effect = |term: &Term, settings: &[f64], low: f64, high: f64| {
            let (size, phase) = (log_uniform(random, low, high), uniform(random, -PI, PI));
            let parameters = [size * phase.cos() * ARCSECOND, size * phase.sin() * ARCSECOND];
            self.experiment.effects.push(Effect::new(term.id, &parameters, settings));
            size * ARCSECOND
        };
        let wobble = effect(&catalogue::TABLE_WOBBLE, &[2.0], 0.02, 0.5);
        effect(&catalogue::ENCODER_ECCENTRICITY, &[], 0.1, 5.0);
        effect(&catalogue::ENCODER_HARMONIC, &[2.0], 0.02, 1.0);
        self.known.wobble = Some(wobble);
    }

    /// Least bits of all sensors, and some microseconds of jitter.
    fn coarsen(&mut self, random: &mut Random) {
        let interval = self.experiment.interval;
        let bit = |noise: f64| Some(Rounding::Increment(0.5 * noise * interval.sqrt()));
        self.experiment.gyro.rounding = bit(self.known.gyro.noise);
        self.experiment.accel.rounding = bit(self.known.accel.noise);
        self.experiment.encoder.resolution = 0.05 * ARCSECOND;
        let jitter = log_uniform(random, 0.1e-6, 1e-6);
        self.experiment.effects.push(Effect::new(catalogue::TIMESTAMP_JITTER.id, &[jitter], &[]));
    }
}

fn drive(schedule: Schedule, length: Length, random: &mut Random) -> Drive {
    let rate = uniform(random, 6.0, 15.0) * DEGREE;
    let drawn = uniform(random, 360.0, 540.0).round();
    let duration = match length {
        Length::Drawn => drawn,
        Length::Longest => 720.0,
        Length::Short => 240.0,
    };
    let mut rates = match schedule {
        Schedule::Constant => vec![rate],
        Schedule::Reversal => vec![rate, -rate],
        Schedule::ThreeRates => {
            vec![rate, -rate, 2.0 * rate, -2.0 * rate, 0.5 * rate, -0.5 * rate]
        }
    };
    rates.shuffle(random);
    let each = (duration / rates.len() as f64).round();
    let mut ripple =
        |order: f64| Ripple { order, cos: 2e-4 * normal(random), sin: 2e-4 * normal(random) };
    let ripples = vec![ripple(12.0), ripple(36.0)];
    Drive {
        segments: rates.into_iter().map(|rate| Segment { rate, duration: each }).collect(),
        acceleration: uniform(random, 3.0, 20.0) * DEGREE,
        rolling: schedule == Schedule::Constant,
        lag: uniform(random, 0.02, 0.1),
        shake: log_uniform(random, 1e-6, 1e-4),
        ripples,
    }
}

/// Three sensors that are as good as their data sheet says, one with another.
fn sensors(known: &SensorsKnown, level: Level, flicker: f64, random: &mut Random) -> Sensors {
    let bias = Vector3::from_fn(|_, _| known.bias * normal(random));
    let matrix = Matrix3::from_fn(|row, column| {
        let size = if row == column { known.scale } else { 0.8 * known.misalignment };
        size * normal(random)
    });
    let flicker = if level == Level::White { 0.0 } else { flicker };
    let noise = Noise { white: known.noise, flicker, walk: 0.0 };
    Sensors { bias, matrix, noise, rounding: None }
}

fn temperature(random: &mut Random) -> Temperature {
    Temperature {
        start: uniform(random, 15.0, 30.0),
        rise: uniform(random, 0.5, 4.0),
        settling: log_uniform(random, 60.0, 600.0),
        swing: uniform(random, 0.1, 1.0),
        period: log_uniform(random, 100.0, 400.0),
    }
}
