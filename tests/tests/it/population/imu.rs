//! IMUs of five grades: data sheets, and errors drawn from them.

use nalgebra::{Matrix3, Vector3};

use super::random::Random;

pub(crate) const DEG: f64 = std::f64::consts::PI / 180.0;
pub(crate) const DEG_H: f64 = DEG / 3600.0;
pub(crate) const ARCSEC: f64 = DEG / 3600.0;
pub(crate) const MICRO_G: f64 = 9.80665e-6;
pub(crate) const PPM: f64 = 1e-6;

/// The ratio of successive correlation times of the Gauss-Markov processes whose sum is flicker noise.
const LADDER: f64 = 3.0;

/// The shortest of these times \[s\].
const SHORTEST: f64 = 0.1;

/// The data sheet of a triad, in SI units and radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    /// The noise density: the standard deviation of a mean over one second.
    pub(crate) noise: f64,
    pub(crate) bias: f64,
    pub(crate) scale: f64,
    pub(crate) misalignment: f64,
    /// The bias instability, if it is stated.
    pub(crate) instability: Option<f64>,
    /// The random walk in one second, if it is stated.
    pub(crate) walk: Option<f64>,
    /// The LSB, if it is stated.
    pub(crate) lsb: Option<f64>,
}

/// The drift of a bias about its constant part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drift {
    None,
    /// Flicker noise with the power spectral density `B²/(2πf)`.
    Flicker,
    /// A random walk from zero, which the data sheet states.
    Walk,
}

/// A population of runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Population {
    /// Misalignments and their data-sheet values, relative to typical ones.
    pub(crate) misalignment: f64,
    /// The drift of a bias is one of these on a table, and by hand.
    pub(crate) drifts: [&'static [Drift]; 2],
    /// The longest durations, relative to those of a full study.
    pub(crate) length: f64,
    /// The largest number of samples of a log.
    pub(crate) samples: f64,
}

/// The true errors of a triad except for its turn-on bias.
#[derive(Clone, Debug)]
pub(crate) struct Triad {
    /// What the data sheet states.
    pub(crate) sheet: Sheet,
    /// The actual noise density.
    pub(crate) noise: f64,
    /// Scale errors on the diagonal, misalignments off the diagonal.
    pub(crate) shape: Matrix3<f64>,
    pub(crate) drift: Drift,
    /// The standard deviations and correlation times of Gauss-Markov processes; infinite for a random walk, whose deviation
    /// is that of one second.
    processes: Vec<[f64; 2]>,
    /// The LSB of a reading; zero if readings are exact.
    pub(crate) lsb: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Imu {
    pub(crate) grade: Grade,
    pub(crate) gyro: Triad,
    pub(crate) accel: Triad,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Grade {
    Consumer,
    Industrial,
    Tactical,
    Fog,
    Rlg,
}

/// Typical noise density, bias, scale error, misalignment and bias instability of a triad.
type Typical = [f64; 5];

impl Grade {
    pub(crate) const ALL: [Self; 5] =
        [Self::Consumer, Self::Industrial, Self::Tactical, Self::Fog, Self::Rlg];
    pub(crate) const MEMS: [Self; 2] = [Self::Consumer, Self::Industrial];

    /// Gyros in deg/√h, deg/h, ppm, arcsec, deg/h; accelerometers in ug/√Hz, ug, ppm, arcsec, ug.
    fn typical(self) -> [Typical; 2] {
        match self {
            Self::Consumer => [[0.6, 1000.0, 1e4, 3600.0, 10.0], [150.0, 3e4, 1e4, 3600.0, 50.0]],
            Self::Industrial => [[0.2, 200.0, 3e3, 1200.0, 4.0], [80.0, 5e3, 3e3, 1200.0, 20.0]],
            Self::Tactical => [[0.04, 10.0, 500.0, 300.0, 0.5], [40.0, 2e3, 500.0, 300.0, 10.0]],
            Self::Fog => [[0.005, 0.5, 100.0, 60.0, 0.02], [20.0, 300.0, 200.0, 60.0, 4.0]],
            Self::Rlg => [[0.001, 0.02, 10.0, 20.0, 0.003], [10.0, 60.0, 60.0, 20.0, 1.0]],
        }
    }
}

/// The sampling of a run: its rate \[Hz\] and its duration \[s\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampling {
    pub(crate) hz: f64,
    pub(crate) duration: f64,
}

impl Imu {
    /// The misalignments of `grade` are multiplied by `misalignment`.
    pub(crate) fn draw(
        grade: Grade,
        misalignment: f64,
        drifts: &[Drift],
        sampling: Sampling,
        random: &mut Random,
    ) -> Self {
        let [gyro, accel] = grade.typical();
        let mut triad = |[n, b, s, m, i]: Typical, [noise, bias]: [f64; 2]| {
            let units = [noise, bias, PPM, misalignment * ARCSEC, bias];
            let typical = [n * units[0], b * units[1], s * units[2], m * units[3], i * units[4]];
            Triad::draw(typical, drifts, sampling, random)
        };
        let gyro = triad(gyro, [DEG / 60.0, DEG_H]);
        let accel = triad(accel, [MICRO_G, MICRO_G]);
        Self { grade, gyro, accel }
    }
}

impl Triad {
    fn draw(
        typical: Typical,
        drifts: &[Drift],
        Sampling { hz, duration }: Sampling,
        random: &mut Random,
    ) -> Self {
        let [stated, bias, scale, misalignment, instability] =
            typical.map(|value| value * (0.3 * random.normal()).exp());
        let noise = stated * (0.3 * random.normal()).exp();
        let triangular = random.chance(0.5);
        let shape = Matrix3::from_fn(|row, column| {
            let deviate = random.normal();
            if row == column {
                scale * deviate
            } else if triangular && row > column {
                0.0
            } else {
                misalignment * deviate
            }
        });
        let drift = drifts[random.below(drifts.len())];
        let (walk, processes) = match drift {
            Drift::None => (None, Vec::new()),
            Drift::Flicker => (None, flicker(instability, duration)),
            Drift::Walk => {
                let walk = instability / duration.sqrt();
                (Some(walk), vec![[walk, f64::INFINITY]])
            }
        };
        let lsb = noise * hz.sqrt() * [0.0, 0.01, 0.3, 1.0][random.below(4)];
        let sheet = Sheet {
            noise: stated,
            bias,
            scale,
            misalignment,
            instability: random.chance(0.5).then_some(instability),
            walk,
            lsb: (random.chance(0.5) && lsb > 0.0).then_some(lsb),
        };
        Self { sheet, noise, shape, drift, processes, lsb }
    }

