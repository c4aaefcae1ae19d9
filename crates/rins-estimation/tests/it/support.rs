//! Sites, data sheets and simulated runs that are common to the tests.

use rins_estimation::{Reference, Rig, Run};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{Dcm, EulerAngles, Nav, Site, Table};
use rins_imu::{ImuError, ImuNoise, ImuSpec, NoiseModel, Seed, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, Temperature, simulate};
use rins_terms::Model;

/// One reading of the encoder, 1σ \[rad\].
pub(crate) const ENCODER: f64 = 0.5 * ARCSEC;

/// The data sheet of a navigation-grade fiber-optic unit.
pub(crate) fn fibre() -> ImuSpec {
    ImuSpec {
        gyro: TriadSpec::white(
            0.02 * DEG_PER_HOUR,
            0.1 * DEG_PER_HOUR,
            500.0 * PPM,
            120.0 * ARCSEC,
        ),
        accel: TriadSpec::white(30.0 * MICRO_G, 200.0 * MICRO_G, 300.0 * PPM, 60.0 * ARCSEC),
    }
}

/// White noise of the data sheet.
pub(crate) fn white(imu: &ImuSpec) -> ImuNoise {
    ImuNoise {
        gyro: NoiseModel::white(imu.gyro.noise_density),
        accel: NoiseModel::white(imu.accel.noise_density),
    }
}

pub(crate) fn station() -> Station {
    Station::with_normal_gravity(Site { latitude: 45.0 * DEG, longitude: 0.0, height: 100.0 })
}

/// An axis with the tilt `tilt` and the azimuth `yaw` \[deg\].
pub(crate) fn tilted(tilt: f64, yaw: f64) -> Dcm<Nav, Table> {
    EulerAngles { roll: tilt * DEG, pitch: 0.0, yaw: yaw * DEG }.dcm()
}

/// Rates \[deg/s\] and durations \[s\], with ramps of 5 deg/s².
pub(crate) fn profile(segments: &[(f64, f64)]) -> Profile {
    let segments: Vec<Segment> = segments
        .iter()
        .map(|&(rate, duration)| Segment { rate: rate * DEG_PER_SECOND, duration })
        .collect();
    Profile::new(&segments, Some(5.0 * DEG_PER_SECOND)).unwrap()
}

/// A scenario with an encoder.
pub(crate) fn scenario(
    nav_from_table: Dcm<Nav, Table>,
    profile: Profile,
    (imu_error, effects): (ImuError, Model),
    noise: Option<ImuNoise>,
    seed: u64,
) -> Scenario {
    let encoder = if noise.is_some() { ENCODER } else { 0.0 };
    // The temperature rises and falls: neither a ramp nor an exponential.
    let swing = Temperature::Sinus { start: 20.0, amplitude: 3.0, period: 90.0 };
    Scenario {
        imu_error,
        effects,
        noise,
        temperature: Some(swing),
        table: TableRecord::Angle(Encoder { noise: encoder, resolution: None, zero: 0.0 }),
        seed: Seed::new(seed),
        ..Scenario::perfect(station(), nav_from_table, profile, 0.04)
    }
}

/// The run of a scenario, on a rig with the scenario's survey.
pub(crate) fn run(scenario: &Scenario) -> Run {
    let rig = Rig {
        station: scenario.station,
        nav_from_table: scenario.nav_from_table,
        reference: Reference::Encoder { noise: ENCODER },
        wobble: 1e-3 * ARCSEC,
        velocity: 1e-6,
    };
    Run::new(rig, simulate(scenario).unwrap().recording).unwrap()
}
