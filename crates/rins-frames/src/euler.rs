//! Roll, pitch and yaw in the sequence of eq. (5).

use nalgebra::{ComplexField, RealField};

use crate::dcm::Dcm;
use crate::frame::Frame;

/// Roll, pitch and yaw \[rad\]: `C = Rz(yaw) Rx(pitch) Ry(roll)`, which is eq. (5).
///
/// Pitch is about x (θ), roll about y (γ), yaw about z (φ_G), counter-clockwise positive.
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
    /// At a pitch of ±90° only `yaw ± roll` is defined; roll is then 0.
    pub fn euler_angles(&self) -> EulerAngles {
        let c = self.matrix();
        let level = ComplexField::sqrt(c[(2, 0)] * c[(2, 0)] + c[(2, 2)] * c[(2, 2)]);
        let pitch = RealField::atan2(c[(2, 1)], level);
        // Below this the two angles' sines and cosines are only rounding.
        if level < 1e-12 {
            return EulerAngles { roll: 0.0, pitch, yaw: RealField::atan2(c[(1, 0)], c[(0, 0)]) };
        }
        EulerAngles {
            roll: RealField::atan2(-c[(2, 0)], c[(2, 2)]),
            pitch,
            yaw: RealField::atan2(-c[(0, 1)], c[(1, 1)]),
        }
    }
}
