//! Eqs. (6), (8) and (9) against numerical integration, over times, attitudes and rates.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND, PPM};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Nav, Site};
use rins_motion::mechanism::{
    ClosedForm, ConstantTurn, LinearModel, NavErrors, SensorErrors, Sign, SpinAxisErrors,
    flat_navigation,
};
use rins_motion::{NavState, Navigator, Profile, Segment, Station, TrueMotion, VerticalChannel};

use crate::error::ReproductionError;

/// The times of the grid \[s\]: a quarter of a turn at the paper's rate, one turn, two and a half, ten.
pub(crate) const TIMES: [f64; 4] = [9.0, 36.0, 90.0, 360.0];
/// The rates of the grid \[deg/s\].
pub(crate) const RATES: [f64; 4] = [10.0, -10.0, 5.0, 20.0];
/// The attitudes of the grid: roll, pitch, yaw \[deg\]; Table 4's, section 4.1's, level, steep.
pub(crate) const ATTITUDES: [[f64; 3]; 4] =
    [[30.0, 20.0, 40.0], [20.0, 30.0, 40.0], [0.0, 0.0, 0.0], [-60.0, 45.0, 160.0]];

/// The sample interval of the navigator and of the flat-Earth integration \[s\].
const INTERVAL: f64 = 0.02;

/// The relative tolerance for the flat-Earth integration against its closed form: the error of Simpson's rule over a rotation
/// of 0.4° is about 10⁻¹¹, that of rounding over 18,000 steps 10⁻¹⁰.
const INTEGRATION: f64 = 1e-8;

/// The relative tolerance for the extended form against the navigator: the second-order products
/// with Earth rate and curvature, which it lacks.
const EXTENDED: f64 = 3e-3;

/// The spin-axis errors of Table 2.
pub(crate) const ERRORS: SpinAxisErrors = SpinAxisErrors {
    misalignment_xz: 60.0 * ARCSEC,
    misalignment_yz: 60.0 * ARCSEC,
    scale_z: 300.0 * PPM,
};

/// Velocity and attitude error at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Errors {
    /// East, north \[m/s\], up zero.
    pub(crate) velocity: Vector3<f64>,
    /// `φ` in n \[rad\].
    pub(crate) attitude: Vector3<f64>,
}

impl Errors {
    fn of(velocity: &InFrame<Nav>, attitude: &InFrame<Nav>) -> Self {
        Self { velocity: *velocity.components(), attitude: *attitude.components() }
    }

    /// The relative difference from `truth`: the larger of velocity and attitude.
    pub(crate) fn relative_to(&self, truth: &Self) -> f64 {
        let velocity = (self.velocity - truth.velocity).norm() / truth.velocity.norm();
        let attitude = (self.attitude - truth.attitude).norm() / truth.attitude.norm();
        velocity.max(attitude)
    }
}

/// One point of the grid, by every method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Row {
    /// Roll, pitch, yaw \[deg\].
    pub(crate) attitude: [f64; 3],
    /// The table rate \[deg/s\].
    pub(crate) rate: f64,
    /// The time \[s\].
    pub(crate) time: f64,
    /// Eqs. (6), (8), (9) as printed.
    pub(crate) printed: Errors,
    /// The same with the sign for a strapdown system.
    pub(crate) corrected: Errors,
    /// Numerical integration on a flat Earth without rotation.
    pub(crate) flat: Errors,
    /// The linear model of the round, rotating Earth, with the second order of the flat Earth.
    pub(crate) extended: Errors,
    /// The navigator on the round, rotating Earth.
    pub(crate) navigated: Errors,
    /// The relative difference of the flat-Earth integration from its closed form.
    pub(crate) integration: f64,
}

impl Row {
    /// The relative tolerance for the corrected form against the flat-Earth integration: the second order,
    /// `S_z ω t` and the misalignments themselves.
    pub(crate) fn second_order(&self) -> f64 {
        let turned = (self.rate * DEG_PER_SECOND * self.time).abs();
        ERRORS.scale_z * turned + ERRORS.misalignment_xz.hypot(ERRORS.misalignment_yz)
    }

    /// The bounds that this point violates, in words.
    pub(crate) fn broken(&self) -> Vec<String> {
        let mut broken = Vec::new();
        let mut demand = |what: &str, is: f64, at_most: f64| {
            if is.is_nan() || is > at_most {
                let [roll, pitch, yaw] = self.attitude;
                broken.push(format!(
                    "{what} at {} s, {} deg/s, roll {roll}, pitch {pitch}, yaw {yaw} deg: \
                     off by {is:.1e}, at most {at_most:.1e}",
                    self.time, self.rate,
                ));
            }
        };
        let turned = Errors { velocity: -self.printed.velocity, attitude: -self.printed.attitude };
        demand(
            "the printed form is not minus the right one",
            turned.relative_to(&self.corrected),
            1e-15,
        );
        demand("the flat integration is off its closed form", self.integration, INTEGRATION);
        let off = self.corrected.relative_to(&self.flat);
        demand("the corrected form is off the flat integration", off, self.second_order());
        let off = self.extended.relative_to(&self.navigated);
        demand("the extended form is off the navigator", off, EXTENDED);
        broken
    }
}

/// The grid at these times \[s\], attitudes \[deg\] and rates \[deg/s\].
///
/// # Errors
/// [`ReproductionError::Profile`] if a time or a rate is not valid for a profile.
pub(crate) fn grid(
    times: &[f64],
    attitudes: &[[f64; 3]],
    rates: &[f64],
) -> Result<Vec<Row>, ReproductionError> {
    let places: Vec<([f64; 3], f64)> = attitudes
        .iter()
        .flat_map(|&attitude| rates.iter().map(move |&rate| (attitude, rate)))
        .collect();
    let rows: Vec<Vec<Row>> = places
        .par_iter()
        .map(|&(attitude, rate)| rows(attitude, rate, times))
        .collect::<Result<_, ReproductionError>>()?;
    Ok(rows.concat())
}

