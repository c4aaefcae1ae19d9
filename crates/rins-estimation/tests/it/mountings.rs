//! One IMU mounted with several of its axes along the spin axis: its errors are those of its own sensors.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{Fit, NoiseKnowledge, NoiseParameters, Run, fit};
use rins_frames::SignedAxes;
use rins_frames::units::ARCSEC;
use rins_imu::{ImuError, ImuSpec, Seed, Sensor, TriadError, TriadSpec};
use rins_terms::{Model, Owner, Role, TermInstance, catalogue};

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// Six mountings: each of its axes up, and down.
fn mountings() -> [SignedAxes; 6] {
    let spinning = |axis: usize, sign: f64| SignedAxes {
        source: [(axis + 1) % 3, (axis + 2) % 3, axis],
        sign: [1.0, sign, sign],
    };
    [(0, 1.0), (1, 1.0), (2, 1.0), (0, -1.0), (1, -1.0), (2, -1.0)].map(|(a, s)| spinning(a, s))
}

/// An IMU from a population of this sheet.
pub(crate) fn drawn(seed: u64) -> ImuError {
    drawn_from(&fibre(), seed)
}

/// Errors drawn from a data sheet.
pub(crate) fn drawn_from(sheet: &ImuSpec, seed: u64) -> ImuError {
    let mut random = Seed::new(seed).stream(Sensor::Encoder);
    let mut triad = |spec: &TriadSpec| {
        let mut error = TriadError::default();
        for row in 0..3 {
            error.bias[row] = spec.bias_sigma * random.sample();
            for column in 0..3 {
                let sigma = if row == column { spec.scale_sigma } else { spec.misalignment_sigma };
                error.matrix[(row, column)] = sigma * random.sample();
            }
        }
        error
    };
    ImuError { gyro: triad(&sheet.gyro), accel: triad(&sheet.accel) }
}

fn mounted(error: &ImuError, axes: SignedAxes, stand: (f64, f64), seed: u64) -> Run {
    remounted(error, axes, (stand, [0.0; 2]), (&fibre(), seed))
}

/// The same for an IMU that was mounted again with a rotation by `askew` about x and y of the run \[rad\].
fn remounted(
    error: &ImuError,
    axes: SignedAxes,
    ((tilt, yaw), askew): ((f64, f64), [f64; 2]),
    (imu, seed): (&ImuSpec, u64),
) -> Run {
    let turns = profile(&[(0.0, 10.0), (15.0, 30.0), (-15.0, 30.0)]);
    let mounting = TermInstance::new(&catalogue::MOUNTING).with_values(&askew);
    let truth = (error.along(&axes.matrix()), Model::default().with(mounting));
    run(&scenario(tilted(tilt, yaw), turns, truth, Some(white(imu)), seed)).with_axes(axes)
}

fn fitted(runs: &[Run], model: &Model) -> Fit {
    fitted_as(&fibre(), runs, model)
}

fn fitted_as(imu: &ImuSpec, runs: &[Run], model: &Model) -> Fit {
    fit(runs, model, imu, NoiseKnowledge::Given(NoiseParameters::of(imu)), |_| ()).unwrap()
}

/// The true value of a parameter along the axes of the first run.
pub(crate) fn truth(error: &ImuError, id: &str) -> Option<f64> {
    let place = |letter: char| "xyz".find(letter);
    let mut parts = id.split('.');
    let triad = if parts.next()? == "gyro" { error.gyro } else { error.accel };
    let (what, axes) = (parts.next()?, parts.next()?);
    let axes: Vec<usize> = axes.chars().map(place).collect::<Option<_>>()?;
    match (what, axes.as_slice()) {
        ("bias", &[row]) => Some(triad.bias[row]),
        ("scale", &[row]) => Some(triad.matrix[(row, row)]),
        ("misalignment", &[row, column]) => Some(triad.matrix[(row, column)]),
        _ => None,
    }
}