    /// The biases after one turn-on.
    pub(crate) fn turn_on(&self, random: &mut Random) -> Vector3<f64> {
        random.vector() * self.sheet.bias
    }

    /// Readings of the mean true input over successive samples.
    pub(crate) fn read(
        &self,
        bias: Vector3<f64>,
        truth: &[Vector3<f64>],
        interval: f64,
        random: &mut Random,
    ) -> Vec<Vector3<f64>> {
        // Decay over a sample, and the standard deviation of what is added.
        let steps: Vec<[f64; 2]> =
            self.processes.iter().map(|process| step(process, interval)).collect();
        let mut drifts: Vec<Vector3<f64>> = self
            .processes
            .iter()
            .map(|[sigma, time]| random.vector() * if time.is_finite() { *sigma } else { 0.0 })
            .collect();
        let noise = self.noise / interval.sqrt();
        let mut read = Vec::with_capacity(truth.len());
        for input in truth {
            let drift: Vector3<f64> = drifts.iter().sum();
            let reading = input + bias + drift + self.shape * input + random.vector() * noise;
            let rounded = |value: f64| (value / self.lsb).round() * self.lsb;
            read.push(if self.lsb > 0.0 { reading.map(rounded) } else { reading });
            for (drift, [decay, added]) in drifts.iter_mut().zip(&steps) {
                *drift = *drift * *decay + random.vector() * *added;
            }
        }
        read
    }
}

/// The processes whose sum is flicker noise, up to twice the run.
fn flicker(instability: f64, duration: f64) -> Vec<[f64; 2]> {
    let sigma = instability * (LADDER.ln() / std::f64::consts::PI).sqrt();
    let times = std::iter::successors(Some(SHORTEST), |time| Some(time * LADDER));
    times.take_while(|time| *time < 2.0 * duration).map(|time| [sigma, time]).collect()
}

fn step([sigma, time]: &[f64; 2], interval: f64) -> [f64; 2] {
    if time.is_infinite() {
        return [1.0, sigma * interval.sqrt()];
    }
    let decay = (-interval / time).exp();
    [decay, sigma * (1.0 - decay * decay).sqrt()]
}
