//! Gyro errors due to specific force and magnetic field.

use nalgebra::{Matrix3, Vector3};

use super::Instant;
use super::gyro::gyro;
use crate::effect::{Law, Read};

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    ("gyro_g_sensitivity", Law::Sense(|p, _, now| gyro(Matrix3::from_row_slice(p) * now.force))),
    ("gyro_magnetic", Law::Sense(|p, _, now| gyro(Matrix3::from_row_slice(p) * now.field))),
    ("gyro_g2_sensitivity", Law::Sense(squares)),
];

/// Each gyro has six coefficients: of xx, xy, xz, yy, yz, zz.
fn squares(p: &[f64], _: &[f64], now: &Instant) -> Read {
    let of_gyro = |number: usize| {
        let h = &p[6 * number..6 * number + 6];
        let symmetric = Matrix3::new(
            h[0],
            0.5 * h[1],
            0.5 * h[2],
            0.5 * h[1],
            h[3],
            0.5 * h[4],
            0.5 * h[2],
            0.5 * h[4],
            h[5],
        );
        now.force.dot(&(symmetric * now.force))
    };
    gyro(Vector3::new(of_gyro(0), of_gyro(1), of_gyro(2)))
}
