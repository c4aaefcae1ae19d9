//! Without an encoder, gravity in the plane of rotation is the reference of the angle.

use nalgebra::Vector3;
use rins_estimation::{
    NoiseKnowledge, NoiseParameters, Reference, Rig, Run, axis_from_gravity, fit, turning_span,
};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_frames::{InFrame, Increments};
use rins_imu::{Axis, ImuError, ImuSpec, TriadError, TriadSpec};
use rins_motion::Recording;
use rins_simulation::{TableRecord, simulate};
use rins_terms::{Model, Role, TermInstance, catalogue};
use rins_testing::assert_close;

use crate::support::{profile, scenario, tilted, white};

/// The data sheet of a MEMS unit.
fn mems() -> ImuSpec {
    let triad = |noise, bias| TriadSpec::white(noise, bias, 5000.0 * PPM, 3000.0 * ARCSEC);
    ImuSpec {
        gyro: triad(20.0 * DEG_PER_HOUR, 500.0 * DEG_PER_HOUR),
        accel: triad(150.0 * MICRO_G, 5000.0 * MICRO_G),
    }
}

fn wheel(seed: u64) -> Recording {
    let imu = mems();
    let error = ImuError {
        gyro: TriadError::default().with_scale(Axis::Z, 4000.0 * PPM),
        accel: TriadError::default().with_bias(Axis::X, 3000.0 * MICRO_G),
    };
    let arm = catalogue::term("accel_lever_arm").unwrap();
    let effects = Model::default().with(TermInstance::new(arm).with_values(&[43e-3, -20e-3]));
    let turns = profile(&[(0.0, 5.0), (60.0, 25.0), (150.0, 40.0), (-90.0, 70.0), (0.0, 24.0)]);
    let scenario = scenario(tilted(85.0, 20.0), turns, (error, effects), Some(white(&imu)), seed);
    simulate(&rins_simulation::Scenario { table: TableRecord::Nothing, ..scenario })
        .unwrap()
        .recording
}

#[test]
fn a_wheel_shows_its_lever_arm_and_the_scale_of_its_gyro() {
    let recording = wheel(5);
    let span = turning_span(&recording).unwrap();
    let (first, last) = (recording.times[span.start], recording.times[span.end - 1]);
    assert!(
        (5.0..20.0).contains(&first) && (85.0..100.0).contains(&last),
        "turns from {first} to {last} s"
    );
    let recording = recording.slice(span.start, span.end);
    let surveyed = tilted(85.0, 20.0).euler_angles();
    let nav_from_table = axis_from_gravity(&recording, Some(surveyed)).unwrap().nav_from_table;
    let up = nav_from_table.matrix()[(2, 2)];
    assert!(
        (up.acos() - 85.0 * DEG).abs() < 0.5 * DEG,
        "the axis is {} deg off the vertical",
        up.acos() / DEG
    );
    let rig = Rig {
        station: crate::support::station(),
        nav_from_table,
        reference: Reference::Gravity,
        wobble: 1.0 * ARCSEC,
        velocity: 1e-6,
    };
    let arm = catalogue::term("accel_lever_arm").unwrap();
    let mut model = Model::full().with(TermInstance::new(arm).estimated());
    for axis in ["x", "y"] {
        model = model.with_role(&format!("accel_lever_arm.r_{axis}"), Role::Within(0.5));
        model = model.with_role(&format!("axis.attitude.{axis}"), Role::Within(0.05));
    }
    model = model.with_role("axis.attitude.z", Role::Within(0.1));
    let imu = mems();
    let strengths = NoiseParameters::of(&imu);
    let run = Run::new(rig, recording).unwrap();
    let fit = fit(&[run], &model, &imu, NoiseKnowledge::Given(strengths), |_| ()).unwrap();
    for (id, truth, within) in [
        ("accel_lever_arm.r_x", 43e-3, 1e-3),
        ("accel_lever_arm.r_y", -20e-3, 1e-3),
        ("gyro.scale.z", 4000.0 * PPM, 300.0 * PPM),
    ] {
        let found = fit.parameter(id).unwrap();
        let off = (found.value - truth) / found.sigma;
        assert!(off.abs() < 4.0, "{id}: {off} sigma off, {found:?}");
        assert!(found.sigma < within, "{id}: sigma {}", found.sigma);
    }
}

