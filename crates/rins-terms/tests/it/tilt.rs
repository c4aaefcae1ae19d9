//! What is felt on a table that tilts, against attitudes that are differenced and forces that are summed.

use nalgebra::{UnitQuaternion, Vector3};
use rins_frames::units::{ARCSEC, DEG_PER_SECOND};
use rins_frames::{Body, Dcm, EARTH_RATE};
use rins_motion::Segment;
use rins_terms::{MeasurementModel, Model, SettingKind, TermInstance, catalogue, values};
use rins_testing::assert_close;

use crate::support::{INTERVAL, Run, run, turning};

/// A wobble against the table's sense, on a base that goes over.
const WOBBLE: (f64, f64) = (4e-3, -3e-3);
const RAMP: (f64, f64) = (2e-4, -1e-4);

fn steady() -> Run {
    turning(&[Segment { rate: 10.0 * DEG_PER_SECOND, duration: 60.0 }])
}

/// The attitude of the body in inertial space, which is the n-frame when the run starts.
fn attitude(run: &Run, time: f64) -> UnitQuaternion<f64> {
    let angle = run.motion.profile.angle(time);
    let wobble =
        nalgebra::Complex::new(WOBBLE.0, WOBBLE.1) * nalgebra::Complex::new(0.0, -angle).exp();
    let tilt = Vector3::new(wobble.re + RAMP.0 * time, wobble.im + RAMP.1 * time, 0.0);
    let pole = nalgebra::Unit::new_normalize(*run.motion.station.site.earth_rate().components());
    let fixed = nalgebra::Rotation3::from_matrix_unchecked(*run.motion.nav_from_table.matrix());
    UnitQuaternion::from_axis_angle(&pole, EARTH_RATE * time)
        * UnitQuaternion::from_rotation_matrix(&fixed)
        * UnitQuaternion::from_scaled_axis(tilt)
        * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle)
}

#[test]
fn tilting_table_is_felt_as_differenced_attitudes_are() {
    const PARTS: u32 = 50;
    let run = steady();
    let model = Model::default()
        .with(TermInstance::new(&catalogue::TABLE_WOBBLE).with_values(&[WOBBLE.0, WOBBLE.1]))
        .with(TermInstance::new(&catalogue::BASE_TILT_RAMP).with_values(&[RAMP.0, RAMP.1]));
    let mut making = MeasurementModel::new(&model, &run.track);
    let pole = nalgebra::Unit::new_normalize(*run.motion.station.site.earth_rate().components());
    for (moment, truth) in run.track.moments().zip(&run.recording.increments) {
        let reading = making.read(&moment, truth);
        let (from, to) = (moment.end.time - INTERVAL, moment.end.time);
        let turned = (attitude(&run, from).inverse() * attitude(&run, to)).scaled_axis();
        let mut velocity = Vector3::zeros();
        for part in 0..PARTS {
            let time = from + INTERVAL * (f64::from(part) + 0.5) / f64::from(PARTS);
            let up = UnitQuaternion::from_axis_angle(&pole, EARTH_RATE * time) * Vector3::z();
            let felt = attitude(&run, time).inverse() * up * run.motion.station.gravity;
            velocity += felt * INTERVAL / f64::from(PARTS);
        }
        let angle_error = (reading.increments.angle.components() - turned).norm();
        let velocity_error = (reading.increments.velocity.components() - velocity).norm();
        // The tilt itself is 2e-5 rad and 1e-3 m/s a sample; its third order is left out.
        assert!(angle_error < 2e-9, "{angle_error:e} at {to} s");
        assert!(velocity_error < 2e-7, "{velocity_error:e} at {to} s");
        assert!((reading.increments.angle - truth.angle).norm() > 1e-6);
        assert_eq!(reading.angle_error, 0.0);
    }
}

