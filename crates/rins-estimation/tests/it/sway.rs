//! A static run on a base that sways: the sway is not attributed to the sensors' noise.

use std::sync::Arc;

use nalgebra::{Rotation3, Vector3};
use rins_estimation::{NoiseKnowledge, NoiseParameters, Reference, Run, Turned, attitudes, fit};
use rins_frames::units::{ARCSEC, DEG_PER_HOUR};
use rins_frames::{Dcm, InFrame, Table};
use rins_imu::{ImuError, ImuSpec, Seed, Sensor, TriadSpec};
use rins_terms::{Model, Surroundings};

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// Sway of the base about each axis: density of the random walk \[rad/√s\].
const SWAY: [f64; 3] = [30.0 * ARCSEC, 10.0 * ARCSEC, 2.0 * ARCSEC];

/// The bias of gyro x in this run \[rad/s\].
const BIAS: f64 = 4.0 * DEG_PER_HOUR;

/// Gyros whose drift exceeds the uncertainty from gravity.
fn coarse() -> ImuSpec {
    let fine = fibre();
    let (noise_density, bias_sigma) = (1.0 * DEG_PER_HOUR, 5.0 * DEG_PER_HOUR);
    ImuSpec { gyro: TriadSpec { noise_density, bias_sigma, ..fine.gyro }, ..fine }
}

/// A static run of five minutes whose attitude is a random walk with `SWAY`, with the noise of the data sheet; and the
/// attitude after each sample.
fn swaying() -> (Run, Vec<Rotation3<f64>>) {
    let truth = (ImuError::default(), Model::default());
    let still = profile(&[(0.0, 300.0)]);
    let still = scenario(tilted(3.0, 40.0), still, truth, Some(white(&coarse())), 5);
    let mut run = run(&still);
    let around = Surroundings::new(run.rig.station, run.rig.nav_from_table);
    let mut deviates = Seed::new(7).stream(Sensor::Encoder);
    let mut attitude = Rotation3::<f64>::identity();
    let mut attitudes = Vec::new();
    for sample in &mut Arc::make_mut(&mut run.recording).increments {
        let t = sample.interval;
        let turn = Vector3::from(SWAY.map(|density| density * t.sqrt() * deviates.sample()));
        let middle = attitude * Rotation3::new(turn * 0.5);
        attitude *= Rotation3::new(turn);
        let moved = |of: Vector3<f64>| (middle.inverse() * of - of) * t;
        let bias = Vector3::new(BIAS * t, 0.0, 0.0);
        sample.angle += InFrame::from_components(turn + moved(around.earth_rate) + bias);
        sample.velocity += InFrame::from_components(moved(around.specific_force));
        attitudes.push(attitude);
    }
    run.rig.reference = Reference::Rest;
    run.rig.wobble = ARCSEC;
    (run, attitudes)
}

#[test]
fn base_that_sways_is_told_from_noise() {
    let imu = coarse();
    let (run, _) = swaying();
    let likely = NoiseKnowledge::Likely(NoiseParameters::of(&imu));
    let found = fit(&[run], &Model::full(), &imu, likely, |_| ()).unwrap();
    let noise = &found.noise[0];
    let white = noise.imu.gyro.white / imu.gyro.noise_density;
    // Gravity determines the level about fifty times: as often the drift of the gyros from it is measured.
    assert!((0.5..2.0).contains(&white), "gyro white noise in ratio {white}");
    for (found, true_one) in noise.sway.into_iter().zip(SWAY) {
        assert!((0.8..1.25).contains(&(found / true_one)), "{found} of {true_one}");
    }
    // Gravity determines the level for any sway of the base, and thus the drift of a gyro.
    let bias = found.parameter("gyro.bias.x").unwrap();
    assert!(bias.sigma < 0.5 * imu.gyro.bias_sigma, "{}", bias.sigma);
    assert!((bias.value - BIAS).abs() < 4.0 * bias.sigma, "{} ± {}", bias.value, bias.sigma);
}

/// The base moves by hundreds of arcseconds, and the filter follows: gravity determines its level.
#[test]
fn attitude_of_a_base_that_sways_is_known() {
    let imu = coarse();
    let (run, truth) = swaying();
    let likely = NoiseKnowledge::Likely(NoiseParameters::of(&imu));
    let found = fit(std::slice::from_ref(&run), &Model::full(), &imu, likely, |_| ()).unwrap();
    let known = attitudes(&run, &found.linear[0], &found.noise[0]).unwrap();
    assert_eq!(known.last().unwrap().samples, truth.len());
    // The initial level is known only as well as the accelerometers' bias; the motion is known better.
    let settled = &known[known.len() / 4..];
    let way = |turned: &Turned| truth[turned.samples - 1].scaled_axis();
    let off = |turned: &Turned| {
        let truth = Dcm::<Table, Table>::from_rotation_vector(&way(turned));
        (turned.by * truth.inverse()).rotation_vector()
    };
    let first = off(&settled[0]);
    let most = |of: &dyn Fn(&Turned) -> f64| settled.iter().map(of).fold(0.0, f64::max) / ARCSEC;
    let worst = most(&|turned| (off(turned) - first).xy().amax());
    let moved = most(&|turned| way(turned).xy().amax());
    assert!(moved > 200.0 && worst < 0.1 * moved, "off by {worst} of {moved} arcsec");
}
