//! Colored noise: its parameters are estimated, and the sigmas include it.

use rins_estimation::{Fit, NoiseKnowledge, NoiseParameters, Run, fit};
use rins_frames::units::{DEG_PER_HOUR, MICRO_G};
use rins_imu::{ImuError, ImuNoise, NoiseModel};
use rins_terms::Model;

use crate::support::{fibre, profile, run, scenario, tilted, white};

fn fitted(run: &Run, knowledge: fn(NoiseParameters) -> NoiseKnowledge) -> Fit {
    let imu = fibre();
    let runs = std::slice::from_ref(run);
    fit(runs, &Model::full(), &imu, knowledge(NoiseParameters::of(&imu)), |_| ()).unwrap()
}

fn turned(noise: ImuNoise, seed: u64) -> Run {
    let turns = profile(&[(0.0, 20.0), (10.0, 120.0), (-10.0, 120.0)]);
    let truth = (ImuError::default(), Model::default());
    run(&scenario(tilted(25.0, 0.0), turns, truth, Some(noise), seed))
}

#[test]
fn flicker_is_found_to_a_third_of_itself() {
    let imu = fibre();
    let flicker = 0.05 * DEG_PER_HOUR;
    let coloured = ImuNoise {
        gyro: NoiseModel { flicker: Some(flicker), ..NoiseModel::white(imu.gyro.noise_density) },
        ..white(&imu)
    };
    let run = turned(coloured, 11);
    let found = fitted(&run, NoiseKnowledge::Likely);
    let strengths = found.noise[0].imu;
    let ratio = strengths.gyro.flicker / flicker;
    assert!((0.67..1.5).contains(&ratio), "gyro flicker in ratio {ratio}");
    let white = strengths.gyro.white / imu.gyro.noise_density;
    assert!((0.85..1.15).contains(&white), "gyro white noise in ratio {white}");
    assert!(strengths.accel.flicker < 5.0 * MICRO_G, "{strengths:?}");
    // With white noise alone, the same data would seem ten times as precise.
    let (naive, honest) = (fitted(&run, NoiseKnowledge::Given), found);
    let sigma = |fit: &Fit| fit.parameter("gyro.bias.x").unwrap().sigma;
    assert!(sigma(&honest) > 5.0 * sigma(&naive), "{} {}", sigma(&honest), sigma(&naive));
}

#[test]
fn white_noise_is_not_taken_for_flicker() {
    let imu = fibre();
    let run = turned(white(&imu), 12);
    let strengths = fitted(&run, NoiseKnowledge::Likely).noise[0].imu;
    assert!(strengths.gyro.flicker < 0.003 * DEG_PER_HOUR, "{strengths:?}");
    for (found, sheet) in [
        (strengths.gyro.white, imu.gyro.noise_density),
        (strengths.accel.white, imu.accel.noise_density),
    ] {
        // 2000 values determine it to 2 %.
        assert!((found / sheet - 1.0).abs() < 0.06, "{found} against {sheet}");
    }
}

#[test]
fn data_sheets_that_understate_are_corrected() {
    let imu = fibre();
    let noisier =
        ImuNoise { accel: NoiseModel::white(3.0 * imu.accel.noise_density), ..white(&imu) };
    let run = turned(noisier, 13);
    let found = fitted(&run, NoiseKnowledge::Likely).noise[0].imu.accel.white;
    let ratio = found / imu.accel.noise_density;
    assert!((2.8..3.2).contains(&ratio), "in ratio {ratio}");
}
