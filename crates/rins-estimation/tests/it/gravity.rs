//! Without an encoder, gravity in the plane of rotation is the angle's reference.

use rins_estimation::{
    NoiseKnowledge, Reference, Rig, Run, Strengths, axis_from_gravity, fit, turning_span,
};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::{Axis, ImuError, ImuSpec, TriadError, TriadSpec};
use rins_motion::Recording;
use rins_simulation::{TableRecord, simulate};
use rins_terms::{Chosen, Model, Role, catalogue};
use rins_testing::assert_close;

use crate::support::{profile, scenario, tilted, white};

/// A micromechanical unit.
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
    let effects = Model::default().with(Chosen::new(arm).with_values(&[43e-3, -20e-3]));
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
    let mut model = Model::full().with(Chosen::new(arm).estimated());
    for axis in ["x", "y"] {
        model = model.with_role(&format!("accel_lever_arm.r_{axis}"), Role::Within(0.5));
        model = model.with_role(&format!("axis.attitude.{axis}"), Role::Within(0.05));
    }
    model = model.with_role("axis.attitude.z", Role::Within(0.1));
    let imu = mems();
    let strengths = Strengths::of(&imu);
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

/// How far a table has turned where such a run begins nobody knows: its yaw is another one than the surveyed.
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

#[test]
fn what_does_not_turn_has_no_axis() {
    let recording = wheel(6).slice(0, 100);
    assert_eq!(turning_span(&recording), None);
    assert_eq!(axis_from_gravity(&recording, None), None);
}
