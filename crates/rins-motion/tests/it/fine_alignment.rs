//! Fine alignment on a base that sways: consistent over many runs, and more accurate than the mean over the static interval.

use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_frames::units::{DEG, DEG_PER_HOUR, MICRO_G};
use rins_frames::{Body, Dcm, EARTH_RATE, EulerAngles, InFrame, Increments, Nav, Site};
use rins_motion::{
    GyroFigures, MeanUncertainty, Recording, RestMean, Station, align, align_finely,
};

const INTERVAL: f64 = 0.1;
const SAMPLES: usize = 4000;
const BIAS: f64 = 0.02 * DEG_PER_HOUR;
const GYRO: GyroFigures = GyroFigures { bias_sigma: BIAS, noise_density: 0.02 * DEG_PER_HOUR };

fn station() -> Station {
    Station::with_normal_gravity(Site { latitude: 0.6, longitude: 0.0, height: 100.0 })
}

struct Draws(Pcg64);

impl Draws {
    fn vector(&mut self, sigma: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| {
            let unit: f64 = StandardNormal.sample(&mut self.0);
            sigma * unit
        })
    }
}

/// The rotation of the base relative to its initial attitude: a tenth of a degree forth and back, as if somebody steps onto a
/// platform.
fn sway(time: f64) -> Vector3<f64> {
    let step = |from: f64, to: f64| ((time - from) / (to - from)).clamp(0.0, 1.0);
    let tilt = step(60.0, 62.0) - step(200.0, 205.0);
    Vector3::new(0.1 * DEG * tilt, -0.05 * DEG * step(120.0, 121.0), 0.0)
}

struct Run {
    recording: Recording,
    start: Dcm<Nav, Body>,
    bias: Vector3<f64>,
}

fn run(seed: u128) -> Run {
    let mut draws = Draws(Pcg64::new(11, seed));
    let start = start(&mut draws);
    let bias = draws.vector(BIAS);
    recorded(&mut draws, start, bias, sway)
}

fn start(draws: &mut Draws) -> Dcm<Nav, Body> {
    let angles = draws.vector(1.0);
    EulerAngles { roll: 0.3 * angles.x, pitch: 0.3 * angles.y, yaw: angles.z }.dcm()
}

/// The recording of an IMU over a static interval on a base with the rotation `sway` relative to its initial attitude.
fn recorded(
    draws: &mut Draws,
    start: Dcm<Nav, Body>,
    bias: Vector3<f64>,
    sway: impl Fn(f64) -> Vector3<f64>,
) -> Run {
    let station = station();
    let earth_turn = station.site.earth_rate().components() * INTERVAL;
    let attitude = |time: f64| start * Dcm::<Body, Body>::from_rotation_vector(&sway(time));
    let root = INTERVAL.sqrt();
    let mut recording = Recording::default();
    for sample in 0..SAMPLES {
        let (from, to) = (sample as f64 * INTERVAL, (sample + 1) as f64 * INTERVAL);
        // The body rotates with the Earth and with the sway.
        let turn = attitude(from).inverse()
            * Dcm::<Nav, Nav>::from_rotation_vector(&earth_turn)
            * attitude(to);
        let middle = attitude(0.5 * (from + to));
        let force = middle.inverse() * -station.gravity_vector();
        let angle =
            turn.rotation_vector() + bias * INTERVAL + draws.vector(GYRO.noise_density * root);
        let velocity = force.components() * INTERVAL + draws.vector(30.0 * MICRO_G * root);
        recording.times.push(to);
        recording.increments.push(Increments {
            angle: InFrame::from_components(angle),
            velocity: InFrame::from_components(velocity),
            interval: INTERVAL,
        });
    }
    Run { recording, start, bias }
}

#[test]
fn covariance_is_honest_and_the_bias_found_is_the_true_one() {
    const RUNS: u32 = 50;
    let (mut nees, mut nees_if_halved, mut off) = (0.0, 0.0, 0.0_f64);
    for seed in 0..RUNS {
        let run = run(u128::from(seed));
        let found = align_finely(&run.recording, 0..SAMPLES, &station(), Some(&GYRO)).unwrap();
        let phi = -(found.nav_from_body * run.start.inverse()).rotation_vector();
        let factor = found.covariance.cholesky().unwrap();
        nees += phi.dot(&factor.solve(&phi)) / f64::from(RUNS);
        nees_if_halved += 4.0 * phi.dot(&factor.solve(&phi)) / f64::from(RUNS);
        let error = (found.gyro_bias.components() - run.bias).component_div(&found.gyro_bias_sigma);
        off = off.max(error.amax());
    }
    // χ² of 3 degrees of freedom: 99 % of means over 50 runs.
    let bound = 2.576 * (6.0 / f64::from(RUNS)).sqrt();
    assert!((nees - 3.0).abs() < bound, "mean NEES {nees}, not 3 ± {bound}");
    assert!((nees_if_halved - 3.0).abs() > bound, "half the sigma would have passed");
    // Of 150 normal values one exceeds 4.5 with a probability of 0.001.
    assert!(off < 4.5, "a bias is {off} sigma off");
}

