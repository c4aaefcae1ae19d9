//! Measured multi-position tests, calibrated by an independent program: least squares of the magnitude of gravity, and of its
//! direction before and after each turn.
//!
//! It shares no code with `rins`: it reads the files, finds the static intervals and fits the parameters by itself. Its sigmas are
//! those of a residual-scaled fit: the noise of a mean over a static interval is the scatter of the residuals. The
//! priors of the rig file are added, which six attitudes need.

mod fit;
mod samples;

use std::fs;

use fit::{Accelerometers, Gyros, Priors};
use nalgebra::Vector3;
use rins_tests::outside_data;
use samples::Samples;
use serde_json::Value;
use tempfile::TempDir;

use super::rig;
use crate::support::{list, number, parameter, result_in};

const DEG: f64 = std::f64::consts::PI / 180.0;
const MICRO_G: f64 = 9.80665e-6;
const PPM: f64 = 1e-6;
const ARCSEC: f64 = DEG / 3600.0;

/// The largest difference in units of the combined standard uncertainty. The data are the same, so that it is that of the
/// intervals and of their weights, not of noise.
const APART: f64 = 1.5;

/// The same of the gyros: the independent fit uses the direction of gravity after each turn, this one also the heading.
const GYROS_APART: f64 = 3.0;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The pairs of axes, as indices and as the ids of both misalignments.
const PAIRS: [[&str; 2]; 3] = [["xy", "yx"], ["xz", "zx"], ["yz", "zy"]];

/// A comparison: what it is of, the two values and their sigmas.
#[derive(Debug)]
struct Compared {
    id: String,
    own: [f64; 2],
    theirs: [f64; 2],
}

impl Compared {
    fn assert(&self) {
        let Self { id, own: [own, own_sigma], theirs: [theirs, sigma] } = self;
        let apart = (own - theirs).abs() / own_sigma.hypot(*sigma);
        assert!(apart < APART, "{id}: {own:.1} ± {own_sigma:.1}, not {theirs:.1} ± {sigma:.1}");
    }

    /// The sigma of `rins` relative to that of the independent fit.
    fn ratio(&self) -> f64 {
        self.theirs[1] / self.own[1]
    }
}

/// The nine parameters of the accelerometers in both calibrations, in the units of results.
fn accelerometers(result: &Value, own: &Accelerometers) -> Vec<Compared> {
    let mut compared = Vec::new();
    let triads = [("bias", 0, MICRO_G), ("scale", 3, PPM)];
    for (name, first, unit) in triads {
        for (axis, letter) in AXES.iter().enumerate() {
            let id = format!("accel.{name}.{letter}");
            let theirs = marginal(result, &id);
            let place = first + axis;
            let own = [own.values[place] / unit, own.sigmas[place] / unit];
            compared.push(Compared { id, own, theirs });
        }
    }
    for (pair, [one, other]) in PAIRS.iter().enumerate() {
        let id = format!("accel.misalignment.{one}");
        // Only the sum is determined.
        let theirs = sum(result, &[(&id, 1.0), (&format!("accel.misalignment.{other}"), 1.0)]);
        let own = [own.values[6 + pair] / ARCSEC, own.sigmas[6 + pair] / ARCSEC];
        compared.push(Compared { id, own, theirs });
    }
    compared
}

/// The sum of parameters with these weights, and its sigma.
fn sum(result: &Value, weights: &[(&str, f64)]) -> [f64; 2] {
    let all = list(result, "/parameters");
    let place = |id: &str| all.iter().position(|one| one["id"] == id).expect("a parameter");
    let correlation =
        |a: &str, b: &str| number(result, &format!("/correlation/{}/{}", place(a), place(b)));
    let of = |id: &str| marginal(result, id);
    let value = weights.iter().map(|(id, weight)| weight * of(id)[0]).sum();
    let products = weights
        .iter()
        .flat_map(|(a, one)| weights.iter().map(move |(b, other)| (*a, *b, one * other)));
    let variance: f64 =
        products.map(|(a, b, product)| product * correlation(a, b) * of(a)[1] * of(b)[1]).sum();
    [value, variance.sqrt()]
}

fn marginal(result: &Value, id: &str) -> [f64; 2] {
    let found = parameter(result, id);
    [number(found, "/marginal/value"), number(found, "/marginal/sigma")]
}

/// Asserts that the mean gyro readings agree except for the Earth's rate, and that scale errors and misalignments agree.
///
/// The body axes of the independent fit make the accelerometers' misalignments symmetric. In other axes, the antisymmetric part of
/// these is added to the gyros' misalignments.
fn assert_gyros(result: &Value, means: &[Vector3<f64>], gyros: &Gyros) {
    let count = means.len() as f64;
    let mean = means.iter().sum::<Vector3<f64>>() / count;
    for (axis, letter) in AXES.iter().enumerate() {
        let square: f64 = means.iter().map(|one| (one[axis] - mean[axis]).powi(2)).sum();
        let sigma = (square / (count - 1.0) / count).sqrt();
        let unit = DEG / 3600.0;
        let theirs = marginal(result, &format!("gyro.bias.{letter}"));
        let apart = (mean[axis] / unit - theirs[0]).abs();
        let limit = APART * (sigma / unit).hypot(theirs[1]) + 15.05;
        assert!(apart < limit, "{letter}: {apart} deg/h apart, {theirs:?} of rins");
    }
    for (row, one) in AXES.iter().enumerate() {
        for (column, other) in AXES.iter().enumerate() {
            let (id, unit, theirs) = if row == column {
                let id = format!("gyro.scale.{one}");
                (id.clone(), PPM, marginal(result, &id))
            } else {
                let [id, there, back] = [
                    format!("gyro.misalignment.{one}{other}"),
                    format!("accel.misalignment.{one}{other}"),
                    format!("accel.misalignment.{other}{one}"),
                ];
                let theirs = sum(result, &[(&id, 1.0), (&there, -0.5), (&back, 0.5)]);
                (id, ARCSEC, theirs)
            };
            let own =
                [gyros.errors[(row, column)], gyros.sigmas[(row, column)]].map(|one| one / unit);
            let compared = Compared { id, own, theirs };
            assert!((0.3..3.0).contains(&compared.ratio()), "{compared:?}");
            let apart = (own[0] - theirs[0]).abs() / own[1].hypot(theirs[1]);
            assert!(apart < GYROS_APART, "{compared:?} are {apart} sigma apart");
        }
    }
}

