//! Eq. (1): bias, scale and misalignment of both triads.

use nalgebra::Vector3;
use num_dual::Dual64;

use crate::signals::{DualVector, add_constant, add_scaled};
use crate::term::{Action, Need, Owner, Parameter, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

/// Rows and columns of the misalignments, in the order of their names.
const OFF_DIAGONAL: [(usize, usize); 6] = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];

const fn bias(name: &'static str, unit: Unit, prior: Prior) -> Parameter {
    Parameter { name, unit, prior }
}

const GYRO_BIASES: Prior = Prior::Sheet(|imu| imu.gyro.bias_sigma);
const ACCEL_BIASES: Prior = Prior::Sheet(|imu| imu.accel.bias_sigma);
const GYRO_SCALES: Prior = Prior::Sheet(|imu| imu.gyro.scale_sigma);
const ACCEL_SCALES: Prior = Prior::Sheet(|imu| imu.accel.scale_sigma);
const GYRO_MISALIGNMENTS: Prior = Prior::Sheet(|imu| imu.gyro.misalignment_sigma);
const ACCEL_MISALIGNMENTS: Prior = Prior::Sheet(|imu| imu.accel.misalignment_sigma);

macro_rules! triple {
    ($unit:expr, $prior:expr) => {
        &[bias("x", $unit, $prior), bias("y", $unit, $prior), bias("z", $unit, $prior)]
    };
}

macro_rules! off_diagonal {
    ($prior:expr) => {
        &[
            bias("xy", Unit::ARCSEC, $prior),
            bias("xz", Unit::ARCSEC, $prior),
            bias("yx", Unit::ARCSEC, $prior),
            bias("yz", Unit::ARCSEC, $prior),
            bias("zx", Unit::ARCSEC, $prior),
            bias("zy", Unit::ARCSEC, $prior),
        ]
    };
}

fn add_crossed(to: &mut DualVector, p: &[Dual64], of: &Vector3<f64>) {
    for (&p, (row, column)) in p.iter().zip(OFF_DIAGONAL) {
        to[row] += p * of[column];
    }
}

/// Gyro biases.
pub static GYRO_BIAS: Term = Term {
    id: "gyro.bias",
    also: &[],
    name: "gyro bias",
    cause: "reading of a gyro without rotation relative to inertial space, constant from turn-on to turn-off",
    equation: "gyro += b",
    source: "nie2019, eq. (1)",
    parameters: triple!(Unit::DEG_PER_HOUR, GYRO_BIASES),
    settings: &[],
    needs: &[],
    partners: &["gyro.misalignment", "gyro.scale"],
    told_apart_by: "rotate in both directions, or at two rates",
    owner: Owner::PowerOn,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, _, out| add_constant(&mut out.gyro, p, 1.0)),
};

/// Gyro scale errors.
pub static GYRO_SCALE: Term = Term {
    id: "gyro.scale",
    also: &[],
    name: "gyro scale error",
    cause: "the scale factor of a gyro differs from its nominal value",
    equation: "gyro += S ω",
    source: "nie2019, eq. (1)",
    parameters: triple!(Unit::PPM, GYRO_SCALES),
    settings: &[],
    needs: &[],
    partners: &["gyro.bias", "wrong_latitude", "clock_drift"],
    told_apart_by: "rotate in both directions, or at two rates; for x and y, two tilts of the spin axis",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| add_scaled(&mut out.gyro, p, &moment.rate)),
};

/// Gyro misalignments.
pub static GYRO_MISALIGNMENT: Term = Term {
    id: "gyro.misalignment",
    also: &[],
    name: "gyro misalignment",
    cause: "the input axis of a gyro differs from its body axis; xz: fraction of a rate about z in gyro x",
    equation: "gyro += M ω, M zero on its diagonal",
    source: "nie2019, eq. (1)",
    parameters: off_diagonal!(GYRO_MISALIGNMENTS),
    settings: &[],
    needs: &[],
    partners: &["gyro.bias", "accel.misalignment", "gyro_g_sensitivity"],
    told_apart_by: "rotate in both directions, or at two rates; for zx and zy, two tilts of the spin axis",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| add_crossed(&mut out.gyro, p, &moment.rate)),
};

/// Accelerometer biases.
pub static ACCEL_BIAS: Term = Term {
    id: "accel.bias",
    also: &[],
    name: "accelerometer bias",
    cause: "reading of an accelerometer in free fall, constant from turn-on to turn-off",
    equation: "accel += b",
    source: "nie2019, eq. (1)",
    parameters: triple!(Unit::MICRO_G, ACCEL_BIASES),
    settings: &[],
    needs: &[],
    partners: &["accel.scale", "accel_lever_arm"],
    told_apart_by: "tilt the spin axis to other angles; rotate at two rates",
    owner: Owner::PowerOn,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, _, out| add_constant(&mut out.accel, p, 1.0)),
};

/// Accelerometer scale errors.
pub static ACCEL_SCALE: Term = Term {
    id: "accel.scale",
    also: &["accel_scale"],
    name: "accelerometer scale error",
    cause: "the scale factor of an accelerometer differs from its nominal value",
    equation: "accel += S f",
    source: "nie2019, eq. (1)",
    parameters: triple!(Unit::PPM, ACCEL_SCALES),
    settings: &[],
    needs: &[Need::Tilt],
    partners: &["axis.attitude", "wrong_gravity", "accel.bias"],
    told_apart_by: "tilt the spin axis to other angles",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| add_scaled(&mut out.accel, p, &moment.force)),
};

/// Accelerometer misalignments.
pub static ACCEL_MISALIGNMENT: Term = Term {
    id: "accel.misalignment",
    also: &["accel_misalignment"],
    name: "accelerometer misalignment",
    cause: "the input axis of an accelerometer differs from its body axis; xz: fraction of a force along z in x",
    equation: "accel += M f, M zero on its diagonal",
    source: "nie2019, eq. (1)",
    parameters: off_diagonal!(ACCEL_MISALIGNMENTS),
    settings: &[],
    needs: &[Need::Tilt],
    partners: &["axis.attitude", "gyro.misalignment", "mounting", "accel.bias"],
    told_apart_by: "tilt the spin axis to other angles",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| add_crossed(&mut out.accel, p, &moment.force)),
};
