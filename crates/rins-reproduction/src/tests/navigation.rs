//! Table 4: the model's figures against those of an independent model, and the lag in the printed ones.

use crate::causes::{Cause, velocity_explanations};
use crate::experiment::{Experiment, Sensors};
use crate::printed;
use crate::pure_navigation::{Outcome, PureNavigation};
use crate::readout::{Disagreement, Pair, Turning};
use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG, PPM};
use rins_imu::{Axis, ImuError, TriadError};
use rins_testing::assert_close;

fn noiseless(sensors: Sensors) -> PureNavigation {
    let simulation = Experiment::simulation().expect("the scenario file is right");
    PureNavigation::of(&simulation.with(sensors).scenario).noiseless()
}

fn table_3() -> ImuError {
    let [m_xz, m_yz, s_z] = printed::TABLE_3;
    let gyro = TriadError::default()
        .with_misalignment(Axis::X, Axis::Z, m_xz * ARCSEC)
        .with_misalignment(Axis::Y, Axis::Z, m_yz * ARCSEC)
        .with_scale(Axis::Z, s_z * PPM);
    ImuError { gyro, ..ImuError::default() }
}

/// The figures of an independent model, which are given with three decimals of a meter per second; it
/// integrates to first order, which causes an error of 0.004 m/s in the east velocity.
#[test]
fn velocities_and_attitudes_are_those_of_an_independent_model() {
    let three = noiseless(Sensors::SpinAxis).outcome().unwrap();
    assert_close!(three.velocity[0], 2.970, 0.001);
    assert_close!(three.velocity[1], -17.431, 0.003);
    let attitude = three.attitude;
    assert_close!(attitude.roll, -0.3327 * DEG, 1e-4 * DEG);
    assert_close!(attitude.pitch, 0.5120 * DEG, 1e-4 * DEG);
    assert_close!(attitude.yaw, 0.9985 * DEG, 1e-4 * DEG);
    let all = noiseless(Sensors::All).outcome().unwrap();
    assert_close!(all.velocity[0], 3.18, 0.01);
    assert_close!(all.velocity[1], -17.48, 0.005);
}

#[test]
fn half_a_sample_of_lag_explains_six_attitudes() {
    let turning = Turning {
        reference: Experiment::simulation().unwrap().scenario.nav_from_table.euler_angles(),
        rate: 10.0 * DEG,
    };
    let gyros = noiseless(Sensors::Gyros);
    let pairs = [
        Pair { model: gyros.outcome().unwrap(), printed: printed::TABLE_4_BEFORE.attitude_error },
        Pair {
            model: gyros.compensating(table_3()).outcome().unwrap(),
            printed: printed::TABLE_4_AFTER.attitude_error,
        },
    ];
    assert!(Disagreement::of(&pairs, &turning, 0.0).root_mean_square() > 0.06);
    assert!(Disagreement::of(&pairs, &turning, 0.01).largest() < 0.003);
    // A lag of a whole sample does not fit, nor does half a sample with the other sign.
    assert!(Disagreement::of(&pairs, &turning, 0.02).largest() > 0.05);
    assert!(Disagreement::of(&pairs, &turning, -0.01).largest() > 0.1);
    assert_close!(Disagreement::least(&pairs, &turning).lag, 0.01, 0.0005);
    for pair in pairs {
        let rotation: Vector3<f64> = pair.rotation(&turning.reference);
        assert_close!(rotation.z, -0.1, 0.005);
        assert!(rotation.xy().norm() < 0.005, "{rotation}");
    }
}

#[test]
fn a_cause_put_in_is_found_at_its_size() {
    let base = noiseless(Sensors::Gyros);
    let mut changed = base.clone();
    changed.scenario.imu_error.gyro.bias.z += 0.03 * DEG / 3600.0;
    let (Outcome { velocity: was, .. }, Outcome { velocity: is, .. }) =
        (base.outcome().unwrap(), changed.outcome().unwrap());
    let causes =
        [Cause::GyroBiasChange(2), Cause::GyroBiasChange(0), Cause::Start(0), Cause::Latitude];
    let misfit = [is[0] - was[0], is[1] - was[1]];
    let found = velocity_explanations(&causes, &base, misfit).unwrap();
    assert_eq!(found[0].cause, Cause::GyroBiasChange(2));
    assert_close!(found[0].size, 0.03, 1e-5);
    assert!(found[0].left < 1e-3, "{found:?}");
    assert!(found[1].left > 0.05, "{found:?}");
}
