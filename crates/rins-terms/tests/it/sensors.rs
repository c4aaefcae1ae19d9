//! What sensors read in cases that can be reckoned by hand.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, STANDARD_GRAVITY};
use rins_frames::{EulerAngles, Site};
use rins_motion::Station;
use rins_terms::{
    Acting, KinematicState, Model, SettingKind, Surroundings, TermInstance, catalogue, values,
};
use rins_testing::assert_close;

use crate::support::{INTERVAL, run};

/// A moment of a run, at 10 deg/s, with a force of (0.5, -0.2, 0.8) g and a temperature of 23 °C.
fn moment() -> KinematicState<'static> {
    let mut moment = run().track.moments().nth(1200).unwrap();
    moment.mean.rate = 10.0 * DEG_PER_SECOND;
    moment.rate = Vector3::new(0.0, 0.0, 10.0 * DEG_PER_SECOND);
    moment.force = Vector3::new(0.5, -0.2, 0.8) * STANDARD_GRAVITY;
    moment.mean.temperature = Some(23.0);
    moment.mean.warming_rate = 0.5 / 60.0;
    moment
}

/// What one parameter, given in its own unit, adds to the gyros \[deg/h\] and accelerometers \[µg\].
fn adds(id: &str, value: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (term, name) = id.rsplit_once('.').unwrap();
    let term = catalogue::term(term).unwrap();
    let mut chosen = TermInstance::new(term);
    let place = term.parameters.iter().position(|p| p.name == name).unwrap();
    chosen.values[place] = value * term.parameters[place].unit.factor;
    let signals = chosen.signals(&moment(), None);
    (values(&signals.gyro) / DEG_PER_HOUR, values(&signals.accel) / MICRO_G)
}

#[test]
fn gyros_read_by_name_and_unit() {
    // 10 deg/s is 36000 deg/h.
    let cases = [
        ("gyro.bias.y", 0.3, [0.0, 0.3, 0.0]),
        ("gyro.scale.z", 100.0, [0.0, 0.0, 3.6]),
        ("gyro_thermal_bias.x", 0.02, [0.06, 0.0, 0.0]),
        ("gyro_thermal_polynomial.linear_y", 0.02, [0.0, 0.06, 0.0]),
        ("gyro_thermal_polynomial.square_x", 0.02, [0.18, 0.0, 0.0]),
        ("gyro_thermal_polynomial.cube_z", 0.02, [0.0, 0.0, 0.54]),
        ("gyro_shupe.z", 2.0, [0.0, 0.0, 1.0]),
        ("gyro_rate_dependent_bias.square_y", 1e-4, [0.0, 0.01, 0.0]),
        ("gyro_rate_dependent_bias.linear_x", 1e-3, [0.01, 0.0, 0.0]),
        ("gyro_scale_asymmetry.z", 10.0, [0.0, 0.0, 0.36]),
        ("gyro_scale_nonlinearity.k2_z", 1.0, [0.0, 0.0, 0.36]),
        ("gyro_scale_nonlinearity.k3_z", 0.1, [0.0, 0.0, 0.36]),
        ("gyro_thermal_scale.z", 10.0, [0.0, 0.0, 1.08]),
        ("gyro_g_sensitivity.zx", 0.1, [0.0, 0.0, 0.05]),
        ("gyro_g_sensitivity.xy", 0.1, [-0.02, 0.0, 0.0]),
        ("gyro_g2_sensitivity.x_yz", 1.0, [-0.16, 0.0, 0.0]),
        ("gyro_g2_sensitivity.y_xx", 1.0, [0.0, 0.25, 0.0]),
        ("gyro_g2_sensitivity.z_zz", 1.0, [0.0, 0.0, 0.64]),
        ("gyro_g2_sensitivity.z_xz", 1.0, [0.0, 0.0, 0.4]),
    ];
    for (id, value, want) in cases {
        let (gyro, accel) = adds(id, value);
        for axis in 0..3 {
            assert_close!(gyro[axis], want[axis], 1e-12);
        }
        assert_eq!(accel, Vector3::zeros(), "{id}");
    }
}

/// What is even in the rate keeps its sign when the table turns back, what is odd changes it. At -10 deg/s, in deg/h.
#[test]
fn a_scale_error_is_odd_or_even_in_the_rate() {
    let cases = [
        ("gyro.scale", 2, 100e-6, -3.6),
        ("gyro_scale_asymmetry", 0, 10e-6, 0.36),
        ("gyro_scale_nonlinearity", 0, 1e-6 / DEG_PER_SECOND, -0.36),
        ("gyro_scale_nonlinearity", 1, 0.1e-6 / DEG_PER_SECOND.powi(2), -0.36),
    ];
    let mut back = moment();
    back.mean.rate = -back.mean.rate;
    back.rate = -back.rate;
    for (id, place, value, want) in cases {
        let mut chosen = TermInstance::new(catalogue::term(id).unwrap());
        chosen.values[place] = value;
        let gyro = values(&chosen.signals(&back, None).gyro) / DEG_PER_HOUR;
        assert_close!(gyro.z, want, 1e-9);
        assert_eq!((gyro.x, gyro.y), (0.0, 0.0), "{id}");
    }
}

