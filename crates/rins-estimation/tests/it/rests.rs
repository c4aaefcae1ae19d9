//! Many static runs of one IMU without a power cycle: gravity in many attitudes determines the accelerometers' errors.

use rins_estimation::{Fit, NoiseKnowledge, NoiseParameters, Observable, Reference, Run, fit};
use rins_frames::units::{DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_frames::{Dcm, EulerAngles, InFrame, Table};
use rins_imu::{Axis, ImuError, ImuSpec, TriadError, TriadSpec};
use rins_terms::{Model, Owner, Role};

use crate::support::{fibre, profile, run, scenario, white};

/// The 1σ of an unknown attitude \[rad\].
pub(crate) const ANY: f64 = 1.8;

/// The data sheet of a handheld IMU, with this noise density of the gyros \[rad/s/√Hz\] and 1σ of the scale errors.
pub(crate) fn handheld(gyro_noise: f64, scale_sigma: f64) -> ImuSpec {
    let fibre = fibre();
    let triad = |sheet: TriadSpec, noise_density, bias_sigma| TriadSpec {
        noise_density,
        bias_sigma,
        scale_sigma,
        misalignment_sigma: 0.2 * DEG,
        ..sheet
    };
    ImuSpec {
        gyro: triad(fibre.gyro, gyro_noise, 300.0 * DEG_PER_HOUR),
        accel: triad(fibre.accel, 100.0 * MICRO_G, 3000.0 * MICRO_G),
    }
}

fn consumer() -> ImuSpec {
    handheld(50.0 * DEG_PER_HOUR, 3000.0 * PPM)
}

/// Its true errors after it was switched on.
fn truth(bias: f64) -> ImuError {
    let mut accel = TriadError::default()
        .with_scale(Axis::X, 1500.0 * PPM)
        .with_scale(Axis::Y, -2500.0 * PPM)
        .with_scale(Axis::Z, 800.0 * PPM)
        .with_bias(Axis::X, bias * MICRO_G)
        .with_bias(Axis::Z, -1200.0 * MICRO_G);
    accel.matrix[(0, 1)] = 2000.0 * PPM;
    accel.matrix[(2, 0)] = -1500.0 * PPM;
    accel.matrix[(1, 2)] = 900.0 * PPM;
    let gyro = TriadError::default().with_bias(Axis::Y, 250.0 * DEG_PER_HOUR);
    ImuError { gyro, accel }
}

/// The attitudes, roll and pitch \[deg\].
const LAID: [(f64, f64); 14] = [
    (0.0, 0.0),
    (90.0, 3.0),
    (-88.0, 0.0),
    (179.0, -4.0),
    (2.0, 85.0),
    (-5.0, -86.0),
    (45.0, 10.0),
    (-40.0, -12.0),
    (130.0, 35.0),
    (-130.0, -38.0),
    (50.0, -47.0),
    (-55.0, 44.0),
    (10.0, 50.0),
    (170.0, -45.0),
];

/// Static runs of ten seconds; the assumed attitude of each is wrong by half a degree, and its azimuth is unknown.
fn rests(bias: f64, turn_on: usize) -> Vec<Run> {
    let imu = consumer();
    let rest = |(place, &(roll, pitch)): (usize, &(f64, f64))| {
        let standing = |yaw: f64| EulerAngles { roll: roll * DEG, pitch: pitch * DEG, yaw }.dcm();
        let azimuth = (37.0 * place as f64 + 100.0 * turn_on as f64).sin() * 3.0;
        let seed = 100 * turn_on as u64 + place as u64;
        let still = profile(&[(0.0, 10.0)]);
        let effects = (truth(bias), Model::default());
        let mut run = run(&scenario(standing(azimuth), still, effects, Some(white(&imu)), seed));
        let off = InFrame::<Table>::new(8e-3, -5e-3, 3e-3);
        run.rig.nav_from_table =
            standing(0.0) * Dcm::<Table, Table>::from_rotation_vector(off.components());
        run.rig.reference = Reference::Rest;
        run.since(turn_on)
    };
    LAID.iter().enumerate().map(rest).collect()
}

fn fitted(runs: &[Run]) -> Fit {
    let imu = consumer();
    let model = ["x", "y", "z"].iter().fold(Model::full(), |model, axis| {
        model.with_role(&format!("axis.attitude.{axis}"), Role::Within(ANY))
    });
    fit(runs, &model, &imu, NoiseKnowledge::Likely(NoiseParameters::of(&imu)), |_| ())
        .unwrap()
        .marginal(|estimate| estimate.parameter.owner != Owner::Placement)
}

#[test]
fn gravity_in_many_attitudes_tells_the_accelerometers() {
    let fit = fitted(&rests(2000.0, 0));
    let identifiability = fit.identifiability();
    let accel = truth(2000.0).accel;
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (id, truth) in [("bias", accel.bias[axis]), ("scale", accel.matrix[(axis, axis)])] {
            let estimate = fit.parameter(&format!("accel.{id}.{name}")).unwrap();
            let off = (estimate.value - truth) / estimate.sigma;
            assert!(off.abs() < 4.0, "{id} {name} is off by {off} sigma");
            assert!(20.0 * estimate.sigma < estimate.parameter.sigma, "{estimate:?}");
            assert!(
                identifiability.parameters[identifiability.find(&estimate.parameter.id).unwrap()]
                    .identifiable
            );
        }
    }
    // The direction of the body axes is unobservable: of the misalignments of two axes only a combination is observable.
    for (one, other, place) in [("xy", "yx", (0, 1)), ("xz", "zx", (0, 2)), ("yz", "zy", (1, 2))] {
        let of = |name| identifiability.find(&format!("accel.misalignment.{name}")).unwrap();
        let (first, second) = (of(one), of(other));
        let aliases = &identifiability.parameters[first].aliases;
        assert_eq!(aliases.iter().map(|alias| alias.unknown).collect::<Vec<_>>(), [second]);
        let (value, sigma) = fit.sum(first, aliases);
        let truth = accel.matrix[place] + accel.matrix[(place.1, place.0)];
        assert!(
            (value - truth).abs() < 4.0 * sigma && sigma < 60.0 * PPM,
            "{one}: {value} {sigma}"
        );
    }
}