/// A unit of a lower grade: the second-order effect of two errors of half a milliradian, which terms neglect, is below its
/// noise.
fn tactical() -> ImuSpec {
    let mut imu = fibre();
    imu.gyro.noise_density *= 30.0;
    imu.accel.noise_density *= 10.0;
    imu
}

/// 1σ of the mounting error \[rad\].
const ASKEW: f64 = 100.0 * ARCSEC;

/// The sum over these IMUs, random and in three mountings, of the errors squared and normalized by their covariance, 18
/// values each; with `askew` each mounting has a random rotation, which is estimated.
fn squares(imus: Range<u64>, askew: bool) -> f64 {
    let imu = if askew { tactical() } else { fibre() };
    let mut model = Model::full();
    if askew {
        let mut mounting = TermInstance::new(&catalogue::MOUNTING);
        mounting.roles.fill(Role::Within(ASKEW));
        model = model.with(mounting);
    }
    let one = |seed: u64| {
        let error = drawn(seed);
        let from = usize::try_from(seed).unwrap();
        // Three different axes, each up or down.
        let of = |k: usize| mountings()[(from + k) % 3 + 3 * ((from >> k) & 1)];
        let ways = [(2.0, 0.0), (40.0, 70.0), (75.0, 200.0)];
        let mut random = Seed::new(seed ^ 0xa5_c3).stream(Sensor::Encoder);
        let mut drawn_angle = || if askew { ASKEW * random.sample() } else { 0.0 };
        let runs: Vec<Run> = (0..3)
            .map(|k| {
                let stand = (ways[k], [drawn_angle(), drawn_angle()]);
                remounted(&error, of(k), stand, (&imu, 10 * seed + k as u64))
            })
            .collect();
        let fit = fitted_as(&imu, &runs, &model);
        let first = error.along(&runs[0].axes.matrix());
        let of_sensors = |place: &usize| fit.parameters[*place].parameter.owner == Owner::Sensor;
        let places: Vec<usize> = (0..fit.parameters.len()).filter(of_sensors).collect();
        assert_eq!(places.len(), 18);
        let off = |&place: &usize| {
            let estimate = &fit.parameters[place];
            estimate.value - truth(&first, &estimate.parameter.id).unwrap()
        };
        let off = DVector::from_iterator(18, places.iter().map(off));
        let covariance =
            DMatrix::from_fn(18, 18, |row, column| fit.covariance[(places[row], places[column])]);
        for &place in places.iter().filter(|_| !askew) {
            let estimate = &fit.parameters[place];
            if estimate.parameter.id.starts_with("gyro") {
                let share = estimate.sigma / estimate.parameter.sigma;
                assert!(share < 0.05, "{}: {share} of what was known", estimate.parameter.id);
            }
        }
        off.dot(&covariance.cholesky().unwrap().solve(&off))
    };
    imus.into_par_iter().map(one).sum()
}

/// Fails unless the errors agree with their covariances: chi-square within four of its sigmas.
fn assert_as_large_as_said(imus: Range<u64>, askew: bool) {
    let dof = 18.0 * (imus.end - imus.start) as f64;
    let sum = squares(imus, askew);
    assert!((sum - dof).abs() < 4.0 * (2.0 * dof).sqrt(), "{sum} where {dof} are expected");
}

/// The textbook calibration: three mountings on a single-axis table determine all scale errors and misalignments of the
/// gyros. For random IMUs and mountings the errors agree with their covariance.
#[test]
fn three_mountings_give_the_whole_matrix_of_the_gyros() {
    assert_as_large_as_said(0..12, false);
}

/// A mounting error is a rotation of the run: if it is estimated, the uncertainties increase and agree with the errors.
#[test]
fn mountings_that_are_askew_are_estimated() {
    assert_as_large_as_said(0..12, true);
}

#[test]
#[ignore = "takes minutes: 240 IMUs instead of 12"]
fn three_mountings_of_many_imus() {
    assert_as_large_as_said(0..240, false);
    assert_as_large_as_said(0..240, true);
}

