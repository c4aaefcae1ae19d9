//! An unmodeled lever arm degrades a fit; with its term in the model it is estimated.
#![expect(clippy::print_stdout, reason = "an example shows what it finds")]

use rins_estimation::{NoiseKnowledge, NoiseParameters, Reference, Rig, Run, fit};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuNoise, ImuSpec, NoiseModel, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Scenario, simulate};
use rins_terms::{Model, TermInstance, catalogue};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let lever_arm = catalogue::term("accel_lever_arm").ok_or("not in the catalogue")?;
    let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
    let station = Station::with_normal_gravity(site);
    let nav_from_table = EulerAngles { roll: 25.0 * DEG, pitch: 0.0, yaw: 0.0 }.dcm();
    let turn = |rate| Segment { rate: rate * DEG_PER_SECOND, duration: 60.0 };
    let profile = Profile::new(&[10.0, -10.0, 40.0, -40.0].map(turn), Some(0.1))?;
    let imu = data_sheet();
    let noise = ImuNoise {
        gyro: NoiseModel::white(imu.gyro.noise_density),
        accel: NoiseModel::white(imu.accel.noise_density),
    };
    let hidden = TermInstance::new(lever_arm)
        .with_values(&[4e-3, -2.5e-3, 0.0][..lever_arm.parameters.len()]);
    let scenario = Scenario {
        noise: Some(noise),
        effects: Model::default().with(hidden),
        ..Scenario::perfect(station, nav_from_table, profile, 0.02)
    };
    let rig = Rig {
        station,
        nav_from_table,
        reference: Reference::Encoder { noise: 0.1 * ARCSEC },
        wobble: 1e-3 * ARCSEC,
        velocity: 1e-6,
    };
    let runs = [Run::new(rig, simulate(&scenario)?.recording)?];
    let strengths = NoiseParameters::of(&imu);
    for model in [Model::full(), Model::full().with(TermInstance::new(lever_arm).estimated())] {
        let found = fit(&runs, &model, &imu, NoiseKnowledge::Given(strengths), |_| ())?;
        let innovations = found.innovations(0);
        let square: f64 = innovations.iter().map(nalgebra::Matrix::norm_squared).sum();
        println!(
            "{} parameters: mean square of the innovations {:.2} of 6",
            found.parameters.len(),
            square / innovations.len() as f64
        );
        for estimate in found.parameters.iter().filter(|p| p.parameter.id.contains("lever")) {
            let unit = estimate.parameter.unit;
            let (value, sigma) = (estimate.value / unit.factor, estimate.sigma / unit.factor);
            println!("{} = {value:.2} ± {sigma:.2} {}", estimate.parameter.id, unit.symbol);
        }
    }
    Ok(())
}

fn data_sheet() -> ImuSpec {
    let triad = |noise, bias| TriadSpec::white(noise, bias, 500.0 * PPM, 120.0 * ARCSEC);
    ImuSpec {
        gyro: triad(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR),
        accel: triad(30.0 * MICRO_G, 200.0 * MICRO_G),
    }
}
