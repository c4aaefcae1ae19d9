//! Calibrates a simulated run at one constant rate and compares the estimates with the true values.
#![expect(clippy::print_stdout, reason = "an example prints")]

use rins_calibration::{AxisAttitude, Setup, TableSpec, calibrate};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, TriadError, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let station = Station::with_normal_gravity(site);
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 360.0 };
    let truth = TriadError::default()
        .with_misalignment(Axis::X, Axis::Z, 60.0 * ARCSEC)
        .with_misalignment(Axis::Y, Axis::Z, -40.0 * ARCSEC)
        .with_scale(Axis::Z, 300.0 * PPM);
    let gyro =
        TriadSpec::white(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR, 500.0 * PPM, 120.0 * ARCSEC);
    let imu = ImuSpec {
        gyro,
        accel: TriadSpec { noise_density: 30.0 * MICRO_G, bias_sigma: 200.0 * MICRO_G, ..gyro },
    };
    let white = |spec: &TriadSpec| NoiseModel {
        white_density: spec.noise_density,
        ..NoiseModel::default()
    };
    let encoder = Encoder { noise: 0.3 * ARCSEC, ..Encoder::default() };
    let scenario = Scenario {
        imu_error: ImuError { gyro: truth, ..ImuError::default() },
        noise: Some(ImuNoise { gyro: white(&imu.gyro), accel: white(&imu.accel) }),
        table: TableRecord::Angle(encoder),
        ..Scenario::perfect(station, angles.dcm(), Profile::new(&[turn], None)?, 0.02)
    };
    let run = simulate(&scenario)?;

    let setup = Setup {
        station,
        axis: Some(AxisAttitude { angles, sigma: 0.01 * DEG }),
        table: TableSpec {
            angle_noise: encoder.noise,
            wobble: 0.01 * ARCSEC,
            rate_noise: 0.0,
            latency: 0.0,
        },
        imu,
        velocity_noise: 1e-7,
    };
    let calibration = calibrate(&run.recording, &setup, |_| ())?;
    for (row, parameter) in calibration.parameters.iter().enumerate() {
        let factor = parameter.kind.factor();
        println!(
            "{:22} {:9.4} ± {:.4} {}, true {:.4}",
            parameter.id,
            parameter.value / factor,
            parameter.sigma / factor,
            parameter.kind.unit(),
            truth.matrix[(row, 2)] / factor,
        );
    }
    println!("mean NIS {:.3} of 6", calibration.consistency.nis_mean);
    println!(
        "velocity error after 360 s: {:.3} m/s before, {:.5} m/s after",
        calibration.before.velocity.norm(),
        calibration.after.velocity.norm(),
    );
    Ok(())
}
