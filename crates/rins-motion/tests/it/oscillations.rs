//! Coning and sculling: the residual errors of the algorithm, compared with their expansion.

use nalgebra::Vector3;
use rins_frames::units::DEG;
use rins_frames::{Body, Dcm, InFrame, Nav, Site};
use rins_motion::{NavState, Navigator, VerticalChannel};
use rins_testing::assert_close;

use crate::support::{Motion, attitude_apart, station};

/// The tolerance relative to the theoretical residual: terms of fourth order in the half-angle are 3e-4 of it for 2°.
const SHARE: f64 = 1e-3;

const PLACE: Site = Site { latitude: 20.0 * DEG, longitude: 0.0, height: 0.0 };

/// The residual for a phase advance `λ` \[rad\] of the oscillation in one interval: of twice the area enclosed by the arc,
/// `λ - sin λ`, the products of successive chords contribute `sin λ (1 - cos λ) / 3`.
fn left_over(lambda: f64) -> f64 {
    lambda - lambda.sin() - lambda.sin() * (1.0 - lambda.cos()) / 3.0
}

/// The body's z axis moves along a cone, without a net rotation of the body about it.
struct Coning {
    half_angle: f64,
    /// \[rad/s\].
    frequency: f64,
}

impl Motion for Coning {
    fn nav_from_body(&self, time: f64) -> Dcm<Nav, Body> {
        let (sin, cos) = (self.frequency * time).sin_cos();
        Dcm::from_rotation_vector(&(Vector3::new(cos, sin, 0.0) * self.half_angle))
    }

    fn turn_rate(&self, time: f64) -> Vector3<f64> {
        let (sin, cos) = (self.frequency * time).sin_cos();
        let a = self.half_angle;
        Vector3::new(-a.sin() * sin, a.sin() * cos, a.cos() - 1.0) * self.frequency
    }

    fn velocity(&self, _time: f64) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn acceleration(&self, _time: f64) -> Vector3<f64> {
        Vector3::zeros()
    }

    fn site(&self, _time: f64) -> Site {
        PLACE
    }
}

/// A level body that oscillates about z, with a force along x of the same frequency and phase.
struct Sculling {
    amplitude: f64,
    /// \[m/s²\].
    force: f64,
    /// \[rad/s\].
    frequency: f64,
}

impl Motion for Sculling {
    fn nav_from_body(&self, time: f64) -> Dcm<Nav, Body> {
        Dcm::about_z(self.amplitude * (self.frequency * time).sin())
    }

    fn turn_rate(&self, time: f64) -> Vector3<f64> {
        Vector3::z() * (self.amplitude * self.frequency * (self.frequency * time).cos())
    }

    /// The integral of [`Sculling::acceleration`], by its expansion in the amplitude.
    ///
    /// `∫ sin x cos(a sin x)` and `∫ sin x sin(a sin x)` to fourth order in `a`.
    fn velocity(&self, time: f64) -> Vector3<f64> {
        let a = self.amplitude;
        let x = self.frequency * time;
        let (sin, cos) = x.sin_cos();
        let cubic = 2.0 / 3.0 - cos + cos.powi(3) / 3.0;
        let square = x / 2.0 - sin * cos / 2.0;
        let fourth = 3.0 * x / 8.0 - (2.0 * x).sin() / 4.0 + (4.0 * x).sin() / 32.0;
        let east = 1.0 - cos - a * a / 2.0 * cubic;
        let north = a * square - a.powi(3) / 6.0 * fourth;
        Vector3::new(east, north, 0.0) * (self.force / self.frequency)
    }

    fn acceleration(&self, time: f64) -> Vector3<f64> {
        let sin = (self.frequency * time).sin();
        let (across, along) = (self.amplitude * sin).sin_cos();
        Vector3::new(along, across, 0.0) * (self.force * sin)
    }

    fn site(&self, _time: f64) -> Site {
        PLACE
    }
}