/// A run with other declared axes is the same run: only names depend on them.
#[test]
fn one_run_is_the_same_about_any_axis() {
    let error = drawn(77);
    for axes in mountings() {
        let told = mounted(&error, axes, (30.0, 10.0), 5);
        let plain = Run { axes: SignedAxes::IDENTITY, ..told.clone() };
        let (told, plain) = (fitted(&[told], &Model::full()), fitted(&[plain], &Model::full()));
        assert_eq!(told.parameters, plain.parameters);
        assert_eq!(told.covariance, plain.covariance);
        assert_eq!((told.axes, plain.axes), (axes, SignedAxes::IDENTITY));
    }
}

/// Parameters that are observable only for the gyro along the spin axis belong to each gyro, and a bias belongs to a
/// mounting.
#[test]
fn what_belongs_to_the_axis_of_rotation_is_another_gyros_in_another_mounting() {
    let error = drawn(3);
    let [x, y, _, minus_x, ..] = mountings();
    let asymmetry = TermInstance::new(&catalogue::GYRO_SCALE_ASYMMETRY).estimated();
    let model = Model::full().with(asymmetry);
    let ids = |second: SignedAxes| -> Vec<(String, Option<usize>)> {
        let runs = [mounted(&error, x, (5.0, 0.0), 1), mounted(&error, second, (50.0, 90.0), 2)];
        let fit = fitted(&runs, &model);
        let all = fit.parameters.iter().map(|p| (p.parameter.id.clone(), p.run));
        all.filter(|(id, _)| id.starts_with("gyro_scale") || id == "gyro.bias.z").collect()
    };
    let own = |id: &str, run| (id.to_owned(), run);
    let biases = [own("gyro.bias.z", Some(0)), own("gyro.bias.z", Some(1))];
    // The spin axis of the first run is the sensor's x, which is the run's z; the sensor's y is the run's x.
    let two = [own("gyro_scale_asymmetry.z", None), own("gyro_scale_asymmetry.x", None)];
    assert_eq!(ids(y), [two.as_slice(), &biases].concat());
    assert_eq!(ids(minus_x), [&two[..1], &biases].concat());
}

/// An IMU that stays on while it is mounted otherwise keeps its turn-on biases: what is level in one mounting is vertical in another, which
/// separates the biases of the accelerometers from their scale errors; and the errors of 24 parameters agree with their covariance.
#[test]
fn turn_on_biases_outlive_a_change_of_the_mounting() {
    let imus = 12;
    let one = |seed: u64| {
        let error = drawn(seed);
        let ways = [(2.0, 0.0), (3.0, 70.0), (4.0, 200.0)];
        let runs: Vec<Run> = (0..3)
            .map(|k| mounted(&error, mountings()[(k + 1) % 3], ways[k], 10 * seed + k as u64))
            .collect();
        let apart = fitted(&runs, &Model::full());
        let together: Vec<Run> = runs.into_iter().map(|run| run.since(0)).collect();
        let together = fitted(&together, &Model::full()).along(SignedAxes::IDENTITY);
        let of_imu: Vec<usize> = (0..together.parameters.len())
            .filter(|&place| together.parameters[place].parameter.owner != Owner::Placement)
            .collect();
        assert_eq!(of_imu.len(), 24);
        assert!(of_imu.iter().all(|&place| together.parameters[place].run.is_none()));
        let sigma = |fit: &Fit, id: &str| {
            let of = |estimate: &&rins_estimation::Estimate| estimate.parameter.id == id;
            fit.parameters.iter().filter(of).map(|one| one.sigma).fold(f64::INFINITY, f64::min)
        };
        for id in ["accel.scale.x", "accel.scale.y", "accel.scale.z"] {
            let (together, apart) = (sigma(&together, id), sigma(&apart, id));
            assert!(together < 0.5 * apart, "{id}: {together} {apart}");
        }
        let off = of_imu.iter().map(|&place| {
            let estimate = &together.parameters[place];
            estimate.value - truth(&error, &estimate.parameter.id).unwrap()
        });
        let off = DVector::from_iterator(24, off);
        let covariance = together.covariance.select_rows(&of_imu).select_columns(&of_imu);
        off.dot(&covariance.cholesky().unwrap().solve(&off))
    };
    let sum: f64 = (0..imus).into_par_iter().map(one).sum();
    let dof = 24.0 * imus as f64;
    assert!((sum - dof).abs() < 4.0 * (2.0 * dof).sqrt(), "{sum} where {dof} are expected");
}

