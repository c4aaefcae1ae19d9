//! Runs at several tilts make parameters observable that one does not, and each has its own parameters.

use rins_estimation::{Fit, NoiseKnowledge, NoiseParameters, Run, fit};
use rins_frames::units::{DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::{Axis, ImuError, TriadError};
use rins_terms::{Model, Owner};

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// An IMU after a power cycle: constant scale errors, and a bias of gyro x of this power cycle.
fn turn_on(bias: f64) -> ImuError {
    ImuError {
        gyro: TriadError::default()
            .with_scale(Axis::Z, 150.0 * PPM)
            .with_bias(Axis::X, bias * DEG_PER_HOUR),
        accel: TriadError::default()
            .with_scale(Axis::X, 80.0 * PPM)
            .with_scale(Axis::Y, -60.0 * PPM)
            .with_bias(Axis::Z, 100.0 * MICRO_G),
    }
}

fn at(tilt: f64, bias: f64, seed: u64) -> Run {
    let turns = profile(&[(0.0, 20.0), (10.0, 60.0), (-10.0, 60.0)]);
    let truth = (turn_on(bias), Model::default());
    run(&scenario(tilted(tilt, 30.0), turns, truth, Some(white(&fibre())), seed))
}

fn fitted(runs: &[Run]) -> Fit {
    let imu = fibre();
    fit(runs, &Model::full(), &imu, NoiseKnowledge::Given(NoiseParameters::of(&imu)), |_| ())
        .unwrap()
}

#[test]
fn sensors_are_shared_and_turn_ons_are_not() {
    let fit = fitted(&[at(25.0, 0.08, 1), at(65.0, -0.05, 2)]);
    let shared = fit.parameters.iter().filter(|p| p.run.is_none()).count();
    let own = fit.parameters.iter().filter(|p| p.run == Some(1)).count();
    assert_eq!((shared, own), (18, 9));
    assert!(fit.parameters.iter().all(|p| p.run.is_none() == (p.parameter.owner == Owner::Sensor)));
    for (run, bias) in [(0, 0.08), (1, -0.05)] {
        let of_run =
            |p: &&rins_estimation::Estimate| p.parameter.id == "gyro.bias.x" && p.run == Some(run);
        let found = fit.parameters.iter().find(of_run).unwrap();
        let off = (found.value - bias * DEG_PER_HOUR) / found.sigma;
        assert!(off.abs() < 4.0 && found.sigma < 0.01 * DEG_PER_HOUR, "run {run}: {off} sigma");
        assert!((fit.models[run].value("gyro.bias.x").unwrap() - found.value).abs() < 1e-18);
    }
}

#[test]
fn a_second_tilt_tells_accelerometer_scales_from_the_attitude() {
    let one = fitted(&[at(25.0, 0.08, 1)]);
    let two = fitted(&[at(25.0, 0.08, 1), at(65.0, -0.05, 2)]);
    for (id, truth) in [("accel.scale.x", 80.0 * PPM), ("accel.scale.y", -60.0 * PPM)] {
        let (alone, together) = (one.parameter(id).unwrap(), two.parameter(id).unwrap());
        assert!(alone.sigma > 2.0 * together.sigma, "{id}: {} {}", alone.sigma, together.sigma);
        assert!((together.value - truth).abs() < 4.0 * together.sigma, "{id}: {together:?}");
    }
}
