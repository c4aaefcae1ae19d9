//! The paper's closed forms, eqs. (6), (8) and (9).

use rins_frames::{InFrame, Nav, Table};

use super::errors::{ConstantTurn, SpinAxisErrors};

/// The sign of a gyro error in the attitude error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// The sign as printed in eqs. (6), (8) and (9): `φ' = +C_b^n δω`, which is wrong for every navigator.
    Printed,
    /// The sign of eq. (12) and of a strapdown navigator: `φ' = -C_b^n δω`.
    Strapdown,
}

/// The errors of a navigator on a flat Earth that does not rotate, to first order.
///
/// The three errors of the spin axis act on a table with a constant rate; the accelerometers have no errors.
///
/// ```
/// use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND, PPM};
/// use rins_frames::{EulerAngles, Site};
/// use rins_motion::Station;
/// use rins_motion::mechanism::{ClosedForm, ConstantTurn, Sign, SpinAxisErrors};
/// let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
/// let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
/// let turn = ConstantTurn {
///     station: Station::with_normal_gravity(site),
///     nav_from_table: angles.dcm(),
///     rate: 10.0 * DEG_PER_SECOND,
/// };
/// let errors = SpinAxisErrors {
///     misalignment_xz: 60.0 * ARCSEC,
///     misalignment_yz: 60.0 * ARCSEC,
///     scale_z: 300.0 * PPM,
/// };
/// let form = ClosedForm::new(turn, errors, Sign::Strapdown);
/// let after_ten_turns = form.velocity_error(360.0);
/// assert!(after_ten_turns.bounded.norm() < 1e-9);
/// assert!((after_ten_turns.diverging.components().y + 17.87).abs() < 0.01); // to the south
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedForm {
    /// The table's motion.
    pub turn: ConstantTurn,
    /// The gyro errors.
    pub errors: SpinAxisErrors,
    /// The sign, printed or correct.
    pub sign: Sign,
    /// `φ(0)` \[rad\].
    pub initial_attitude: InFrame<Nav>,
    /// `δv(0)` \[m/s\].
    pub initial_velocity: InFrame<Nav>,
}

/// A velocity error in the two brackets of eqs. (8) and (9) \[m/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityError {
    /// The first bracket: the part that rotates with the table, and the initial error.
    pub bounded: InFrame<Nav>,
    /// The second bracket: the part that grows with time and with its square.
    pub diverging: InFrame<Nav>,
}

impl VelocityError {
    /// The sum of both.
    pub fn total(&self) -> InFrame<Nav> {
        self.bounded + self.diverging
    }
}

impl ClosedForm {
    /// The form with no initial errors.
    pub fn new(turn: ConstantTurn, errors: SpinAxisErrors, sign: Sign) -> Self {
        let none = InFrame::zeros();
        Self { turn, errors, sign, initial_attitude: none, initial_velocity: none }
    }

    /// The attitude error `φ(t)` after `time` \[s\], eq. (6) \[rad\].
    ///
    /// With [`Sign::Strapdown`], the printed accumulated part with its sign reversed.
    pub fn attitude_error(&self, time: f64) -> InFrame<Nav> {
        let SpinAxisErrors { misalignment_xz: m_xz, misalignment_yz: m_yz, scale_z } = self.errors;
        let turned = self.turn.rate * time;
        let (sin, versine) = (turned.sin(), versine(turned));
        let accumulated: InFrame<Table> = InFrame::new(
            m_xz * sin - m_yz * versine,
            m_xz * versine + m_yz * sin,
            scale_z * turned,
        );
        self.initial_attitude + self.turn.nav_from_table * accumulated * self.factor()
    }

    /// The velocity error after `time` \[s\], eqs. (8) and (9); the vertical component is only the initial one.
    ///
    /// The bounded term in `C_s^n(1, 1)` is positive with the printed sign, as in eq. (9): with a minus there, as one could
    /// read eq. (A.7), the form would not be the integral of eq. (7).
    pub fn velocity_error(&self, time: f64) -> VelocityError {
        let SpinAxisErrors { misalignment_xz: m_xz, misalignment_yz: m_yz, scale_z } = self.errors;
        let (gravity, rate) = (self.turn.station.gravity, self.turn.rate);
        let turned = rate * time;
        // sin ωt / ω and (1 - cos ωt) / ω, which stay finite on a stationary table.
        let (sine, versine) =
            if turned == 0.0 { (time, 0.0) } else { (turned.sin() / rate, versine(turned) / rate) };
        // The integrals over time of the two level components of eq. (6) in s, separated by their growth.
        let bounded: InFrame<Table> =
            InFrame::new(m_xz * versine + m_yz * sine, m_yz * versine - m_xz * sine, 0.0);
        let diverging: InFrame<Table> =
            InFrame::new(-m_yz * time, m_xz * time, scale_z * 0.5 * turned * time);
        let resolved = |integral| self.turn.nav_from_table * integral * self.factor();
        VelocityError {
            bounded: self.initial_velocity + by_gravity(gravity, resolved(bounded)),
            diverging: by_gravity(gravity, self.initial_attitude * time + resolved(diverging)),
        }
    }

    /// The rate of the velocity error at `time` \[s\], eq. (7) without accelerometer errors \[m/s²\].
    pub fn acceleration_error(&self, time: f64) -> InFrame<Nav> {
        by_gravity(self.turn.station.gravity, self.attitude_error(time))
    }

    fn factor(&self) -> f64 {
        match self.sign {
            Sign::Printed => 1.0,
            Sign::Strapdown => -1.0,
        }
    }
}

/// `f^n × φ` with gravity's reaction for `f^n`: `(-g φ_y, g φ_x, 0)`, eq. (7).
fn by_gravity(gravity: f64, attitude: InFrame<Nav>) -> InFrame<Nav> {
    InFrame::new(0.0, 0.0, gravity).cross(&attitude)
}

/// `1 - cos x` without cancellation.
fn versine(angle: f64) -> f64 {
    let half = (0.5 * angle).sin();
    2.0 * half * half
}