#[test]
fn wobble_of_order_one_is_the_mounting() {
    let wobble = TermInstance::new(&catalogue::TABLE_WOBBLE)
        .with_setting(SettingKind::Order, 1.0)
        .with_values(&[30.0 * ARCSEC, -20.0 * ARCSEC]);
    let mounting =
        TermInstance::new(&catalogue::MOUNTING).with_values(&[30.0 * ARCSEC, -20.0 * ARCSEC]);
    let run = run();
    for moment in run.track.moments().step_by(41) {
        assert_eq!(wobble.signals(&moment, None), mounting.signals(&moment, None));
    }
    // And the mounting is a fixed rotation of the body.
    let model = Model::default().with(mounting);
    let mut making = MeasurementModel::new(&model, &run.track);
    let body = Vector3::new(30.0 * ARCSEC, -20.0 * ARCSEC, 0.0);
    let mounted = Dcm::<Body, Body>::from_rotation_vector(&body).inverse();
    for (moment, truth) in run.track.moments().zip(&run.recording.increments) {
        let felt = making.read(&moment, truth).increments;
        // Its effect is 2e-4 of 7e-3 rad and of 0.2 m/s; ramps are integrated to second order.
        assert!((felt.angle - mounted * truth.angle).norm() < 1e-10);
        assert!((felt.velocity - mounted * truth.velocity).norm() < 1e-9);
    }
}

#[test]
fn rate_ripple_is_felt_and_read_alike() {
    let ripple = TermInstance::new(&catalogue::TABLE_RATE_RIPPLE).with_values(&[1e-3, 5e-4]);
    let model = Model::default().with(ripple);
    let run = run();
    let mut making = MeasurementModel::new(&model, &run.track);
    let opening = model.signals(&run.track.opening().unwrap());
    let (mut turned, mut largest) = (opening.angle.re, 0.0_f64);
    for (moment, truth) in run.track.moments().zip(&run.recording.increments) {
        let reading = making.read(&moment, truth);
        turned += (reading.increments.angle - truth.angle).components().z;
        // Transverse Earth rate turns with the ripple; z sees the ripple alone.
        assert_close!(turned, reading.angle_error, 1e-12);
        largest = largest.max(reading.angle_error.abs());
    }
    assert!(largest > 5e-5, "it is a tenth of a thousandth of a radian");
}

/// A tilt step with a duration of one second is linear in time: half of it at its time, and none before or after.
#[test]
fn a_base_gives_way_evenly_over_its_time() {
    const TIME: f64 = 30.0;
    const DURATION: f64 = 1.0;
    let step = TermInstance::new(&catalogue::BASE_TILT_STEP)
        .with_setting(SettingKind::Time, TIME)
        .with_setting(SettingKind::Duration, DURATION)
        .with_values(&[1.0, -2.0, 0.5]);
    for moment in steady().track.moments() {
        let since_start = moment.end.time - (TIME - 0.5 * DURATION);
        let part = (since_start / DURATION).clamp(0.0, 1.0);
        let tilt = values(&step.signals(&moment, None).tilt);
        for (axis, all) in [1.0, -2.0, 0.5].into_iter().enumerate() {
            assert_close!(tilt[axis], all * part, 1e-9);
        }
    }
}

#[test]
fn turning_base_adds_to_the_earths_rate_about_the_vertical() {
    let rate = 1e-5;
    let model =
        Model::default().with(TermInstance::new(&catalogue::BASE_ROTATION).with_values(&[rate]));
    let run = steady();
    let mut making = MeasurementModel::new(&model, &run.track);
    for (moment, truth) in run.track.moments().zip(&run.recording.increments) {
        let felt = making.read(&moment, truth).increments;
        let up = truth.velocity * (1.0 / truth.velocity.norm());
        // Up does not change; the Earth's rate, seen from a base that has turned by 6e-4, by 4e-8 rad/s.
        assert!((felt.velocity - truth.velocity).norm() < 1e-10);
        assert!((felt.angle - truth.angle - up * (rate * INTERVAL)).norm() < 1e-9);
        assert!((felt.angle - truth.angle).norm() > 1e-7);
    }
}
