//! Random logs, with the times at which they are static.

use nalgebra::{Unit, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, STANDARD_GRAVITY};
use rins_frames::{EARTH_RATE, InFrame, Increments};
use rins_inspection::{SensorFigures, StaticOptions};
use rins_motion::Recording;

/// There are no disturbances for this time after the start of an interval and before its end \[s\].
const CALM: f64 = 1.5;

const RATES: [f64; 8] = [10.0, 20.0, 50.0, 100.0, 200.0, 400.0, 1000.0, 2000.0];

const GRADES: [&str; 5] = ["consumer", "industrial", "tactical", "fog", "rlg"];

const MOTIONS: [&str; 3] = ["hand", "table", "rocked"];

/// The typical errors of the sensors of a grade; those of a log are drawn around them.
struct Grade {
    /// Densities of white noise \[rad/s/√Hz\], \[m/s²/√Hz\].
    noise: [f64; 2],
    /// \[rad/s\], \[m/s²\].
    bias_sigma: [f64; 2],
    /// \[(rad/s)/(m/s²)\]
    g_sensitivity: f64,
    /// \[rad/s\], \[m/s²\]
    lsb: [f64; 2],
}

fn draw(rng: &mut Pcg64, from: f64, to: f64) -> f64 {
    from + (to - from) * rng.random::<f64>()
}

fn log_draw(rng: &mut Pcg64, from: f64, to: f64) -> f64 {
    draw(rng, from.ln(), to.ln()).exp()
}

fn normal(rng: &mut Pcg64) -> f64 {
    StandardNormal.sample(rng)
}

fn direction(rng: &mut Pcg64) -> Vector3<f64> {
    Vector3::new(normal(rng), normal(rng), normal(rng)).normalize()
}

fn grade(name: &str, rng: &mut Pcg64) -> Grade {
    let angle_random_walk = DEG / 60.0;
    let per_g = DEG_PER_SECOND / STANDARD_GRAVITY;
    let mg = 1000.0 * MICRO_G;
    match name {
        "consumer" => Grade {
            noise: [
                log_draw(rng, 0.004, 0.03) * DEG_PER_SECOND,
                log_draw(rng, 100.0, 400.0) * MICRO_G,
            ],
            bias_sigma: [log_draw(rng, 0.3, 5.0) * DEG_PER_SECOND, 40.0 * mg],
            g_sensitivity: draw(rng, 0.0, 0.1) * per_g,
            lsb: [draw(rng, 0.0, 0.06) * DEG_PER_SECOND, draw(rng, 0.06, 1.0) * mg],
        },
        "industrial" => Grade {
            noise: [log_draw(rng, 0.002, 0.01) * DEG_PER_SECOND, 60.0 * MICRO_G],
            bias_sigma: [log_draw(rng, 0.05, 0.3) * DEG_PER_SECOND, 8.0 * mg],
            g_sensitivity: draw(rng, 0.0, 0.02) * per_g,
            lsb: [draw(rng, 0.0, 0.01) * DEG_PER_SECOND, 0.1 * mg],
        },
        "tactical" => Grade {
            noise: [log_draw(rng, 0.02, 0.15) * angle_random_walk, 30.0 * MICRO_G],
            bias_sigma: [log_draw(rng, 3.0, 30.0) * DEG_PER_HOUR, 2.0 * mg],
            g_sensitivity: draw(rng, 0.0, 5.0) * DEG_PER_HOUR / STANDARD_GRAVITY,
            lsb: [0.0, 0.0],
        },
        "fog" => Grade {
            noise: [log_draw(rng, 0.002, 0.02) * angle_random_walk, 20.0 * MICRO_G],
            bias_sigma: [log_draw(rng, 0.05, 1.0) * DEG_PER_HOUR, 0.2 * mg],
            g_sensitivity: 0.0,
            lsb: [0.0, 0.0],
        },
        _ => Grade {
            noise: [log_draw(rng, 0.0008, 0.004) * angle_random_walk, 8.0 * MICRO_G],
            bias_sigma: [log_draw(rng, 0.003, 0.02) * DEG_PER_HOUR, 0.05 * mg],
            g_sensitivity: 0.0,
            // LSBs of angle and velocity increments; they are divided by the interval below.
            lsb: [draw(rng, 0.1, 1.2) * ARCSEC, 1e-4],
        },
    }
}

