//! IMU readings from the true motion: errors on every short step, means and noise on every sample.

use nalgebra::{Complex, Matrix3, Vector3};

use crate::drive::Way;
use crate::effect::{Effect, Law, Read};
use crate::experiment::{Experiment, Rounding, Sensors};
use crate::laws::Instant;
use crate::motion::{Attitudes, Motion};
use crate::noise::Scatter;
use crate::random::random;
use crate::run::Grid;
use crate::unknown::Channel;

/// The integrals of the sensors' readings from the start of the grid to each of its points \[rad, m/s\].
pub(crate) struct Sums {
    gyro: Vec<Vector3<f64>>,
    accel: Vec<Vector3<f64>>,
}

/// The time before the run over which a lagging temperature variation is simulated, in time constants.
const SETTLED: f64 = 12.0;

/// The gyros' response to heat from one side: `exp(iζ)` after a low-pass filter.
struct Warmth<'a> {
    effect: &'a Effect,
    followed: Complex<f64>,
    gain: f64,
}

impl<'a> Warmth<'a> {
    fn new(effect: &'a Effect, way: &Way, step: f64) -> Self {
        let time = effect.settings[0];
        let gain = 1.0 - (-step / time).exp();
        let turn = way.angles[1] - way.angles[0];
        let before = (SETTLED * time / step).ceil();
        let mut warmth = Self { effect, followed: Complex::new(0.0, 0.0), gain };
        let mut angle = way.angles[0] - turn * before;
        warmth.followed = Complex::from_polar(1.0, angle);
        while (way.angles[0] - angle) * turn > 0.0 {
            warmth.follow(angle);
            angle += turn;
        }
        warmth
    }

    fn follow(&mut self, angle: f64) {
        self.followed += (Complex::from_polar(1.0, angle) - self.followed) * self.gain;
    }

    fn error(&self) -> Vector3<f64> {
        let p = &self.effect.parameters;
        let of = |axis: usize| p[2 * axis] * self.followed.re + p[2 * axis + 1] * self.followed.im;
        Vector3::new(of(0), of(1), of(2))
    }
}

/// A sensor that follows its thermometer with a time constant.
struct Soak<'a> {
    effect: &'a Effect,
    law: fn(&[f64], f64) -> Read,
    temperature: f64,
    gain: f64,
}

/// The sensors of an experiment that do so, at the temperature of the start.
fn soaks<'a>(experiment: &'a Experiment, start: f64, step: f64) -> Vec<Soak<'a>> {
    let of = |effect: &'a Effect| match effect.law() {
        Law::Soak(law) => {
            let gain = 1.0 - (-step / effect.settings[0]).exp();
            Some(Soak { effect, law, temperature: start, gain })
        }
        _ => None,
    };
    experiment.effects.iter().filter_map(of).collect()
}

impl Soak<'_> {
    /// The errors half a step after the sensor began to follow `temperature`, its mean over the step.
    fn follow(&mut self, temperature: f64) -> Read {
        let before = self.temperature;
        self.temperature += (temperature - before) * self.gain;
        (self.law)(&self.effect.parameters, 0.5 * (before + self.temperature) - temperature)
    }
}

