//! One run of the population: its truth, its files.

use std::fmt;
use std::path::Path;

use nalgebra::{UnitQuaternion, Vector3};

use super::files::{Axes, Description, Readings, Reference, write};
use super::imu::{ARCSEC, DEG, Grade, Imu, Population, Sampling};
use super::motion::Motion;
use super::random::Random;
use super::schedule::{self, Kind, Profile};

/// The sigma of a stated attitude \[rad\].
const ATTITUDE: f64 = 0.1 * DEG;

/// What is true in all logs of an IMU.
#[derive(Debug)]
pub(crate) struct Truths {
    pub(crate) imu: Imu,
    pub(crate) hz: f64,
    pub(crate) runs: Vec<RunTruth>,
}

impl fmt::Display for Truths {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Imu { grade, gyro, accel } = &self.imu;
        write!(f, "{grade:?}, {} Hz, drift {:?} and {:?}", self.hz, gyro.drift, accel.drift)
    }
}

/// What is true in one log.
#[derive(Debug)]
pub(crate) struct RunTruth {
    pub(crate) bias: [Vector3<f64>; 2],
    /// The rotation from the stated to the true attitude.
    pub(crate) attitude: Option<Vector3<f64>>,
}

/// The words after `rins calibrate` for the files of a kind.
pub(crate) fn arguments(kind: Kind) -> &'static str {
    match kind {
        Kind::ThreeMountings => "calibrate run-1.toml run-2.toml run-3.toml --model full",
        _ => "calibrate run-1.toml",
    }
}

/// Simulates the run of this seed into `folder`.
pub(crate) fn simulate(folder: &Path, of: Population, kind: Kind, seed: u64) -> Truths {
    let mut random = Random::new(seed);
    let grade = kind.grade(&mut random);
    let columns = [Axes::draw(&mut random), Axes::draw(&mut random)];
    let planned = plan((of, kind), grade, columns, &mut random);
    let duration = planned.iter().map(|(motion, _)| motion.duration()).fold(0.0, f64::max);
    let hz = schedule::rate(duration, of.samples, &mut random);
    let drifts = of.drifts[usize::from(kind.is_by_hand())];
    let sampling = Sampling { hz, duration };
    let imu = Imu::draw(grade, of.misalignment, drifts, sampling, &mut random);
    let mut truths = Truths { imu: imu.clone(), hz, runs: Vec::new() };
    for (index, (motion, description)) in planned.iter().enumerate() {
        let interval = 1.0 / hz;
        let mut truth = motion.sampled(interval);
        for vector in truth.rate.iter_mut().chain(&mut truth.force) {
            *vector = description.spin.back(vector);
        }
        let bias = [imu.gyro.turn_on(&mut random), imu.accel.turn_on(&mut random)];
        let gyro = imu.gyro.read(bias[0], &truth.rate, interval, &mut random);
        let accel = imu.accel.read(bias[1], &truth.force, interval, &mut random);
        if let Reference::Encoder(noise) = description.reference {
            for angle in &mut truth.angle {
                *angle += noise * random.normal();
            }
        }
        let readings = Readings { interval, gyro, accel, angle: truth.angle };
        let name = format!("run-{}", index + 1);
        write(folder, &name, description, [&imu.gyro, &imu.accel], &readings);
        let attitude = description.attitude.map(|_| motion.start.scaled_axis());
        truths.runs.push(RunTruth { bias, attitude });
    }
    truths
}

fn plan(
    (of, kind): (Population, Kind),
    grade: Grade,
    columns: [Axes; 2],
    random: &mut Random,
) -> Vec<(Motion, Description)> {
    let description = |motion: &Motion, reference, attitude, spin| Description {
        site: motion.site,
        reference,
        attitude,
        spin,
        columns,
    };
    match kind {
        Kind::Tumble | Kind::SixPositions => {
            let motion = match kind {
                Kind::Tumble => schedule::tumble(of.length, random),
                _ => schedule::six_positions(of.length, random),
            };
            let description = description(&motion, Reference::None, None, Axes::SAME);
            vec![(motion, description)]
        }
        Kind::LevelTable => {
            let profile = Profile::draw(grade, of.length, random);
            let tilt = random.vector() * random.log_between(0.01, 0.5) * DEG;
            let yaw = UnitQuaternion::new(Vector3::z() * random.between(-3.0, 3.0));
            let site = schedule::site(random);
            let motion = profile.motion(site, yaw * UnitQuaternion::new(tilt));
            let reference = if random.chance(0.5) {
                Reference::Encoder(random.log_between(2.0, 60.0) * ARCSEC)
            } else {
                Reference::Commanded(profile)
            };
            let spin = Axes::spin(random.below(3), [1.0, -1.0][random.below(2)]);
            let description = description(&motion, reference, None, spin);
            vec![(motion, description)]
        }
        Kind::ThreeMountings => {
            let site = schedule::site(random);
            let encoder = random.log_between(0.3, 10.0) * ARCSEC;
            let mounted = |axis| {
                let profile = Profile::draw(grade, of.length, random);
                let start = UnitQuaternion::new(random.vector() * ATTITUDE);
                let motion = profile.motion(site, start);
                let spin = Axes::spin(axis, [1.0, -1.0][random.below(2)]);
                let reference = Reference::Encoder(encoder);
                let description = description(&motion, reference, Some(ATTITUDE), spin);
                (motion, description)
            };
            [0, 1, 2].map(mounted).into()
        }
    }
}