#[test]
fn accelerometers_read_by_name_and_unit() {
    let cases = [
        ("accel.bias.z", 7.0, [0.0, 0.0, 7.0]),
        ("accel_scale.x", 100.0, [50.0, 0.0, 0.0]),
        ("accel_quadratic.y", 100.0, [0.0, 4.0, 0.0]),
        ("accel_cubic.y", 1000.0, [0.0, -8.0, 0.0]),
        ("accel_asymmetry.y", 10.0, [0.0, 2.0, 0.0]),
        ("accel_cross_coupling.xy", 100.0, [-10.0, 0.0, 0.0]),
        ("accel_cross_coupling.yz", 100.0, [0.0, -16.0, 0.0]),
        ("accel_cross_coupling.zx", 100.0, [0.0, 0.0, 40.0]),
        ("accel_thermal_bias.x", 5.0, [15.0, 0.0, 0.0]),
        ("accel_vibration_rectification.z", 9.0, [0.0, 0.0, 9.0]),
        ("wrong_gravity.gravity", 100.0, [50.0, -20.0, 80.0]),
    ];
    for (id, value, want) in cases {
        let (gyro, accel) = adds(id, value);
        for axis in 0..3 {
            assert_close!(accel[axis], want[axis], 1e-9);
        }
        assert_eq!(gyro, Vector3::zeros(), "{id}");
    }
}

#[test]
fn dead_zone_follows_the_lock_in_equation() {
    let mut moment = moment();
    moment.rate = Vector3::new(0.3, -0.5, 10.0) * DEG_PER_HOUR;
    let zone = TermInstance::new(&catalogue::GYRO_DEAD_ZONE).with_values(&[0.4 * DEG_PER_HOUR; 3]);
    let read = (values(&zone.signals(&moment, None).gyro) + moment.rate) / DEG_PER_HOUR;
    assert_close!(read.x, 0.0, 1e-15);
    assert_close!(read.y, -0.3, 1e-12); // √(0.5² - 0.4²)
    assert_close!(read.z, 10.0 - 0.008, 1e-5); // -0.4² / 20
}

/// 100 arcsec of misalignment see 17.45 deg/h of a table at 10 deg/s.
#[test]
fn dead_zone_is_about_the_gyros_own_axis_or_the_bodys() {
    let mut moment = moment();
    // Gyro x stands still about its own axis, though the body does not; y is the other way round.
    let seen = 100.0 * ARCSEC * 36_000.0;
    moment.rate = Vector3::new(0.1 - seen, 0.1, 36_000.0) * DEG_PER_HOUR;
    let misalignment = [0.0, 100.0, 0.0, 100.0, 0.0, 0.0].map(|arcsec| arcsec * ARCSEC);
    let misalignment = TermInstance::new(&catalogue::GYRO_MISALIGNMENT).with_values(&misalignment);
    let zone = TermInstance::new(&catalogue::GYRO_DEAD_ZONE).with_values(&[0.4 * DEG_PER_HOUR; 3]);
    let lost = |axes: f64, in_order: bool| {
        let mut terms =
            vec![misalignment.clone(), zone.clone().with_setting(SettingKind::RateAxes, axes)];
        if !in_order {
            terms.reverse();
        }
        let read = Model { terms }.signals(&moment);
        let without = Model { terms: vec![misalignment.clone()] }.signals(&moment);
        (values(&read.gyro) - values(&without.gyro)) / DEG_PER_HOUR
    };
    for in_order in [true, false] {
        let own = lost(0.0, in_order);
        assert_close!(own.x, -0.1, 1e-9);
        assert_close!(own.y, -0.16 / (2.0 * (seen + 0.1)), 1e-5); // d² / 2ω
        let of_body = lost(1.0, in_order);
        assert_close!(of_body.x, 0.16 / (2.0 * (seen - 0.1)), 1e-5);
        assert_close!(of_body.y, -0.1, 1e-9);
    }
}

#[test]
fn step_falls_within_a_sample_by_its_share() {
    let run = run();
    let step = TermInstance::new(&catalogue::GYRO_BIAS_STEP)
        .with_setting(SettingKind::Time, 50.0 + 0.25 * INTERVAL)
        .with_values(&[1.0, 0.0, 0.0]);
    let read: Vec<f64> =
        run.track.moments().map(|moment| values(&step.signals(&moment, None).gyro).x).collect();
    assert_close!(read[2499], 0.0, 1e-12);
    assert_close!(read[2500], 0.75, 1e-9);
    assert_close!(read[2501], 1.0, 1e-12);
    let lost = read.iter().sum::<f64>() * INTERVAL;
    let after = run.track.duration() - 50.0 - 0.25 * INTERVAL;
    assert_close!(lost, after, 1e-9);
}