/// The rotation of the grid, at the site of the paper's authors.
pub(crate) fn turn(attitude: [f64; 3], rate: f64) -> ConstantTurn {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let [roll, pitch, yaw] = attitude.map(|angle| angle * DEG);
    ConstantTurn {
        station: Station::with_normal_gravity(site),
        nav_from_table: EulerAngles { roll, pitch, yaw }.dcm(),
        rate: rate * DEG_PER_SECOND,
    }
}

fn rows(attitude: [f64; 3], rate: f64, times: &[f64]) -> Result<Vec<Row>, ReproductionError> {
    let turn = turn(attitude, rate);
    let none = NavErrors::none();
    let model = LinearModel::new(turn, VerticalChannel::Held);
    let rows = times.iter().zip(navigated(&turn, times)?).map(|(&time, navigated)| {
        let form = |sign| {
            let form = ClosedForm::new(turn, ERRORS, sign);
            Errors::of(&form.velocity_error(time).total(), &form.attitude_error(time))
        };
        let corrected = form(Sign::Strapdown);
        let exact = flat_navigation(&turn, &ERRORS, &none, time);
        let exact = Errors::of(&exact.velocity, &exact.attitude);
        let linear = model.propagate(&none, &SensorErrors::from(ERRORS), time);
        let flat = flat_integration(&turn, time);
        Row {
            attitude,
            rate,
            time,
            printed: form(Sign::Printed),
            corrected,
            flat,
            extended: Errors {
                velocity: linear.velocity.components() + exact.velocity - corrected.velocity,
                attitude: linear.attitude.components() + exact.attitude - corrected.attitude,
            },
            navigated,
            integration: flat.relative_to(&exact),
        }
    });
    Ok(rows.collect())
}

/// The navigator's errors at these times.
fn navigated(turn: &ConstantTurn, times: &[f64]) -> Result<Vec<Errors>, ReproductionError> {
    let duration = times.iter().copied().fold(0.0, f64::max);
    let motion = TrueMotion {
        station: turn.station,
        nav_from_table: turn.nav_from_table,
        profile: Profile::new(&[Segment { rate: turn.rate, duration }], None)?,
    };
    let sensors = SensorErrors::from(ERRORS);
    let start = turn.nav_from_body(0.0);
    let mut navigator = Navigator::at_rest(&turn.station, start, VerticalChannel::Held);
    let truth: NavState = *navigator.state();
    let mut samples = motion.samples(INTERVAL).peekable();
    let mut errors = Vec::with_capacity(times.len());
    for &time in times {
        while let Some(sample) = samples.next_if(|sample| sample.time < time + 0.5 * INTERVAL) {
            navigator.step(&sensors.measured(&sample.increments));
        }
        let truth = NavState { nav_from_body: turn.nav_from_body(time), ..truth };
        let NavErrors { velocity, attitude, .. } = NavErrors::between(navigator.state(), &truth);
        errors.push(Errors::of(&velocity, &attitude));
    }
    Ok(errors)
}

/// The navigator's velocity error along one axis over a turn of 36 s: time \[s\] and error \[m/s\].
pub(crate) fn over_a_turn(turn: &ConstantTurn, axis: usize) -> Vec<(f64, f64)> {
    let times: Vec<f64> = (1..=72).map(|step| 0.5 * f64::from(step)).collect();
    let errors = navigated(turn, &times).unwrap_or_default();
    times.into_iter().zip(errors).map(|(time, errors)| (time, errors.velocity[axis])).collect()
}

/// Attitude and velocity from the measured rate on a flat Earth without rotation:
/// Simpson's rule for `C~ f^b`, independent of the closed forms.
fn flat_integration(turn: &ConstantTurn, time: f64) -> Errors {
    let column = Vector3::new(ERRORS.misalignment_xz, ERRORS.misalignment_yz, ERRORS.scale_z);
    let measured = (Vector3::z() + column) * turn.rate;
    let reaction = Vector3::z() * turn.station.gravity;
    let steps = (time / INTERVAL).round();
    let interval = time / steps;
    let half_turn =
        *Dcm::<Body, Body>::from_rotation_vector(&(measured * (0.5 * interval))).matrix();
    let force = |c_nb: &Matrix3<f64>, time: f64| {
        let f_b = turn.nav_from_body(time).matrix().transpose() * reaction;
        c_nb * f_b
    };
    let mut c_nb = *turn.nav_from_body(0.0).matrix();
    let mut gain = Vector3::zeros();
    let mut step = 0.0;
    while step < steps {
        let now = step * interval;
        let middle = c_nb * half_turn;
        let end = middle * half_turn;
        let sum = force(&c_nb, now)
            + force(&middle, now + 0.5 * interval) * 4.0
            + force(&end, now + interval);
        gain += sum * (interval / 6.0) - reaction * interval;
        c_nb = end;
        step += 1.0;
    }
    let apart = c_nb * turn.nav_from_body(time).matrix().transpose();
    // The rotation vector of a small rotation from its antisymmetric part, whose length is its sine.
    let sine = Vector3::new(
        apart[(2, 1)] - apart[(1, 2)],
        apart[(0, 2)] - apart[(2, 0)],
        apart[(1, 0)] - apart[(0, 1)],
    ) * 0.5;
    let length = sine.norm();
    let attitude = if length > 0.0 { -sine * (length.asin() / length) } else { sine };
    Errors { velocity: Vector3::new(gain.x, gain.y, 0.0), attitude }
}
