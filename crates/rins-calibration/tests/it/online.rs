//! Estimates after each sample, and navigation with online compensation.

use nalgebra::Vector3;
use rins_calibration::{
    AxisAttitude, Setup, TableSpec, calibrate, navigate_freely, navigate_online, running_estimate,
};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, TriadError, TriadSpec};
use rins_motion::{Profile, Recording, Segment, Station};
use rins_simulation::{Scenario, Simulated, TableRecord, simulate};

const INTERVAL: f64 = 0.02;
const STATIC: f64 = 10.0;
/// One and a half revolutions, so that the cancellation over whole revolutions does not hide a difference.
const TURN: f64 = 54.0;

fn truth() -> TriadError {
    TriadError::default()
        .with_misalignment(Axis::X, Axis::Z, 60.0 * ARCSEC)
        .with_misalignment(Axis::Y, Axis::Z, -90.0 * ARCSEC)
        .with_scale(Axis::Z, 300.0 * PPM)
}

fn angles() -> EulerAngles {
    EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG }
}

fn station() -> Station {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    Station::with_normal_gravity(site)
}

fn run() -> (Recording, Vec<f64>, Setup) {
    let spec = |noise: f64| TriadSpec::white(noise, 0.0, 1000.0 * PPM, 200.0 * ARCSEC);
    let imu = ImuSpec { gyro: spec(0.02 * DEG_PER_HOUR), accel: spec(30.0 * MICRO_G) };
    let white = |white_density| NoiseModel { white_density, ..NoiseModel::default() };
    let segments = [
        Segment { rate: 0.0, duration: STATIC },
        Segment { rate: 10.0 * DEG_PER_SECOND, duration: TURN },
    ];
    let profile = Profile::new(&segments, None).expect("the profile is sound");
    let scenario = Scenario {
        imu_error: ImuError { gyro: truth(), ..ImuError::default() },
        noise: Some(ImuNoise {
            gyro: white(imu.gyro.noise_density),
            accel: white(imu.accel.noise_density),
        }),
        table: TableRecord::CommandedRate,
        ..Scenario::perfect(station(), angles().dcm(), profile, INTERVAL)
    };
    let Simulated { recording, truth } = simulate(&scenario).expect("the scenario is sound");
    let setup = Setup {
        station: station(),
        axis: Some(AxisAttitude { angles: angles(), sigma: 0.01 * DEG }),
        table: TableSpec { angle_noise: 0.0, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
        imu,
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    };
    let table = std::iter::once(0.0).chain(truth.table_angle).collect();
    (recording, table, setup)
}

#[test]
fn the_last_estimate_is_that_of_the_calibration() {
    let (recording, _, setup) = run();
    let running = running_estimate(&recording, &setup).unwrap();
    let calibration = calibrate(&recording, &setup, |_| ()).unwrap();
    assert_eq!(running.span, calibration.span);
    assert_eq!(running.points.len(), running.span.len());
    let last = running.before(recording.len());
    assert_eq!(last, calibration.imu_error.gyro.matrix.column(2).into_owned());
    let off = last - truth().matrix.column(2);
    let sigma = running.points.last().unwrap().sigma;
    assert!(sigma.iter().all(|sigma| *sigma > 0.0 && *sigma < 0.1 * ARCSEC), "{sigma:?}");
    for row in 0..3 {
        assert!(off[row].abs() < 4.0 * sigma[row], "row {row}: {off:?}, {sigma:?}");
    }
}

#[test]
fn an_estimate_depends_on_the_samples_before_it_alone() {
    let (mut recording, _, setup) = run();
    let running = running_estimate(&recording, &setup).unwrap();
    let start = running.span.start;
    assert_eq!(running.before(0), Vector3::zeros());
    assert_eq!(running.before(start), Vector3::zeros());
    assert_eq!(running.before(start + 1), running.points[0].estimate);
    let changed = start + 500;
    for sample in &mut recording.increments[changed..] {
        sample.angle = sample.angle * 1.001;
    }
    let other = running_estimate(&recording, &setup).unwrap();
    assert_eq!(running.points[..500], other.points[..500]);
    assert_eq!(running.before(changed), other.before(changed));
    assert_ne!(running.before(changed + 1), other.before(changed + 1));
}

#[test]
fn an_estimate_that_never_changes_compensates_as_batch_compensation_does() {
    let (recording, table, setup) = run();
    let mut running = running_estimate(&recording, &setup).unwrap();
    let last = *running.points.last().unwrap();
    running.points.fill(last);
    let (first, end) = (running.span.start + 1, recording.len());
    let gyro = TriadError::default()
        .with_misalignment(Axis::X, Axis::Z, last.estimate.x)
        .with_misalignment(Axis::Y, Axis::Z, last.estimate.y)
        .with_scale(Axis::Z, last.estimate.z);
    let batch = ImuError { gyro, ..ImuError::default() }.compensation().unwrap();
    let (axis, station) = (angles().dcm(), station());
    let navigated = recording.slice(first, end);
    let each = running.compensations(first..end).unwrap();
    let online = navigate_online(&navigated, &table[first..], axis, &station, &each);
    assert_eq!(online, navigate_freely(&navigated, &table[first..], axis, &station, Some(&batch)));
}

#[test]
fn online_compensation_loses_little_of_what_batch_compensation_gains() {
    let (recording, table, setup) = run();
    let running = running_estimate(&recording, &setup).unwrap();
    let (axis, station) = (angles().dcm(), station());
    let each = running.compensations(0..recording.len()).unwrap();
    let gyro = truth();
    let batch = ImuError { gyro, ..ImuError::default() }.compensation().unwrap();
    let none = navigate_freely(&recording, &table, axis, &station, None).velocity;
    let perfect = navigate_freely(&recording, &table, axis, &station, Some(&batch)).velocity;
    let online = navigate_online(&recording, &table, axis, &station, &each).velocity;
    // Both use one log, so that its noise cancels.
    let (gained, lost) = ((none - perfect).norm(), (online - perfect).norm());
    assert!(gained > 0.1, "{gained}");
    assert!(lost > 0.0 && lost < 0.05 * gained, "{lost} of {gained}");
}