#[test]
fn ramp_and_warm_up_go_with_time() {
    let run = run();
    let at = |chosen: &TermInstance, sample: usize| {
        let moment = run.track.moments().nth(sample).unwrap();
        values(&chosen.signals(&moment, None).gyro).z
    };
    let ramp = TermInstance::new(&catalogue::GYRO_BIAS_RAMP).with_values(&[0.0, 0.0, 2.0]);
    assert_close!(at(&ramp, 2000) - at(&ramp, 1000), 2.0 * 1000.0 * INTERVAL, 1e-9);
    let warm_up = TermInstance::new(&catalogue::GYRO_WARMUP)
        .with_setting(SettingKind::TimeConstant, 20.0)
        .with_values(&[0.0, 0.0, 1.0]);
    assert_close!(at(&warm_up, 3000) / at(&warm_up, 2000), (-1.0_f64).exp(), 1e-9);
    assert_close!(at(&warm_up, 0), 1.0, 1e-3);
}

#[test]
fn hysteresis_and_backlash_remember_the_last_change() {
    let run = run();
    let hysteresis = TermInstance::new(&catalogue::GYRO_HYSTERESIS).with_values(&[1.0]);
    let backlash = TermInstance::new(&catalogue::ENCODER_BACKLASH).with_values(&[1.0]);
    // Rates of 0, 10, -10, 20, -5 and 0 deg/s, of 20 s each.
    for (time, changed, sense) in [
        (10.0, 0.0, 0.0),
        (30.0, 1.0, 1.0),
        (50.0, -1.0, -1.0),
        (70.0, 1.0, 1.0),
        (115.0, 1.0, -1.0),
    ] {
        let moment = run.track.moments().find(|moment| moment.end.time > time).unwrap();
        assert_eq!(values(&hysteresis.signals(&moment, None).gyro).z, changed, "at {time} s");
        assert_eq!(backlash.signals(&moment, None).angle.re, sense, "at {time} s");
    }
}

/// A low-pass of first order, integrated over a rest, turns both ways and the ways between them.
#[test]
fn heat_from_one_side_lags_and_fades() {
    const LAG: f64 = 4.0;
    const PARTS: u32 = 100;
    let run = run();
    let heat = Model::default().with(
        TermInstance::new(&catalogue::THERMAL_ONE_PER_TURN)
            .with_setting(SettingKind::TimeConstant, LAG)
            .with_values(&[1.0, 0.0, 0.0, 1.0, 0.3, -0.4]),
    );
    let ends: Vec<usize> = (5..run.track.len()).step_by(5).collect();
    let pieces = run.track.thinned(&ends);
    let [fine, coarse] = [&run.track, &pieces].map(|track| Acting::present(&heat, track));
    let mut coarse_moments = pieces.moments();
    let mut warmth = Vector3::new(1.0, 0.0, 0.3);
    let [mut unsettled, mut least] = [0.0, f64::INFINITY];
    for (sample, moment) in run.track.moments().enumerate() {
        let mut middle = warmth;
        for part in 0..PARTS {
            if part == PARTS / 2 {
                middle = warmth;
            }
            let from_middle = (f64::from(part) + 0.5) / f64::from(PARTS) - 0.5;
            let angle = moment.mean.angle + moment.mean.rate * INTERVAL * from_middle;
            let (sin, cos) = angle.sin_cos();
            let sources = Vector3::new(cos, sin, 0.3 * cos - 0.4 * sin);
            warmth += (sources - warmth) * (INTERVAL / f64::from(PARTS) / LAG);
        }
        let got = values(&Acting::together(&fine, &moment).gyro);
        // Euler's method, over 0.2 ms.
        assert!((got - middle).norm() < 2e-4, "at {} s: {got} {middle}", moment.end.time);
        let settled = values(&heat.signals(&moment).gyro);
        unsettled = f64::max(unsettled, (settled - middle).norm());
        least = least.min(got.norm());
        if sample % 5 == 2 {
            let Some(piece) = coarse_moments.advance() else { continue };
            let got = values(&Acting::together(&coarse, piece).gyro);
            assert!((got - middle).norm() < 2e-3, "at {} s: {got} {middle}", moment.end.time);
        }
    }
    assert!(unsettled > 0.5, "after a rest and a reversal it has far to go: {unsettled}");
    assert!(least < 0.8, "it fades: {least}");
}

