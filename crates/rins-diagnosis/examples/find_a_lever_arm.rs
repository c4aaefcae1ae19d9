//! A lever arm is hidden in a simulated run, and found by what it does.
#![expect(clippy::print_stdout, reason = "an example shows what it finds")]

use rins_diagnosis::diagnose;
use rins_estimation::{NoiseKnowledge, NoiseParameters, Reference, Rig, Run};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuNoise, ImuSpec, NoiseModel, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Scenario, simulate};
use rins_terms::{Model, TermInstance, catalogue};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
    let station = Station::with_normal_gravity(site);
    let nav_from_table = EulerAngles { roll: 25.0 * DEG, pitch: 0.0, yaw: 0.0 }.dcm();
    let turn = |rate| Segment { rate: rate * DEG_PER_SECOND, duration: 60.0 };
    let profile = Profile::new(&[10.0, -10.0, 30.0, -30.0].map(turn), Some(0.1))?;
    let imu = data_sheet();
    let hidden = TermInstance::new(&catalogue::ACCEL_LEVER_ARM).with_values(&[4e-3, -2.5e-3]);
    let scenario = Scenario {
        noise: Some(ImuNoise {
            gyro: NoiseModel::white(imu.gyro.noise_density),
            accel: NoiseModel::white(imu.accel.noise_density),
        }),
        effects: Model::default().with(hidden),
        ..Scenario::perfect(station, nav_from_table, profile, 0.04)
    };
    let rig = Rig {
        station,
        nav_from_table,
        reference: Reference::Encoder { noise: 0.1 * ARCSEC },
        wobble: 1e-3 * ARCSEC,
        velocity: 1e-6,
    };
    let run = Run::new(rig, simulate(&scenario)?.recording)?;
    let known = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    let found = diagnose(&[run], &Model::full(), &imu, known, |_| ())?;
    for cause in &found.causes {
        println!("{}: the odds of chance are e^{:.0}", cause.term.name, cause.ln_p);
        for estimate in &cause.parameters {
            let unit = estimate.parameter.unit;
            let (value, sigma) = (estimate.value / unit.factor, estimate.sigma / unit.factor);
            println!("  {} = {value:.2} ± {sigma:.2} {}", estimate.parameter.id, unit.symbol);
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