/// One motion between two static intervals.
struct Move {
    duration: f64,
    axis: Vector3<f64>,
    /// Whether its axis is the vertical, in any attitude of the body.
    vertical: bool,
    /// The angle of rotation \[rad\].
    angle: f64,
    /// The duration of a table's ramps; `None` for a motion by hand.
    ramp: Option<f64>,
    back: bool,
    /// Amplitude \[rad/s\], frequency \[Hz\], direction.
    tremor: (f64, f64, Vector3<f64>),
    /// The acceleration by a hand \[m/s²\].
    push: Vector3<f64>,
}

impl Move {
    fn drawn(kind: &str, rng: &mut Pcg64) -> Self {
        let tremor =
            (log_draw(rng, 0.5, 5.0) * DEG_PER_SECOND, draw(rng, 7.0, 12.0), direction(rng));
        match kind {
            "hand" => Self {
                duration: draw(rng, 0.8, 4.0),
                axis: direction(rng),
                vertical: false,
                angle: draw(rng, 20.0, 180.0) * DEG,
                ramp: None,
                back: false,
                tremor,
                push: direction(rng) * log_draw(rng, 0.1, 2.0),
            },
            "table" => {
                let rate = log_draw(rng, 4.0, 100.0) * DEG_PER_SECOND;
                let ramp = log_draw(rng, 0.05, 0.5);
                let angle = log_draw(rng, 10.0, 360.0) * DEG;
                let duration = (angle / rate).max(ramp) + ramp;
                Self {
                    duration,
                    axis: direction(rng),
                    vertical: rng.random::<f64>() < 0.25,
                    angle: (duration - ramp) * rate,
                    ramp: Some(ramp),
                    back: false,
                    tremor: (0.0, 1.0, Vector3::x()),
                    push: Vector3::zeros(),
                }
            }
            _ => {
                let half = log_draw(rng, 0.5, 8.0);
                let angle = log_draw(rng, 5.0_f64.max(4.0 * half), 90.0) * DEG;
                let steady = rng.random::<bool>();
                Self {
                    duration: 2.0 * half,
                    axis: direction(rng),
                    vertical: false,
                    angle,
                    ramp: None,
                    back: true,
                    tremor: if steady { (0.0, 1.0, Vector3::x()) } else { tremor },
                    push: Vector3::zeros(),
                }
            }
        }
    }

    /// The rate about the axis, and that of the tremor.
    fn rate(&self, time: f64) -> Vector3<f64> {
        let smooth = |time: f64, duration: f64| {
            let s = time / duration;
            30.0 * s * s * (1.0 - s) * (1.0 - s) / duration
        };
        let rate = match self.ramp {
            Some(ramp) => {
                let full = self.angle / (self.duration - ramp);
                full * (time / ramp).min(1.0).min((self.duration - time) / ramp).max(0.0)
            }
            None if self.back => {
                let half = self.duration / 2.0;
                if time < half {
                    self.angle * smooth(time, half)
                } else {
                    -self.angle * smooth(time - half, half)
                }
            }
            None => self.angle * smooth(time, self.duration),
        };
        let (amplitude, frequency, along) = self.tremor;
        let phase = std::f64::consts::TAU * frequency * time;
        self.axis * rate + along * (amplitude * self.envelope(time) * phase.sin())
    }

    /// The strength of the hand's motion: full from the first tenth of a second on.
    fn envelope(&self, time: f64) -> f64 {
        (time / 0.1).min((self.duration - time) / 0.1).clamp(0.0, 1.0)
    }

    fn force(&self, time: f64) -> Vector3<f64> {
        self.push * (self.envelope(time) * (std::f64::consts::TAU * time / self.duration).sin())
    }
}

