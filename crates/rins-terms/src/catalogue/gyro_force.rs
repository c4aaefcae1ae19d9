//! Sensitivity of the gyros to specific force and to the magnetic field.

use num_dual::Dual64;

use crate::catalogue::parameters::{matrix, named, usual};
use crate::signals::add_matrix;
use crate::term::{Action, Need, Owner, Parity, Prevalence, Term};
use crate::unit::Unit;

/// Sensitivity to the specific force.
pub static GYRO_G_SENSITIVITY: Term = Term {
    id: "gyro_g_sensitivity",
    also: &[],
    name: "g-sensitivity of the gyros",
    cause: "mass unbalance, or stress in a coil; zx: error of gyro z by specific force along x",
    equation: "gyro += G f",
    source: "titterton2004",
    parameters: &matrix(Unit::DEG_PER_HOUR_PER_G, usual((0.001, 0.1), (5e-4, 0.01), (1.0, 100.0))),
    settings: &[],
    needs: &[Need::Tilt],
    partners: &[
        "gyro_magnetic",
        "gyro.misalignment",
        "axis.attitude",
        "encoder_eccentricity",
        "table_wobble",
    ],
    told_apart_by: "rotate in both directions; tilt the spin axis to other angles; for the field, a third one",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| add_matrix(&mut out.gyro, p, &moment.force)),
};

/// Sensitivity to products of specific forces.
pub static GYRO_G2_SENSITIVITY: Term = Term {
    id: "gyro_g2_sensitivity",
    also: &[],
    name: "g²-sensitivity of the gyros",
    cause: "unequal stiffness along two axes; x_yz: error of gyro x by force along y times force along z",
    equation: "gyro_i += Σ H_i,jk f_j f_k, j ≤ k",
    source: "titterton2004",
    parameters: &named(
        [
            "x_xx", "x_xy", "x_xz", "x_yy", "x_yz", "x_zz", "y_xx", "y_xy", "y_xz", "y_yy", "y_yz",
            "y_zz", "z_xx", "z_xy", "z_xz", "z_yy", "z_yz", "z_zz",
        ],
        Unit::DEG_PER_HOUR_PER_G2,
        usual((0.001, 0.01), (1e-4, 0.001), (0.1, 10.0)),
    ),
    settings: &[],
    needs: &[Need::SeveralTilts],
    partners: &["table_wobble", "encoder_harmonic", "gyro_g_sensitivity"],
    told_apart_by: "rotate in both directions; tilt the spin axis to other angles",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        let f = moment.force;
        let products = [f.x * f.x, f.x * f.y, f.x * f.z, f.y * f.y, f.y * f.z, f.z * f.z];
        for (gyro, coefficients) in out.gyro.iter_mut().zip(p.chunks_exact(products.len())) {
            let sum = |sum: Dual64, (&h, product): (&Dual64, f64)| sum + h * product;
            *gyro = coefficients.iter().zip(products).fold(*gyro, sum);
        }
    }),
};

/// Sensitivity to the magnetic field.
pub static GYRO_MAGNETIC: Term = Term {
    id: "gyro_magnetic",
    also: &[],
    name: "magnetic sensitivity of the gyros",
    cause: "Faraday effect in a twisted fiber, or in a gas discharge; zx: error of gyro z by a field along x",
    equation: "gyro += K B",
    source: "linear in the flux density",
    parameters: &matrix(
        Unit::DEG_PER_HOUR_PER_GAUSS,
        usual((0.001, 5.0), (0.001, 0.05), (0.01, 1.0)),
    ),
    settings: &[],
    needs: &[Need::MagneticField],
    partners: &["gyro_g_sensitivity", "wrong_latitude", "gyro.scale", "accel_latency"],
    told_apart_by: "three directions of the spin axis, or a magnet, or a magnetic shield",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        add_matrix(&mut out.gyro, p, &moment.magnetic_field());
    }),
};
