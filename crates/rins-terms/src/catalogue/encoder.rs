//! What an encoder reads wrong.

use crate::catalogue::parameters::{TIME, cos_sin, parameter};
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Need, Owner, Parity, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// A disc that is off centre.
pub static ENCODER_ECCENTRICITY: Term = Term {
    id: "encoder_eccentricity",
    also: &[],
    name: "eccentricity of the encoder",
    cause: "the encoder's disc is off centre: 412 arcsec for a micrometre a millimetre",
    equation: "angle += c cos ζ + s sin ζ",
    source: "the geometry of one reading head",
    parameters: &cos_sin(Unit::ARCSEC, Prior::Anywhere(0.5, 100.0)),
    settings: &[],
    needs: &[Need::TableAngle],
    partners: &["gyro_g_sensitivity", "gyro.misalignment", "gyro_magnetic"],
    told_apart_by: "turn the table both ways",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let (sin, cos) = sin_cos(moment.end.angle);
        out.angle += p[0] * cos + p[1] * sin;
    }),
};

/// Graduation and interpolation that repeat several times a turn.
pub static ENCODER_HARMONIC: Term = Term {
    id: "encoder_harmonic",
    also: &[],
    name: "harmonic of the encoder",
    cause: "an oval disc, an error of graduation, interpolation between two lines",
    equation: "angle += c cos nζ + s sin nζ",
    source: "the Fourier series of an encoder's error",
    parameters: &cos_sin(Unit::ARCSEC, Prior::Anywhere(0.1, 10.0)),
    settings: &[Setting {
        kind: SettingKind::Order,
        name: "order",
        meaning: "how often a turn it repeats",
        unit: Unit::ONE,
        default: 2.0,
        within: (2.0, 1e6),
    }],
    needs: &[Need::TableAngle],
    partners: &["gyro_g2_sensitivity", "interference_line"],
    told_apart_by: "turn the table both ways, and at two rates",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let (sin, cos) = sin_cos(settings[0] * moment.end.angle);
        out.angle += p[0] * cos + p[1] * sin;
    }),
};

/// A coupling that gives way.
pub static ENCODER_BACKLASH: Term = Term {
    id: "encoder_backlash",
    also: &[],
    name: "backlash of the encoder",
    cause: "play or wind-up of the encoder's coupling; before the table ever turned there is none",
    equation: "angle += β sgn(last ω)",
    source: "the definition of play, half of it either way",
    parameters: &[parameter("angle", Unit::ARCSEC, Prior::Anywhere(1.0, 60.0))],
    settings: &[],
    needs: &[Need::TableAngle, Need::Reversal],
    partners: &["encoder_latency", "encoder_slip"],
    told_apart_by: "turn both ways at two rates",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| out.angle += p[0] * moment.end.sense),
};

/// An encoder that slips or loses count.
pub static ENCODER_SLIP: Term = Term {
    id: "encoder_slip",
    also: &[],
    name: "slip of the encoder",
    cause: "the encoder slips on its shaft, or loses count",
    equation: "angle += s H(t - t0)",
    source: "a step in time",
    parameters: &[parameter("angle", Unit::ARCSEC, Prior::Anywhere(1.0, 3600.0))],
    settings: &[TIME],
    needs: &[Need::TableAngle],
    partners: &["dropped_samples", "encoder_backlash"],
    told_apart_by: "turn the other way, or at another rate, after it happened",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        if moment.end.time >= settings[0] {
            out.angle += p[0];
        }
    }),
};
