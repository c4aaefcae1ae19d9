//! The estimated latency of a table angle, and the consistency of its 1σ.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_frames::units::DEG;
use rins_frames::{InFrame, Increments};
use rins_inspection::inspect;
use rins_motion::Recording;

use crate::run::{NAVIGATION, expected};

/// A tenth of a second before the start and after the end, so that the delayed angle is known everywhere.
const MARGIN: f64 = 0.1;

/// The rates \[rad/s\] of a table from each time \[s\] on, and its end.
struct Rates {
    corners: Vec<(f64, f64)>,
    end: f64,
}

impl Rates {
    /// Two to six rates of up to 150 deg/s, after a static interval of five seconds, with steps between them or ramps of up
    /// to two seconds.
    fn drawn(rng: &mut Pcg64) -> Self {
        let (top, ramps) = (10_f64.powf(rng.random_range(0.7..2.2)) * DEG, rng.random::<bool>());
        let (mut corners, mut end, mut rate) = (vec![(-MARGIN, 0.0)], 5.0, 0.0);
        for _ in 0..rng.random_range(2..7) {
            let next = rng.random_range(-top..top);
            let steps = if ramps { rng.random_range(1..200) } else { 0 };
            for step in 1..=steps {
                corners.push((end, rate + (next - rate) * f64::from(step) / f64::from(steps + 1)));
                end += 0.01;
            }
            corners.push((end, next));
            rate = next;
            end += rng.random_range(5.0..40.0);
        }
        Self { corners, end }
    }

    /// The angle \[rad\] at increasing times \[s\].
    fn angles(&self, times: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut reached = 0.0;
        let mut corners = self.corners.iter().copied().peekable();
        let (mut since, mut rate) = corners.next().unwrap();
        times
            .map(|time| {
                while let Some((next, faster)) = corners.next_if(|(next, _)| *next <= time) {
                    reached += rate * (next - since);
                    (since, rate) = (next, faster);
                }
                reached + rate * (time - since)
            })
            .collect()
    }
}

/// A gyro with white noise and a bias, and an angle with a latency of `latency` \[s\] and white noise.
fn recorded(latency: f64, rng: &mut Pcg64) -> Recording {
    let rates = Rates::drawn(rng);
    let rate = [20.0, 50.0, 100.0, 200.0, 400.0][rng.random_range(0..5)];
    let interval = 1.0 / rate;
    let times = (0_u32..).map(|sample| f64::from(sample) * interval);
    let times: Vec<f64> = times.take_while(|time| *time < rates.end).collect();
    let noise = 10_f64.powf(rng.random_range(-4.0..0.0)) * DEG / 60.0 * interval.sqrt();
    let (of_angle, bias) =
        (10_f64.powf(rng.random_range(-6.0..-3.0)), rng.random_range(-1e-4..1e-4));
    let mut white = |size: f64| -> f64 {
        let one: f64 = StandardNormal.sample(rng);
        size * one
    };
    let increments = rates
        .angles(times.iter().copied())
        .windows(2)
        .map(|angles| {
            let turned = angles[1] - angles[0] + bias * interval + white(noise);
            let angle = Vector3::new(white(noise), white(noise), turned);
            let velocity = Vector3::new(0.0, 0.0, 9.8 * interval);
            Increments {
                angle: InFrame::from_components(angle),
                velocity: InFrame::from_components(velocity),
                interval,
            }
        })
        .collect();
    let late = rates.angles(times[1..].iter().map(|time| time - latency));
    Recording {
        times: times[1..].to_vec(),
        increments,
        table_angle: Some(late.into_iter().map(|angle| angle + white(of_angle)).collect()),
        ..Recording::default()
    }
}

/// The errors of the latencies are consistent with their 1σ, and the mean of their normalized squares is one.
#[test]
fn latency_has_its_sigma() {
    let mut rng = Pcg64::seed_from_u64(41);
    let squares: Vec<f64> = (0..100)
        .map(|draw| {
            let size = 10_f64.powf(rng.random_range(-5.0..-1.7));
            let latency = [0.0, size, -size][draw % 3];
            let lag = inspect(&recorded(latency, &mut rng), &expected(NAVIGATION)).table_lag;
            let lag = lag.expect("a table with two rates shows its latency");
            let beyond = (lag.latency - latency) / lag.sigma;
            assert!(beyond.abs() < 4.5, "{latency}: {lag:?}");
            beyond * beyond
        })
        .collect();
    let mean = squares.iter().sum::<f64>() / 100.0;
    // Chi-squared of 100 degrees of freedom at 0.001 in both directions, with a margin because the sigmas are estimates.
    assert!((0.61..1.6).contains(&mean), "{mean}");
}
