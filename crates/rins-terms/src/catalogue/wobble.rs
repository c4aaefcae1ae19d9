//! True motions of a table that go with its angle.

use nalgebra::Vector3;

use crate::catalogue::parameters::{cos_sin, named};
use crate::setting::{Setting, SettingKind};
use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parity, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// An axis that moves as it turns.
pub static TABLE_WOBBLE: Term = Term {
    id: "table_wobble",
    also: &[],
    name: "wobble of the axis",
    cause: "the bearing tilts the axis as the table turns; order 1 is the mounting of the IMU",
    equation: "θ_x + i θ_y = (c + i s) exp(i k ζ)",
    source: "the Fourier series of a bearing's error motion",
    parameters: &cos_sin(Unit::ARCSEC, Prior::Anywhere(0.1, 10.0)),
    settings: &[Setting {
        kind: SettingKind::Order,
        name: "order",
        meaning: "how often a turn it repeats; negative: against the table's sense",
        unit: Unit::ONE,
        default: -1.0,
        within: (-100.0, 100.0),
    }],
    needs: &[],
    partners: &["mounting", "gyro_g_sensitivity", "gyro_g2_sensitivity", "gyro_magnetic"],
    told_apart_by: "turn the table both ways; order 1 never: it is the mounting",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let (sin, cos) = sin_cos(settings[0] * moment.end.angle);
        out.add_tilt(p[0], &Vector3::new(cos, sin, 0.0));
        out.add_tilt(p[1], &Vector3::new(-sin, cos, 0.0));
    }),
};

/// A drive that is not smooth.
///
/// It is a true motion that the encoder shows too: nothing is left of it but where one is late.
/// How late, times how fast it is, is a product of two errors, and left out.
pub static TABLE_RATE_RIPPLE: Term = Term {
    id: "table_rate_ripple",
    also: &[],
    name: "ripple of the table's rate",
    cause: "cogging of the motor: the table hurries and lingers as it turns",
    equation: "dζ/dt = ω (1 + c cos nζ + s sin nζ), in gyros, accelerometers and angle alike",
    source: "the Fourier series of a motor's torque",
    parameters: &cos_sin(Unit::PPM, Prior::Anywhere(10.0, 1000.0)),
    settings: &[Setting {
        kind: SettingKind::Order,
        name: "order",
        meaning: "how often a turn it repeats",
        unit: Unit::ONE,
        default: 12.0,
        within: (1.0, 1e5),
    }],
    needs: &[],
    partners: &["gyro_lag", "encoder_latency", "accel_latency"],
    told_apart_by: "it leaves no residual; a commanded rate shows it, an encoder does not",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let order = settings[0];
        let (sin, cos) = sin_cos(order * moment.end.angle);
        let ahead = (p[0] * sin - p[1] * cos) / order;
        out.tilt[2] += ahead;
        out.angle += ahead;
    }),
};

/// A cable that pulls the axis over.
pub static CABLE_TORQUE_TILT: Term = Term {
    id: "cable_torque_tilt",
    also: &[],
    name: "tilt by the cable's torque",
    cause: "a cable winds up and pulls the axis over, the more the further the table turns",
    equation: "(θ_x, θ_y) = p ζ, ζ unwrapped",
    source: "a compliant bearing under a spring",
    parameters: &named(["x", "y"], Unit::ARCSEC_PER_TURN, Prior::Anywhere(0.01, 5.0)),
    settings: &[],
    needs: &[Need::Reversal],
    partners: &["base_tilt_ramp"],
    told_apart_by: "turn the table both ways",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        add_constant(&mut out.tilt, p, moment.end.angle);
    }),
};