/// At a constant rate, what a low-pass of first order leaves is late by `atan ωτ` and its cosine high.
#[test]
fn heat_from_one_side_settles() {
    const LAG: f64 = 4.0;
    let moment = moment();
    let heat = TermInstance::new(&catalogue::THERMAL_ONE_PER_TURN)
        .with_setting(SettingKind::TimeConstant, LAG)
        .with_values(&[1.0, 0.0, 0.0, 1.0, 0.3, -0.4]);
    let got = values(&heat.signals(&moment, None).gyro);
    let late = (moment.mean.rate * LAG).atan();
    let (sin, cos) = (moment.mean.angle - late).sin_cos();
    let want = Vector3::new(cos, sin, 0.3 * cos - 0.4 * sin) * late.cos();
    assert!(late > 30.0 * DEG, "it lags: {late}");
    assert!((got - want).norm() < 1e-12, "{got} {want}");
}

#[test]
fn wrong_latitude_is_the_earths_rate_there_less_that_here() {
    let site = |latitude| Site { latitude, longitude: 0.0, height: 0.0 };
    let attitude = EulerAngles { roll: 0.4, pitch: -0.3, yaw: 2.0 };
    let around = |latitude: f64| {
        Surroundings::new(Station::with_normal_gravity(site(latitude)), attitude.dcm())
    };
    let (here, there) = (around(34.0 * DEG), around(34.7 * DEG));
    let mut moment = moment();
    moment.surroundings = here;
    let wrong = TermInstance::new(&catalogue::WRONG_LATITUDE).with_values(&[0.7 * DEG]);
    let got = values(&wrong.signals(&moment, None).gyro);
    let want = moment.in_body(&(there.earth_rate - here.earth_rate));
    assert!((got - want).norm() < 1e-12 * want.norm());
    assert!(want.norm() > 0.1 * DEG_PER_HOUR);
}

/// The field of a dipole dips by `atan(2 tan L)` below the horizon in the north and rises above it in the south; it is twice
/// as strong at a pole as at the equator.
#[test]
fn the_magnetic_field_points_north_and_dips_with_the_latitude() {
    const WITHIN: f64 = 1e-12;
    let field = |latitude: f64| {
        let site = Site { latitude, longitude: 0.0, height: 0.0 };
        let level = EulerAngles { roll: 0.0, pitch: 0.0, yaw: 0.0 };
        Surroundings::new(Station::with_normal_gravity(site), level.dcm()).magnetic_field
    };
    let at_the_equator = field(0.0);
    assert!(at_the_equator.y > 2e-5, "it points north: {at_the_equator}");
    for latitude in [-60.0, -34.0, 0.0, 34.0, 60.0].map(|latitude| latitude * DEG) {
        let field = field(latitude);
        let dip = (-field.z).atan2(field.y);
        assert_close!(field.x, 0.0, 1e-20);
        assert_close!(dip, (2.0 * latitude.tan()).atan(), WITHIN);
    }
    assert_close!(field(90.0 * DEG).norm() / at_the_equator.norm(), 2.0, WITHIN);
}

#[test]
fn magnetic_field_stays_with_the_table() {
    let gauss = 1e-4;
    let mut moment = moment();
    moment.surroundings.magnetic_field = Vector3::new(0.2, 0.0, 0.5) * gauss;
    let mut values_of_k = [0.0; 9];
    // What gyro x shows of a field along y, 1 deg/h/G.
    values_of_k[1] = DEG_PER_HOUR / gauss;
    let magnetic = TermInstance::new(&catalogue::GYRO_MAGNETIC).with_values(&values_of_k);
    for (angle, want) in [(0.0, 0.0), (FRAC_PI_2, -0.2), (PI, 0.0), (-FRAC_PI_2, 0.2)] {
        moment.mean.angle = angle;
        let read = values(&magnetic.signals(&moment, None).gyro) / DEG_PER_HOUR;
        assert_close!(read.x, want, 1e-12);
        assert_eq!((read.y, read.z), (0.0, 0.0));
    }
}

#[test]
fn encoder_reads_its_harmonics_by_cosine_and_sine() {
    let mut moment = moment();
    let eccentric = TermInstance::new(&catalogue::ENCODER_ECCENTRICITY).with_values(&[3.0, 4.0]);
    let oval = TermInstance::new(&catalogue::ENCODER_HARMONIC)
        .with_setting(SettingKind::Order, 3.0)
        .with_values(&[1.0, 2.0]);
    for (angle, one, three) in [(0.0, 3.0, 1.0), (FRAC_PI_2, 4.0, -2.0), (PI, -3.0, -1.0)] {
        moment.end.angle = angle;
        assert_close!(eccentric.signals(&moment, None).angle.re, one, 1e-12);
        assert_close!(oval.signals(&moment, None).angle.re, three, 1e-12);
    }
}