/// Integrates the sensors' readings over the short steps of a trajectory.
pub(crate) fn sums(
    experiment: &Experiment,
    grid: &Grid,
    way: &Way,
    motion: &Motion<'_>,
    attitudes: &Attitudes,
) -> Sums {
    let mut warmths: Vec<Warmth<'_>> = experiment
        .effects
        .iter()
        .filter(|effect| matches!(effect.law(), Law::Heat))
        .map(|effect| Warmth::new(effect, way, grid.step))
        .collect();
    let senses: Vec<_> = experiment
        .effects
        .iter()
        .filter_map(|effect| match effect.law() {
            Law::Sense(law) => Some((effect, law)),
            _ => None,
        })
        .collect();
    let field = experiment.place.magnetic_field();
    let warm = |time: f64| experiment.temperature.at(time);
    let start = warm(0.0);
    let mut soaks = soaks(experiment, start, grid.step);
    let axes = experiment.gyro.axes();
    // The first and the last point have only one neighbor.
    let points = way.angles.len() - 2;
    let zero = Vector3::zeros();
    let mut sums = Sums { gyro: vec![zero; 2], accel: vec![zero; 2] };
    let mut force = motion.force(attitudes, 1);
    for place in 1..points {
        let next = motion.force(attitudes, place + 1);
        let time = grid.time(place) + 0.5 * grid.step;
        let angle = 0.5 * (way.angles[place] + way.angles[place + 1]);
        let turning = motion.turning(attitudes, place);
        let now = Instant {
            time,
            rate: (way.angles[place + 1] - way.angles[place]) / grid.step,
            rise: way.rises[place + 1],
            warming: warm(time) - start,
            warming_rate: (warm(time + grid.step) - warm(time)) / grid.step,
            turning,
            about_axes: Vector3::from_fn(|gyro, _| axes[gyro].dot(&turning)),
            force: (force + next) * 0.5,
            field: attitudes.in_body(place, &field),
        };
        force = next;
        let mut gyro = now.turning + experiment.gyro.error(&now.turning);
        let mut accel = now.force + experiment.accel.error(&now.force);
        for (effect, law) in &senses {
            let (of_gyro, of_accel) = law(&effect.parameters, &effect.settings, &now);
            gyro += of_gyro;
            accel += of_accel;
        }
        for soak in &mut soaks {
            let (of_gyro, of_accel) = soak.follow(warm(time));
            gyro += of_gyro;
            accel += of_accel;
        }
        for warmth in &mut warmths {
            warmth.follow(angle);
            gyro += warmth.error();
        }
        for unknown in &experiment.unknowns {
            let value = unknown.size * unknown.shape.value(time, angle);
            match unknown.channel {
                Channel::Gyro(axis) => gyro[axis] += value,
                Channel::Accel(axis) => accel[axis] += value,
            }
        }
        sums.gyro.push(sums.gyro[place] + gyro * grid.step);
        sums.accel.push(sums.accel[place] + accel * grid.step);
    }
    sums
}

/// The mean readings over samples, with noise and rounding: of gyros \[rad/s\], of accelerometers \[m/s²\].
pub(crate) fn readings(
    experiment: &Experiment,
    grid: &Grid,
    sums: &Sums,
) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
    let (mut late_gyro, mut late_accel) = (0.0, 0.0);
    for effect in &experiment.effects {
        if let Law::Delay(of) = effect.law() {
            let (gyro, accel) = of(&effect.parameters);
            late_gyro += gyro;
            late_accel += accel;
        }
    }
    let gyro = triad(experiment, grid, &experiment.gyro, (&sums.gyro, late_gyro), Channel::Gyro);
    let accel =
        triad(experiment, grid, &experiment.accel, (&sums.accel, late_accel), Channel::Accel);
    (gyro, accel)
}

fn triad(
    experiment: &Experiment,
    grid: &Grid,
    sensors: &Sensors,
    (sums, late): (&[Vector3<f64>], f64),
    channel: fn(usize) -> Channel,
) -> Vec<Vector3<f64>> {
    let interval = experiment.interval;
    let at = |sample: usize| grid.between(sums, sample as f64 * interval - late);
    let mut before = at(0);
    let mut means: Vec<Vector3<f64>> = Vec::with_capacity(grid.samples);
    for sample in 1..=grid.samples {
        let now = at(sample);
        means.push((now - before) / interval);
        before = now;
    }
    let duration = grid.samples as f64 * interval;
    for axis in 0..3 {
        let of_axis = channel(axis);
        let stream = match of_axis {
            Channel::Gyro(axis) => axis,
            Channel::Accel(axis) => 3 + axis,
        };
        let mut random = random(experiment.seed, stream as u64);
        let mut scatter = Scatter::new(&sensors.noise, interval, duration, &mut random);
        let mut left = 0.0;
        for (sample, mean) in means.iter_mut().enumerate() {
            let time = (sample as f64 + 0.5) * interval;
            let mut times = 1.0;
            for unknown in experiment.unknowns.iter().filter(|u| u.channel == of_axis) {
                times *= unknown.noise(time, &mut random);
            }
            mean[axis] += scatter.next(times, &mut random);
            mean[axis] = match sensors.rounding {
                None => mean[axis],
                Some(Rounding::Mean(bit)) => (mean[axis] / bit).round() * bit,
                Some(Rounding::Increment(bit)) => {
                    let due = mean[axis] * interval + left;
                    let given = (due / bit).round() * bit;
                    left = due - given;
                    given / interval
                }
            };
        }
    }
    means
}

impl Sensors {
    /// The error of a reading.
    fn error(&self, of: &Vector3<f64>) -> Vector3<f64> {
        self.bias + self.matrix * of
    }

    /// The direction of each sensor's input axis in the body, along which its sensitivity is greatest.
    fn axes(&self) -> [Vector3<f64>; 3] {
        let seen = Matrix3::identity() + self.matrix;
        [0, 1, 2].map(|sensor| seen.row(sensor).transpose().normalize())
    }
}