/// The calibration of `rins` in `folder`, and the independent one, in agreement.
fn assert_agree(folder: &TempDir, samples: &Samples, priors: &Priors) -> Vec<Compared> {
    let result = result_in(folder.path(), "calibrate rig.toml --model full");
    let intervals = samples.static_intervals();
    let accels = samples::means(&samples.accel, &intervals);
    let own = Accelerometers::fit(&accels, priors);
    let compared = accelerometers(&result, &own);
    for one in &compared {
        one.assert();
    }
    let means = samples::means(&samples.gyro, &intervals);
    let up: Vec<Vector3<f64>> = accels.iter().map(|mean| own.force(mean).normalize()).collect();
    let gyros = Gyros::fit(samples, &intervals, &means, &up);
    assert_gyros(&result, &means, &gyros);
    compared
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn xsens_agrees_with_independent_least_squares() {
    let folder = outside_data("real/imu_tk_xsens");
    let offsets = [[32770.8, 32454.8, 32511.4], [33122.2, 33278.2, 32371.5]].map(Vector3::from);
    let scales = [[2.093e-4; 3], [2.41222e-3, 2.42281e-3, 2.41338e-3]].map(Vector3::from);
    let columns = ["xsens_gyro.mat", "xsens_acc.mat"]
        .map(|name| samples::rows(&fs::read_to_string(folder.join(name)).unwrap(), None));
    let physical = |triad: usize| -> Vec<Vector3<f64>> {
        let counts = columns[triad].iter().map(|row| Vector3::from_column_slice(&row[1..4]));
        counts.map(|count| (count - offsets[triad]).component_mul(&scales[triad])).collect()
    };
    let samples = Samples { interval: 0.01, gyro: physical(0), accel: physical(1) };
    let priors = Priors { bias: 10e-3, scale: 0.005, misalignment: 0.5 * DEG, gravity: 9.80653 };
    let compared = assert_agree(&rig("imu_tk_xsens"), &samples, &priors);
    // The biases drift, which an independent fit to the means does not know.
    assert!(compared.iter().all(|one| (0.7..5.0).contains(&one.ratio())));
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn mpu9150_agrees_with_independent_least_squares() {
    let log = outside_data("real/mikoff_mpu9150").join("imu0.log");
    let rows = samples::rows(&fs::read_to_string(log).unwrap(), None);
    let of = |first: usize| -> Vec<Vector3<f64>> {
        rows.iter().map(|row| Vector3::from_column_slice(&row[first..first + 3])).collect()
    };
    let samples = Samples { interval: 0.01, gyro: of(3), accel: of(0) };
    let priors = Priors { bias: 50e-3, scale: 0.03, misalignment: DEG, gravity: 9.81525 };
    let compared = assert_agree(&rig("mikoff_mpu9150"), &samples, &priors);
    assert!(compared.iter().all(|one| (0.7..3.0).contains(&one.ratio())));
}

/// Six attitudes determine the biases only together with the priors of the misalignments; the marginal values agree.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn nilspod_agrees_with_independent_least_squares() {
    let folder = rig("imucal_nilspod");
    let file = folder.path().join("rig.toml");
    let text = fs::read_to_string(&file).unwrap()
        + "\n[imu.gyro]\nnoise = \"0.01 deg/s/sqrt(Hz)\"\nbias_sigma = \"1 deg/s\"\nscale_sigma = \"3 %\"\n\
           misalignment_sigma = \"1 deg\"\n\
           [imu.accel]\nnoise = \"300 ug/sqrt(Hz)\"\nbias_sigma = \"100 mg\"\nscale_sigma = \"10 %\"\n\
           misalignment_sigma = \"1 deg\"\n";
    fs::write(&file, text).unwrap();
    let log = outside_data("real/imucal_nilspod").join("example_ferraris_session.csv");
    let rows = samples::rows(&fs::read_to_string(log).unwrap(), Some(','));
    let of = |first: usize, unit: f64| -> Vec<Vector3<f64>> {
        let vector = |row: &Vec<f64>| Vector3::from_column_slice(&row[first..first + 3]) * unit;
        rows.iter().map(vector).collect()
    };
    let samples = Samples { interval: 1.0 / 102.4, gyro: of(1, DEG), accel: of(4, 1.0) };
    let priors = Priors { bias: 0.1, scale: 0.1, misalignment: DEG, gravity: 9.80948 };
    let result = result_in(folder.path(), "calibrate rig.toml");
    let intervals = samples.static_intervals();
    let own = Accelerometers::fit(&samples::means(&samples.accel, &intervals), &priors);
    for (place, id) in
        ["bias.x", "bias.y", "bias.z", "scale.x", "scale.y", "scale.z"].iter().enumerate()
    {
        let unit = if place < 3 { MICRO_G } else { PPM };
        let id = format!("accel.{id}");
        let theirs = marginal(&result, &id);
        let own = [own.values[place] / unit, own.sigmas[place] / unit];
        Compared { id, own, theirs }.assert();
    }
}
