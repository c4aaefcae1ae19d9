//! Roll, pitch and yaw in the sequence of eq. (5).

use nalgebra::{ComplexField, RealField};

use crate::dcm::Dcm;
use crate::frame::Frame;

/// The cosine of the pitch below which roll consists of rounding errors only.
const LOCKED: f64 = 8.0 * f64::EPSILON;

/// Roll, pitch and yaw \[rad\]: `C = Rz(yaw) Rx(pitch) Ry(roll)`, which is eq. (5).
///
/// Pitch is about x (θ), roll about y (γ), yaw about z (`φ_G`), counter-clockwise positive.
///
/// ```
/// use rins_frames::{Dcm, EulerAngles, Nav, Table};
/// let attitude = EulerAngles { roll: 0.0, pitch: 0.1, yaw: 0.0 };
/// let nav_from_table: Dcm<Nav, Table> = attitude.dcm();
/// let forward = nav_from_table.matrix().column(1);
/// assert!((forward.z - 0.1_f64.sin()).abs() < 1e-15); // pitched up, forward points upwards
/// ```
///
/// Three angles are not a rotation until [`EulerAngles::dcm`] states its frames:
/// ```compile_fail,E0308
/// use rins_frames::{Dcm, EulerAngles, Nav, Table};
/// let nav_from_table: Dcm<Nav, Table> = EulerAngles { roll: 0.0, pitch: 0.1, yaw: 0.0 };
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EulerAngles {
    /// About y, in (-π, π].
    pub roll: f64,
    /// About x, in [-π/2, π/2].
    pub pitch: f64,
    /// About z, in (-π, π].
    pub yaw: f64,
}

impl EulerAngles {
    /// The rotation with these angles.
    pub fn dcm<To: Frame, From: Frame>(&self) -> Dcm<To, From> {
        let yawed = Dcm::<To, To>::about_z(self.yaw);
        yawed * Dcm::<To, To>::about_x(self.pitch) * Dcm::<To, From>::about_y(self.roll)
    }
}

impl<To: Frame, From: Frame> Dcm<To, From> {
    /// This rotation's angles in the sequence of eq. (5).
    ///
    /// At a pitch of ±90° only `yaw ± roll` is defined; roll is then 0. Close to it both angles
    /// lose digits, but together they still reproduce this rotation.
    pub fn euler_angles(&self) -> EulerAngles {
        let c = self.matrix();
        let level = ComplexField::sqrt(c[(2, 0)] * c[(2, 0)] + c[(2, 2)] * c[(2, 2)]);
        let pitch = RealField::atan2(c[(2, 1)], level);
        // A difference instead of a negation: -0.0 would change a roll of π to -π.
        let roll = if level < LOCKED { 0.0 } else { RealField::atan2(0.0 - c[(2, 0)], c[(2, 2)]) };
        // The first column of C Ry(-roll) = Rz(yaw) Rx(pitch) is (cos yaw, sin yaw, 0), even if roll
        // is ill-conditioned.
        let (sin, cos) = ComplexField::sin_cos(roll);
        let yaw =
            RealField::atan2(c[(1, 0)] * cos + c[(1, 2)] * sin, c[(0, 0)] * cos + c[(0, 2)] * sin);
        EulerAngles { roll, pitch, yaw }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Nav, Table};
    use core::f64::consts::{FRAC_PI_2, PI};
    use nalgebra::Matrix3;
    use proptest::prelude::*;
    use rins_testing::{any_euler_angles, assert_close};

    /// Six products and sums of numbers of order one.
    const ROUNDING: f64 = 6.0 * f64::EPSILON;

    fn angles([roll, pitch, yaw]: [f64; 3]) -> EulerAngles {
        EulerAngles { roll, pitch, yaw }
    }

    /// The matrix of eq. (5) as printed, element by element.
    fn printed(EulerAngles { roll, pitch, yaw }: EulerAngles) -> Matrix3<f64> {
        let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        Matrix3::new(
            cr * cy - sr * sp * sy,
            -cp * sy,
            sr * cy + cr * sp * sy,
            cr * sy + sr * sp * cy,
            cp * cy,
            sr * sy - cr * sp * cy,
            -sr * cp,
            sp,
            cr * cp,
        )
    }

    #[test]
    fn half_a_turn_is_plus_pi() {
        let upside_down = Dcm::<Nav, Table>::from_matrix(Matrix3::from_diagonal(
            &nalgebra::Vector3::new(-1.0, 1.0, -1.0),
        ));
        assert_close!(upside_down.unwrap().euler_angles().roll, PI, ROUNDING);
        let about = Dcm::<Nav, Table>::from_matrix(Matrix3::from_diagonal(
            &nalgebra::Vector3::new(-1.0, -1.0, 1.0),
        ));
        assert_close!(about.unwrap().euler_angles().yaw, PI, ROUNDING);
    }

    proptest! {
        #[test]
        fn sequence_is_the_printed_matrix(e in any_euler_angles()) {
            let c: Dcm<Nav, Table> = angles(e).dcm();
            prop_assert!((c.matrix() - printed(angles(e))).norm() < ROUNDING);
        }

        #[test]
        fn angles_come_back(e in any_euler_angles()) {
            let back = angles(e).dcm::<Nav, Table>().euler_angles();
            // At 0.07 rad from the pole, roll and yaw lose a factor 1/cos pitch < 15.
            prop_assert!((back.roll - e[0]).abs() < 15.0 * ROUNDING);
            prop_assert!((back.pitch - e[1]).abs() < 15.0 * ROUNDING);
            prop_assert!((back.yaw - e[2]).abs() < 15.0 * ROUNDING);
        }

        #[test]
        fn the_rotation_comes_back_however_close_to_gimbal_lock(
            [roll, _, yaw] in any_euler_angles(),
            exponent in -20.0..-1.0_f64,
        ) {
            for pitch in [FRAC_PI_2 - 10_f64.powf(exponent), 10_f64.powf(exponent) - FRAC_PI_2] {
                let c: Dcm<Nav, Table> = EulerAngles { roll, pitch, yaw }.dcm();
                let back: Dcm<Nav, Table> = c.euler_angles().dcm();
                // Roll loses what is below LOCKED.
                prop_assert!((back.matrix() - c.matrix()).norm() < ROUNDING + 2.0 * LOCKED);
            }
        }

        #[test]
        fn at_gimbal_lock_roll_is_zero_and_yaw_takes_all(
            [roll, _, yaw] in any_euler_angles(),
        ) {
            for pitch in [FRAC_PI_2, -FRAC_PI_2] {
                let back = EulerAngles { roll, pitch, yaw }.dcm::<Nav, Table>().euler_angles();
                prop_assert!(back.roll.abs() < f64::MIN_POSITIVE);
                let total = yaw + roll * pitch.signum();
                prop_assert!((back.yaw - total).sin().abs() < 2.0 * ROUNDING);
                prop_assert!((back.yaw - total).cos() > 0.0);
            }
        }
    }
}
