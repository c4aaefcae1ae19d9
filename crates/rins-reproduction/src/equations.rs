//! The printed equations with a wrong sign or term, compared with an independent evaluation.

use nalgebra::{Matrix3, Vector3};
use rins_frames::units::DEG;
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Nav, Site, cross_matrix};
use rins_motion::mechanism::{ClosedForm, Sign};
use rins_motion::{NavState, Navigator, Station, VerticalChannel};

use crate::grid::{ERRORS, turn};

/// A printed equation and its correction, compared with an evaluation that uses neither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Check {
    /// The value of the evaluation.
    pub(crate) evaluated: f64,
    /// The value of the printed equation.
    pub(crate) printed: f64,
    /// The value of the corrected equation.
    pub(crate) corrected: f64,
}

impl Check {
    /// The relative error of the printed equation.
    pub(crate) fn printed_off(&self) -> f64 {
        ((self.printed - self.evaluated) / self.evaluated).abs()
    }

    /// The relative error of the corrected equation.
    pub(crate) fn corrected_off(&self) -> f64 {
        ((self.corrected - self.evaluated) / self.evaluated).abs()
    }
}

/// The bounded `C_s^n(1,1)` term of the north velocity, by quadrature of eq. (7), after half a
/// turn \[m/s\].
///
/// "Corrected" is eq. (9) with its plus sign, "printed" the same with a minus sign, a reading of (A.7); all
/// three are the whole `δv_y` of the printed form, so that only that term differs.
pub(crate) fn bounded_term() -> Check {
    let turn = turn([30.0, 20.0, 40.0], 10.0);
    let form = ClosedForm::new(turn, ERRORS, Sign::Printed);
    let time = 18.0;
    // Simpson's rule for the acceleration error.
    let steps = 1800_u32;
    let interval = time / f64::from(steps);
    let north = |time: f64| form.acceleration_error(time).components().y;
    let evaluated: f64 = (0..steps)
        .map(|step| {
            let now = f64::from(step) * interval;
            let inner = 4.0 * north(now + 0.5 * interval);
            (north(now) + inner + north(now + interval)) * interval / 6.0
        })
        .sum();
    let corrected = form.velocity_error(time).total().components().y;
    let turned = turn.rate * time;
    let (m_xz, m_yz) = (ERRORS.misalignment_xz, ERRORS.misalignment_yz);
    let c = m_xz - m_xz * turned.cos() + m_yz * turned.sin();
    let term = turn.nav_from_table.matrix()[(0, 0)] * turn.station.gravity / turn.rate * c;
    Check { evaluated, printed: corrected - 2.0 * term, corrected }
}

/// The coefficient of `δv_z` in the second row of eq. (13), from a navigator at 100 m/s north \[1/s\].
pub(crate) fn vertical_coupling() -> Check {
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
    let station = Station::with_normal_gravity(site);
    let interval = 0.01;
    let after = |climb: f64| {
        let velocity = InFrame::new(0.0, 100.0, climb);
        let state = NavState { position: site, velocity, nav_from_body: Dcm::identity() };
        let mut navigator = Navigator::new(state, &station, VerticalChannel::Free);
        let rate = site.earth_rate() + site.transport_rate(&velocity);
        let angle = InFrame::<Body>::from_components(*rate.components() * interval);
        let velocity = InFrame::<Body>::new(0.0, 0.0, station.gravity * interval);
        navigator.step(&rins_frames::Increments { angle, velocity, interval });
        navigator.state().velocity.components().y
    };
    let step = 1.0;
    let evaluated = (after(step) - after(-step)) / (2.0 * step * interval);
    let level_rate = site.transport_rate(&InFrame::new(0.0, 100.0, 0.0)) + site.earth_rate() * 2.0;
    let coupling = level_rate.components().x;
    Check { evaluated, printed: -coupling, corrected: coupling }
}

/// The difference of eq. (19) as printed, and with the factor on the other side, from the transpose of
/// `(I - φ×) C_b^n`, relative to the magnitude of φ.
///
/// The value of the evaluation is 1, the magnitude of the error that the equation describes.
pub(crate) fn transposed_error() -> Check {
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let c_bn = angles.dcm::<Nav, Body>().matrix().transpose();
    let phi = cross_matrix(&(Vector3::new(1.0, -2.0, 2.0) * 1e-4));
    let computed = ((Matrix3::identity() - phi) * c_bn.transpose()).transpose();
    let off = |form: Matrix3<f64>| 1.0 + (form - computed).norm() / phi.norm();
    Check {
        evaluated: 1.0,
        printed: off((Matrix3::identity() - phi) * c_bn),
        corrected: off(c_bn * (Matrix3::identity() + phi)),
    }
}

/// The derivative of Z2 with respect to the north position error, `δθ_x`, in eq. (21) \[rad/s per rad\].
///
/// The computed attitude follows the computed level (ψ remains zero), and the Earth rate is
/// that of the computed position: the resulting Z2 of eq. (20) along z, at a yaw of 40°.
pub(crate) fn position_columns() -> Check {
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let c_nb: Matrix3<f64> = *angles.dcm::<Nav, Body>().matrix();
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
    let true_rate = c_nb.transpose() * site.earth_rate().components();
    let seen = |d_theta: f64| {
        // The level is tilted by δθ about east if the computed position is south by the same angle; Z2
        // uses the Earth rate of the surveyed position.
        let phi = Vector3::new(d_theta, 0.0, 0.0);
        let computed = Dcm::<Nav, Nav>::from_rotation_vector(&-phi);
        let c_nb_computed = computed.matrix() * c_nb;
        (true_rate - c_nb_computed.transpose() * site.earth_rate().components()).x
    };
    let step = 1e-5;
    let evaluated = (seen(step) - seen(-step)) / (2.0 * step);
    let column = c_nb.transpose() * site.earth_rate().cross_matrix();
    Check { evaluated, printed: 0.0, corrected: column[(0, 0)] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corrected_equations_hold_and_printed_ones_do_not() {
        // Tolerances: quadrature, a step of 10 ms, the second order of 3e-4 rad, and of 1e-5 rad.
        for (check, within) in [
            (bounded_term(), 1e-9),
            (vertical_coupling(), 1e-3),
            (transposed_error(), 1e-12),
            (position_columns(), 1e-8),
        ] {
            assert!(check.corrected_off() < within, "{check:?}");
            assert!(check.printed_off() > 0.3, "{check:?}");
        }
    }
}