#[test]
fn what_rests_do_not_show_is_said_to_be_hidden() {
    let fit = fitted(&rests(2000.0, 0));
    let identifiability = fit.identifiability();
    for id in ["gyro.scale.x", "gyro.scale.z", "gyro.misalignment.xz"] {
        assert_eq!(
            identifiability.parameters[identifiability.find(id).unwrap()].shown,
            Observable::Nothing,
            "{id}"
        );
    }
    let bias = fit.parameter("gyro.bias.y").unwrap();
    assert!((bias.value - 250.0 * DEG_PER_HOUR).abs() < 4.0 * bias.sigma);
    assert!(bias.sigma < 10.0 * DEG_PER_HOUR, "{bias:?}");
    assert!(fit.parameters.iter().all(|p| p.parameter.owner != Owner::Placement));
}

/// One wobble for one rig, and biases that are common to all static runs until the next power cycle.
#[test]
fn rests_between_two_switchings_on_have_their_biases_in_common() {
    let mut runs = rests(2000.0, 0);
    runs.extend(rests(-1500.0, 1));
    let fit = fitted(&runs);
    let biases: Vec<_> =
        fit.parameters.iter().filter(|p| p.parameter.id == "accel.bias.x").collect();
    assert_eq!(biases.iter().map(|p| p.run).collect::<Vec<_>>(), [Some(0), Some(LAID.len())]);
    for (estimate, truth) in biases.iter().zip([2000.0, -1500.0]) {
        let off = (estimate.value - truth * MICRO_G) / estimate.sigma;
        assert!(off.abs() < 4.0, "off by {off} sigma");
    }
    for of_log in fit.noise.chunks(LAID.len()) {
        assert!(of_log.iter().all(|noise| noise == &of_log[0]), "{of_log:?}");
    }
}