/// The table angle at the start of such a run is unknown: its yaw differs from the surveyed one.
#[test]
fn an_axis_that_leans_as_it_was_surveyed_heads_where_it_was() {
    let recording = wheel(7);
    let recording = recording.slice(turning_span(&recording).unwrap().start + 777, recording.len());
    let shown = |surveyed| axis_from_gravity(&recording, surveyed).unwrap();
    let surveyed = tilted(85.0, 20.0);
    let seen = shown(Some(surveyed.euler_angles()));
    assert!(seen.heading_known);
    let off = seen.nav_from_table.matrix().column(2) - surveyed.matrix().column(2);
    assert!(off.norm() < 0.5 * DEG, "{off}");
    // A survey of another axis.
    let other = shown(Some(tilted(60.0, 20.0).euler_angles()));
    for (seen, yaw) in [(other, 20.0 * DEG), (shown(None), 0.0)] {
        assert!(!seen.heading_known);
        assert_close!(seen.nav_from_table.euler_angles().yaw, yaw, 1e-12);
    }
}

/// A wheel that is pushed and braked by hand, with its sensor far off the axis: simulated accelerations by w² and by w' do
/// not change the estimated axis.
#[test]
fn a_wheel_that_changes_its_rate_shows_its_axis_past_its_lever_arm() {
    const INTERVAL: f64 = 0.002;
    const SAMPLES: u32 = 20_000;
    // Means over a sample equal the values at its middle up to (w T)²/24, and so do differences of rates.
    const WITHIN: f64 = 2e-4;
    let up = Vector3::new(0.5, -0.3, (1.0 - 0.34_f64).sqrt());
    let [arm_x, arm_y] = [0.4, -0.25];
    let (mean, swing, frequency) = (2.0, 1.2, 2.0);
    let angle = |time: f64| mean * time - swing / frequency * ((frequency * time).cos() - 1.0);
    let sample = |index: u32| {
        let (from, to) = (f64::from(index) * INTERVAL, f64::from(index + 1) * INTERVAL);
        let middle = f64::midpoint(from, to);
        let rate = mean + swing * (frequency * middle).sin();
        let acceleration = swing * frequency * (frequency * middle).cos();
        let (sin, cos) = angle(middle).sin_cos();
        let gravity = up * 9.8;
        let force = Vector3::new(
            cos * gravity.x + sin * gravity.y - rate * rate * arm_x - acceleration * arm_y,
            cos * gravity.y - sin * gravity.x - rate * rate * arm_y + acceleration * arm_x,
            gravity.z,
        );
        Increments {
            angle: InFrame::new(0.0, 0.0, angle(to) - angle(from)),
            velocity: InFrame::from_components(force * INTERVAL),
            interval: INTERVAL,
        }
    };
    let recording = Recording {
        times: (1..=SAMPLES).map(|index| f64::from(index) * INTERVAL).collect(),
        increments: (0..SAMPLES).map(sample).collect(),
        table_angle: None,
        table_rate: None,
        temperature: None,
    };
    let seen = axis_from_gravity(&recording, None).unwrap().nav_from_table;
    // The third row of C_s^n is up in axes of the table.
    let shown = seen.matrix().row(2).transpose();
    assert!((shown - up).norm() < WITHIN, "{shown} for {up}");
}

#[test]
fn what_does_not_turn_has_no_axis() {
    let recording = wheel(6).slice(0, 100);
    assert_eq!(turning_span(&recording), None);
    assert_eq!(axis_from_gravity(&recording, None), None);
}