fn navigator(motion: &impl Motion) -> Navigator {
    let state = NavState {
        position: PLACE,
        velocity: InFrame::from_components(motion.velocity(0.0)),
        nav_from_body: motion.nav_from_body(0.0),
    };
    Navigator::new(state, &station(PLACE.latitude), VerticalChannel::Held)
}

/// The state after each of these intervals, and the time.
fn run(
    motion: &impl Motion,
    intervals: impl Iterator<Item = f64>,
) -> impl Iterator<Item = (f64, NavState)> {
    let mut navigator = navigator(motion);
    let mut time = 0.0;
    intervals.map(move |interval| {
        navigator.step(&motion.increments(time, time + interval));
        time += interval;
        (time, *navigator.state())
    })
}

/// The drift about z \[rad/s\] over the second half of 2000 intervals.
fn drift_about_z(motion: &Coning, intervals: impl Iterator<Item = f64>) -> f64 {
    let about_z: Vec<(f64, f64)> = run(motion, intervals)
        .map(|(time, state)| {
            (time, attitude_apart(state.nav_from_body, motion.nav_from_body(time)).z)
        })
        .collect();
    let ((begin, first), (end, last)) = (about_z[999], about_z[1999]);
    (last - first) / (end - begin)
}

#[test]
fn coning_drifts_as_its_expansion_predicts() {
    for (half_angle, lambda, interval) in
        [(1.0 * DEG, 0.3, 0.01), (0.5 * DEG, 0.6, 0.01), (2.0 * DEG, 0.4, 0.02)]
    {
        let motion = Coning { half_angle, frequency: lambda / interval };
        let drift = drift_about_z(&motion, std::iter::repeat_n(interval, 2000));
        let theory = -half_angle.sin().powi(2) * left_over(lambda) / (2.0 * interval);
        assert_close!(drift, theory, SHARE * theory.abs());
        // The leading term, as in the navigator's documentation, to a tenth of λ².
        let leading = -half_angle.powi(2) * lambda.powi(5) / (60.0 * interval);
        assert_close!(leading, theory, 0.15 * lambda.powi(2) * theory.abs());
    }
}

/// With alternating intervals `λ₁, λ₂` the chords enclose `sin λ₁/2 sin λ₂/2 sin (λ₁ + λ₂)/2`, which the weights for a linear
/// rate compensate up to the same order.
#[test]
fn coning_under_jitter_drifts_as_its_expansion_predicts() {
    let (half_angle, interval, frequency) = (1.0 * DEG, 0.01, 30.0);
    let motion = Coning { half_angle, frequency };
    for part in [0.1, 0.5] {
        let of_pair = [interval * (1.0 - part), interval * (1.0 + part)];
        let drift = drift_about_z(&motion, (0..2000).map(|k| of_pair[k % 2]));
        let [l1, l2] = of_pair.map(|interval| interval * frequency);
        let chords = 4.0 * (l1 / 2.0).sin() * (l2 / 2.0).sin() * f64::midpoint(l1, l2).sin();
        let weights = (l1 * l1 / l2 + l2 * l2 / l1) / (6.0 * (l1 + l2));
        let left = (l1 - l1.sin() + l2 - l2.sin()) / 2.0 - chords * weights;
        let theory = -half_angle.sin().powi(2) * left / (2.0 * interval);
        assert_close!(drift, theory, SHARE * theory.abs());
    }
}

#[test]
fn sculling_leaves_what_its_expansion_predicts() {
    for (amplitude, lambda, interval) in [(1.0 * DEG, 0.6, 0.01), (2.0 * DEG, 0.5, 0.01)] {
        let motion = Sculling { amplitude, force: 10.0, frequency: lambda / interval };
        let north: Vec<f64> = run(&motion, std::iter::repeat_n(interval, 500))
            .map(|(time, state)| state.velocity.components().y - motion.velocity(time).y)
            .collect();
        let left = (north[499] - north[99]) / (400.0 * interval);
        let theory = -amplitude * 10.0 * left_over(lambda) / (2.0 * lambda);
        assert_close!(left, theory, SHARE * theory.abs());
    }
}