/// A log, its description, and its static intervals \[s\].
pub(super) struct Log {
    pub(super) grade: &'static str,
    pub(super) rate: f64,
    pub(super) motion: &'static str,
    pub(super) recording: Recording,
    pub(super) options: StaticOptions,
    pub(super) stationary: Vec<[f64; 2]>,
}

/// A footstep: time, direction, amplitudes \[rad/s\], \[m/s²\], and frequency \[Hz\].
struct Footstep {
    time: f64,
    along: Vector3<f64>,
    strength: [f64; 2],
    frequency: f64,
}

impl Footstep {
    fn at(&self, time: f64) -> [Vector3<f64>; 2] {
        let since = time - self.time;
        if !(0.0..0.8).contains(&since) {
            return [Vector3::zeros(); 2];
        }
        let swing = (-since / 0.12).exp() * (std::f64::consts::TAU * self.frequency * since).sin();
        self.strength.map(|strength| self.along * (strength * swing))
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it is small and positive"
)]
fn whole(ratio: f64) -> usize {
    ratio as usize
}

#[expect(clippy::too_many_lines, reason = "one draw after another")]
pub(super) fn log(seed: u64) -> Log {
    let mut rng = Pcg64::seed_from_u64(seed);
    let pick = |count: usize, rng: &mut Pcg64| rng.random_range(0..count);
    let name = GRADES[pick(GRADES.len(), &mut rng)];
    let rate = RATES[pick(RATES.len(), &mut rng)];
    let motion = MOTIONS[pick(MOTIONS.len(), &mut rng)];
    let interval = 1.0 / rate;
    let mut grade = grade(name, &mut rng);
    if name == "rlg" {
        grade.lsb = grade.lsb.map(|count| count / interval);
    }
    let has_sheet = rng.random::<f64>() < 0.67;
    let mut bias = Vector3::from_fn(|_, _| normal(&mut rng).clamp(-2.5, 2.5)) * grade.bias_sigma[0];
    if !has_sheet {
        // Not more than the assumed limit for a data sheet without a bias.
        let most = StaticOptions::default().assumed_bias * 0.9;
        bias *= (most / bias.norm()).min(1.0);
    }
    let accel_bias =
        Vector3::from_fn(|_, _| normal(&mut rng).clamp(-2.5, 2.5)) * grade.bias_sigma[1];
    let sensitivity =
        nalgebra::Matrix3::from_fn(|_, _| normal(&mut rng) / 3.0_f64.sqrt()) * grade.g_sensitivity;

    // The static intervals and the motions.
    let count = 2 + pick(6, &mut rng);
    let mut attitude = UnitQuaternion::from_axis_angle(
        &Unit::new_normalize(direction(&mut rng)),
        draw(&mut rng, 0.0, 3.0),
    );
    let north = Vector3::new(0.0, 0.6, 0.8) * EARTH_RATE;
    let mut stationary = Vec::new();
    let mut footsteps = Vec::new();
    let walks = rng.random::<f64>() < 0.33;
    let loses = (rng.random::<f64>() < 0.33).then(|| draw(&mut rng, 10.0, 60.0));
    let mut recording = Recording::default();
    let mut time = 0.0;
    let mut pending = 0.0;
    let steps = if rate < 100.0 { whole(200.0 / rate) } else { 2 };
    let mut segments: Vec<(f64, Option<Move>)> = Vec::new();
    let longest = if rate > 900.0 { 15.0 } else { 60.0 };
    let mut begun = 0.0;
    for place in 0..count {
        let lasting = log_draw(&mut rng, 2.0, longest);
        // A disturbance at an end is not distinguishable from the motion that begins or ends there.
        if walks && lasting > 2.0 * CALM {
            for _ in 0..=whole(lasting / 8.0) {
                footsteps.push(Footstep {
                    time: begun + draw(&mut rng, CALM, lasting - CALM),
                    along: direction(&mut rng),
                    strength: [
                        log_draw(&mut rng, 0.01, 0.3) * DEG_PER_SECOND,
                        log_draw(&mut rng, 0.01, 0.3),
                    ],
                    frequency: draw(&mut rng, 10.0, 30.0),
                });
            }
        }
        stationary.push([begun, begun + lasting]);
        segments.push((lasting, None));
        begun += lasting;
        if place + 1 < count {
            let one = Move::drawn(motion, &mut rng);
            begun += one.duration;
            segments.push((one.duration, Some(one)));
        }
    }
    let (mut segment, mut since) = (0, 0.0);
    let end = begun;
    let mut angle = Vector3::zeros();
    let mut velocity = Vector3::zeros();
    let [mut rounded_angle, mut rounded_velocity] = [Vector3::<f64>::zeros(); 2];
    while time < end - interval {
        let small = interval / steps as f64;
        for _ in 0..steps {
            let middle = since + 0.5 * small;
            let (mut rate, mut force) = (Vector3::zeros(), Vector3::zeros());
            if let (_, Some(one)) = &mut segments[segment] {
                if one.vertical {
                    one.axis = attitude.inverse() * Vector3::z();
                }
                rate = one.rate(middle);
                force = one.force(middle);
            }
            let at = time + 0.5 * small;
            for footstep in &footsteps {
                let [by_rate, by_force] = footstep.at(at);
                rate += by_rate;
                force += by_force;
            }
            let half = UnitQuaternion::from_scaled_axis(rate * (0.5 * small));
            let mid = attitude * half;
            let up = mid.inverse() * Vector3::z() * 9.81 + force;
            let true_rate = rate + mid.inverse() * north;
            angle += (true_rate + bias + sensitivity * up) * small;
            velocity += (up + accel_bias) * small;
            attitude = mid * half;
            since += small;
            time += small;
            if since >= segments[segment].0 - 1e-9 && segment + 1 < segments.len() {
                segment += 1;
                since = 0.0;
            }
        }
        pending += interval;
        let root = interval.sqrt();
        angle += Vector3::from_fn(|_, _| normal(&mut rng)) * (grade.noise[0] * root);
        velocity += Vector3::from_fn(|_, _| normal(&mut rng)) * (grade.noise[1] * root);
        if loses.is_some_and(|mean| rng.random::<f64>() < interval / mean) && time > 1.0 {
            // The sample is lost: the rates of the next one are held over both intervals.
            angle = Vector3::zeros();
            velocity = Vector3::zeros();
            continue;
        }
        let held = pending / interval;
        let round = |value: Vector3<f64>, lsb: f64, left: &mut Vector3<f64>, sums: bool| {
            if lsb == 0.0 {
                return value;
            }
            let wanted = if sums { value + *left } else { value };
            let got = wanted.map(|value| (value / lsb).round() * lsb);
            *left = wanted - got;
            got
        };
        let sums = name == "rlg";
        let read_rate = round(angle / interval, grade.lsb[0], &mut rounded_angle, sums);
        let read_force = round(velocity / interval, grade.lsb[1], &mut rounded_velocity, sums);
        recording.times.push(time);
        recording.increments.push(Increments {
            angle: InFrame::from_components(read_rate * interval * held),
            velocity: InFrame::from_components(read_force * interval * held),
            interval: pending,
        });
        angle = Vector3::zeros();
        velocity = Vector3::zeros();
        pending = 0.0;
    }
    let said = |value: f64, rng: &mut Pcg64| has_sheet.then(|| value * log_draw(rng, 0.7, 1.5));
    let figures = |place: usize, rng: &mut Pcg64| SensorFigures {
        bias_sigma: has_sheet.then_some(grade.bias_sigma[place]),
        noise_density: said(grade.noise[place], rng),
        resolution: None,
    };
    let options = StaticOptions {
        gyro: figures(0, &mut rng),
        accel: figures(1, &mut rng),
        ..StaticOptions::default()
    };
    Log { grade: name, rate, motion, recording, options, stationary }
}