/// The model is along the first run's axes: the prior of a sensor applies in every run.
#[test]
fn what_is_expected_goes_with_the_sensor() {
    let error = ImuError::default();
    let [x, _, minus_z, ..] = [0, 1, 5].map(|k| mountings()[k]);
    let mut model = Model::full();
    let expected =
        [("gyro.scale.z", 4e-4), ("gyro.misalignment.xz", -2e-4), ("accel.scale.x", 1e-4)];
    for (id, value) in expected {
        model = model.with_value(id, value);
    }
    let runs = [mounted(&error, x, (5.0, 0.0), 1), mounted(&error, minus_z, (50.0, 90.0), 2)];
    let fit = fitted(&runs, &model);
    for (id, value) in expected {
        assert_eq!(fit.parameter(id).unwrap().expected.to_bits(), value.to_bits(), "{id}");
    }
    // Both models hold the same sensors.
    let rel = runs[1].axes.after(&runs[0].axes.inverse());
    let there = fit.models[0].carried(&rel);
    for (ours, other) in there.terms.iter().zip(&fit.models[1].terms) {
        if ours.term.owner == Owner::Sensor {
            let off = ours.values.iter().zip(&other.values).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-18, "{}", ours.term.id);
        }
    }
}

/// Along other axes the same estimates have other names, signs and places, and nothing else changes.
#[test]
fn estimates_are_the_same_along_any_axes() {
    let error = drawn(11);
    let [x, _, minus_z, ..] = [0, 1, 5].map(|k| mountings()[k]);
    let asymmetry = TermInstance::new(&catalogue::GYRO_SCALE_ASYMMETRY).estimated();
    let model = Model::full().with(asymmetry);
    let runs = [mounted(&error, x, (5.0, 0.0), 1), mounted(&error, minus_z, (50.0, 90.0), 2)];
    let fit = fitted(&runs, &model);
    let own = fit.clone().along(SignedAxes::IDENTITY);
    let ids: Vec<&str> = own.parameters.iter().map(|p| p.parameter.id.as_str()).collect();
    let first = ["gyro.scale.x", "gyro.scale.y", "gyro.scale.z", "gyro.misalignment.xy"];
    assert_eq!(&ids[..4], &first);
    for asymmetry in ["gyro_scale_asymmetry.x", "gyro_scale_asymmetry.z"] {
        assert!(ids.contains(&asymmetry), "{asymmetry}");
    }
    for estimate in own.parameters.iter().filter(|p| p.parameter.owner == Owner::Sensor) {
        let Some(truth) = truth(&error, &estimate.parameter.id) else { continue };
        let off = (estimate.value - truth) / estimate.sigma;
        assert!(off.abs() < 5.0, "{}: {off} sigma", estimate.parameter.id);
    }
    for (run, model) in own.models.iter().enumerate() {
        for estimate in &own.parameters {
            let Some(there) = own.in_run(estimate, run) else { continue };
            let value = model.terms[there.term].values[there.parameter];
            assert_eq!((there.sign * estimate.value).to_bits(), value.to_bits());
        }
    }
    // Forth and back.
    let (back, first) = (own.along(fit.axes), fit.clone().along(fit.axes));
    assert_eq!(back.parameters, first.parameters);
    assert_eq!(back.covariance, first.covariance);
}
