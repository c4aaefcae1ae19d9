//! Motions of the table that depend on the table angle.

use nalgebra::Vector3;

use crate::catalogue::parameters::{cos_sin, named};
use crate::setting::{Setting, SettingKind};
use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// Motion of the spin axis with the table angle.
pub static TABLE_WOBBLE: Term = Term {
    id: "table_wobble",
    also: &[],
    name: "wobble of the spin axis",
    cause: "the bearing tilts the spin axis as the table rotates; order 1 is the mounting of the IMU",
    equation: "θ_x + i θ_y = (c + i s) exp(i k ζ)",
    source: "Fourier series of the error motion of a bearing",
    parameters: &cos_sin(Unit::ARCSEC, Prior::Anywhere(0.1, 10.0)),
    settings: &[Setting {
        kind: SettingKind::Order,
        name: "order",
        meaning: "harmonic order: periods per revolution; negative: opposite to the direction of rotation",
        unit: Unit::ONE,
        default: -1.0,
        within: (-100.0, 100.0),
    }],
    needs: &[],
    partners: &["mounting", "gyro_g_sensitivity", "gyro_g2_sensitivity", "gyro_magnetic"],
    told_apart_by: "rotate in both directions; no test for order 1: it is the mounting",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let (sin, cos) = sin_cos(settings[0] * moment.end.angle);
        out.add_tilt(p[0], &Vector3::new(cos, sin, 0.0));
        out.add_tilt(p[1], &Vector3::new(-sin, cos, 0.0));
    }),
};

/// Irregular rotation of the drive.
///
/// It is a true motion, which the encoder measures too: only a latency leaves a residual.
/// Latency times ripple is a product of two errors and is neglected.
pub static TABLE_RATE_RIPPLE: Term = Term {
    id: "table_rate_ripple",
    also: &[],
    name: "ripple of the table rate",
    cause: "cogging of the motor: the table rate varies with the table angle",
    equation: "dζ/dt = ω (1 + c cos nζ + s sin nζ), in gyros, accelerometers and angle",
    source: "Fourier series of the torque of a motor",
    parameters: &cos_sin(Unit::PPM, Prior::Anywhere(10.0, 1000.0)),
    settings: &[Setting {
        kind: SettingKind::Order,
        name: "order",
        meaning: "harmonic order: periods per revolution",
        unit: Unit::ONE,
        default: 12.0,
        within: (1.0, 1e5),
    }],
    needs: &[],
    partners: &["gyro_lag", "encoder_latency", "accel_latency"],
    told_apart_by: "no residual if the encoder measures the angle; a residual if only the commanded rate is known",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let order = settings[0];
        let (sin, cos) = sin_cos(order * moment.end.angle);
        let ahead = (p[0] * sin - p[1] * cos) / order;
        out.tilt[2] += ahead;
        out.angle += ahead;
    }),
};

/// Torque of a cable on the spin axis.
pub static CABLE_TORQUE_TILT: Term = Term {
    id: "cable_torque_tilt",
    also: &[],
    name: "tilt by cable torque",
    cause: "a cable winds up and tilts the spin axis in proportion to the table angle",
    equation: "(θ_x, θ_y) = p ζ, ζ unwrapped",
    source: "compliant bearing with a spring",
    parameters: &named(["x", "y"], Unit::ARCSEC_PER_TURN, Prior::Anywhere(0.01, 5.0)),
    settings: &[],
    needs: &[Need::Reversal],
    partners: &["base_tilt_ramp"],
    told_apart_by: "rotate in both directions",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        add_constant(&mut out.tilt, p, moment.end.angle);
    }),
};
