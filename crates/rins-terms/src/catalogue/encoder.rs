//! Errors of the encoder.

use crate::catalogue::parameters::{TIME, cos_sin, parameter};
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Need, Owner, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// Eccentric disc.
pub static ENCODER_ECCENTRICITY: Term = Term {
    id: "encoder_eccentricity",
    also: &[],
    name: "eccentricity of the encoder",
    cause: "the disc of the encoder is eccentric: 412 arcsec for 1 µm of eccentricity at a diameter of 1 mm",
    equation: "angle += c cos ζ + s sin ζ",
    source: "geometry of one reading head",
    parameters: &cos_sin(Unit::ARCSEC, Prior::Anywhere(0.5, 100.0)),
    settings: &[],
    needs: &[Need::TableAngle],
    partners: &["gyro_g_sensitivity", "gyro.misalignment", "gyro_magnetic"],
    told_apart_by: "rotate in both directions",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let (sin, cos) = sin_cos(moment.end.angle);
        out.angle += p[0] * cos + p[1] * sin;
    }),
};

/// Errors of graduation and interpolation that repeat several times per revolution.
pub static ENCODER_HARMONIC: Term = Term {
    id: "encoder_harmonic",
    also: &[],
    name: "harmonic of the encoder",
    cause: "an oval disc, errors of graduation, interpolation between two graduation lines",
    equation: "angle += c cos nζ + s sin nζ",
    source: "Fourier series of the error of an encoder",
    parameters: &cos_sin(Unit::ARCSEC, Prior::Anywhere(0.1, 10.0)),
    settings: &[Setting {
        kind: SettingKind::Order,
        name: "order",
        meaning: "harmonic order: periods per revolution",
        unit: Unit::ONE,
        default: 2.0,
        within: (2.0, 1e6),
    }],
    needs: &[Need::TableAngle],
    partners: &["gyro_g2_sensitivity", "interference_line"],
    told_apart_by: "rotate in both directions, and at two rates",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let (sin, cos) = sin_cos(settings[0] * moment.end.angle);
        out.angle += p[0] * cos + p[1] * sin;
    }),
};

/// Play of a coupling.
pub static ENCODER_BACKLASH: Term = Term {
    id: "encoder_backlash",
    also: &[],
    name: "backlash of the encoder",
    cause: "play or wind-up of the coupling of the encoder; zero before the first rotation",
    equation: "angle += β sgn(last ω)",
    source: "definition of play: half of it to either side",
    parameters: &[parameter("angle", Unit::ARCSEC, Prior::Anywhere(1.0, 60.0))],
    settings: &[],
    needs: &[Need::TableAngle, Need::Reversal],
    partners: &["encoder_latency", "encoder_slip"],
    told_apart_by: "rotate in both directions at two rates",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| out.angle += p[0] * moment.end.sense),
};

/// Slip of the encoder, or lost counts.
pub static ENCODER_SLIP: Term = Term {
    id: "encoder_slip",
    also: &[],
    name: "slip of the encoder",
    cause: "the encoder slips on its shaft, or loses counts",
    equation: "angle += s H(t - t0)",
    source: "step in time",
    parameters: &[parameter("angle", Unit::ARCSEC, Prior::Anywhere(1.0, 3600.0))],
    settings: &[TIME],
    needs: &[Need::TableAngle],
    partners: &["dropped_samples", "encoder_backlash"],
    told_apart_by: "rotate in the other direction, or at another rate, after the event",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        if moment.end.time >= settings[0] {
            out.angle += p[0];
        }
    }),
};
