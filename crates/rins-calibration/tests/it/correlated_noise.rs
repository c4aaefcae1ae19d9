//! The gyro's noise is in the predicted attitude and in the measured rate: the measurement determines it.

use nalgebra::{Matrix3, Vector3};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_calibration::{
    AngleSource, AxisAttitude, Reference, Setup, SpinAxisFilter, Start, TableReading, TableSpec,
};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR_PER_ROOT_HZ, MICRO_G};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Increments, Nav, Site, Table};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::{Profile, Segment, Station, TrueMotion};

const INTERVAL: f64 = 0.1;
const DURATION: f64 = 60.0;
const RATE: f64 = 10.0 * DEG;
const GYRO_NOISE: f64 = 2.0 * DEG_PER_HOUR_PER_ROOT_HZ;

/// The attitude error, resolved in n, after a rotation on a table whose rate is known exactly, with gyros of which only the
/// noise is unknown.
fn attitude_error() -> Vector3<f64> {
    let known = TriadSpec::white(GYRO_NOISE, 0.0, 1e-12, 1e-12);
    // Accelerometers so noisy that they hold no information on the attitude.
    let accel = TriadSpec { noise_density: 1e5 * MICRO_G, ..known };
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let sigma = 1e-4 * ARCSEC;
    let setup = Setup {
        station: Station::with_normal_gravity(site),
        axis: Some(AxisAttitude { angles, sigma }),
        table: TableSpec { angle_noise: 0.0, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
        imu: ImuSpec { gyro: known, accel },
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    };
    let motion = TrueMotion {
        station: setup.station,
        nav_from_table: angles.dcm(),
        profile: Profile::new(&[Segment { rate: RATE, duration: DURATION }], None)
            .expect("the profile is sound"),
    };
    let start = Start {
        nav_from_table: angles.dcm(),
        axis_covariance: Matrix3::identity() * (sigma * sigma),
        angle: 0.0,
        angle_source: AngleSource::Defined,
    };
    let mut filter = SpinAxisFilter::new(setup, &start);
    let mut random = Pcg64::new(0xcafe, 1);
    let mut noise = |sigma: f64| {
        InFrame::from_components(Vector3::from_fn(|_, _| {
            let unit: f64 = StandardNormal.sample(&mut random);
            sigma * unit
        }))
    };
    let root = INTERVAL.sqrt();
    for sample in motion.samples(INTERVAL) {
        let measured = Increments {
            angle: sample.increments.angle + noise(GYRO_NOISE * root),
            velocity: sample.increments.velocity + noise(accel.noise_density * root),
            interval: INTERVAL,
        };
        let table = TableReading::Rate(sample.mean_rate);
        filter.step(&measured, &Reference::fixed(table)).expect("the data are sound");
    }
    let nav_from_table: Dcm<Nav, Table> = angles.dcm();
    let turned = nav_from_table * Dcm::<Table, Body>::about_z(motion.profile.angle(DURATION));
    -(filter.state().nav_from_body * turned.inverse()).rotation_vector()
}

/// The rotation of the table is known, so that the remaining gyro readings are noise, which is removed from the attitude:
/// nothing remains of their random walk. Without the correlation it would remain once, with the wrong sign twice.
#[test]
fn noise_that_a_known_rate_shows_does_not_turn_the_attitude() {
    let walk = GYRO_NOISE * DURATION.sqrt();
    let error = attitude_error();
    for axis in 0..3 {
        assert!(error[axis].abs() < 0.05 * walk, "axis {axis}: {error} of {walk:e} rad");
    }
    // The noise of this run was removed; it was not zero.
    assert!(walk > 10.0 * ARCSEC, "{walk:e} rad");
}