/// Gyros with a bias along up of ten to five hundred times the data sheet's sigma, on a stationary base and, from a hundred
/// times on, on one that rotates about up as much as it tilts. Gravity holds no information on it, the base's heading does.
#[test]
fn bias_along_up_beyond_the_data_sheet_is_found() {
    const RUNS: u32 = 200;
    let (mut nees, mut yaw) = ([0.0; 2], 0.0);
    for seed in 0..RUNS {
        let mut draws = Draws(Pcg64::new(12, u128::from(seed)));
        let start = start(&mut draws);
        let sways = usize::from(seed % 2 == 1);
        let least: f64 = [10.0, 100.0][sways];
        let part = (draws.vector(1.0).x.abs() / 3.0).min(1.0);
        let beyond = BIAS * least * (500.0 / least).powf(part);
        let off = draws.vector(BIAS);
        let bias = off + (start.inverse() * InFrame::new(0.0, 0.0, beyond)).components();
        // A slow oscillation about three axes with equal amplitudes.
        let (size, phase) = (sways as f64 * 0.02 * DEG, draws.vector(3.0));
        let swing = |time: f64| {
            Vector3::from_fn(|axis, _| {
                let at = |time: f64| (0.011 * (axis + 2) as f64 * time + phase[axis]).sin();
                size * (at(time) - at(0.0))
            })
        };
        let run = recorded(&mut draws, start, bias, swing);
        let found = align_finely(&run.recording, 0..SAMPLES, &station(), Some(&GYRO)).unwrap();
        let error = (found.gyro_bias.components() - run.bias).component_div(&found.gyro_bias_sigma);
        assert!(error.amax() < 5.0, "{seed}: {error} sigma of {}", found.gyro_bias_sigma);
        let up = (start * found.gyro_bias).components().z;
        assert!((up / beyond - 1.0).abs() < 0.2, "{seed}: {up} is not {beyond}");
        nees[sways] += error.norm_squared() / f64::from(RUNS / 2);
        let phi = -(found.nav_from_body * run.start.inverse()).rotation_vector();
        yaw += phi.z * phi.z / found.covariance[(2, 2)] / f64::from(RUNS);
    }
    // Components are correlated, so that only their mean is known; an uncertainty of the heading that is too large is
    // acceptable.
    assert!(nees.iter().all(|mean| (0.5..3.9).contains(mean)), "{nees:?}");
    assert!((yaw - 1.0).abs() < 2.576 * (2.0 / f64::from(RUNS)).sqrt(), "{yaw}");
}

/// Gyros with a bias along north of ten to two hundred times the data sheet's sigma, so that the bias along east may be as
/// large: this limits the accuracy of the azimuth.
#[test]
fn bias_along_north_beyond_the_data_sheet_leaves_the_azimuth_open() {
    const RUNS: u32 = 200;
    let mut yaw = 0.0;
    for seed in 0..RUNS {
        let mut draws = Draws(Pcg64::new(13, u128::from(seed)));
        let start = start(&mut draws);
        let part = (draws.vector(1.0).x.abs() / 3.0).min(1.0);
        let beyond = BIAS * 10.0 * 20.0_f64.powf(part);
        let along = InFrame::new(0.0, beyond, 0.0);
        let bias = draws.vector(BIAS) + (start.inverse() * along).components();
        let run = recorded(&mut draws, start, bias, |_| Vector3::zeros());
        let found = align_finely(&run.recording, 0..SAMPLES, &station(), Some(&GYRO)).unwrap();
        let error = (found.gyro_bias.components() - run.bias).component_div(&found.gyro_bias_sigma);
        assert!(error.amax() < 4.5, "{seed}: {error} sigma of {}", found.gyro_bias_sigma);
        let phi = -(found.nav_from_body * run.start.inverse()).rotation_vector();
        yaw += phi.z * phi.z / found.covariance[(2, 2)] / f64::from(RUNS);
        let open = beyond / (EARTH_RATE * station().site.latitude.cos());
        assert!(found.covariance[(2, 2)].sqrt() > 0.4 * open, "{seed}: {open} rad");
    }
    // The actual bias along east agrees with the data sheet and is much smaller than its prior sigma.
    assert!(yaw < 1.0, "{yaw}");
}

#[test]
fn sway_spoils_the_mean_of_a_rest_and_not_the_filter() {
    let Run { recording, start, .. } = run(1000);
    let mean = RestMean::of(&recording, 0..SAMPLES).unwrap();
    let uncertainty = MeanUncertainty { angular_rate: 1e-9, specific_force: 1e-5 };
    let coarse = align(&mean.rates, &uncertainty, &station()).unwrap();
    let fine = align_finely(&recording, 0..SAMPLES, &station(), Some(&GYRO)).unwrap();
    let error = |found: Dcm<Nav, Body>| (found * start.inverse()).rotation_vector().xy().norm();
    assert!(error(coarse.nav_from_body) > 0.02 * DEG);
    assert!(error(fine.nav_from_body) < 0.002 * DEG);
}

#[test]
fn gyros_that_do_not_show_the_earth_are_refused() {
    let mut run = run(3);
    for sample in &mut run.recording.increments {
        sample.angle += InFrame::new(1e-3 * INTERVAL, 0.0, 0.0);
    }
    let refused = align_finely(&run.recording, 0..SAMPLES, &station(), None).unwrap_err();
    assert!(refused.to_string().contains("cannot determine north"), "{refused}");
}
