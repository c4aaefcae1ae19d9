//! A signal of a sensor of any shape that repeats every revolution.

use rins_terms::{
    Action, Dual64, KinematicState, Owner, Parameter, Parity, Prevalence, Prior, SettingKind,
    Signals, Term, TermInstance, Unit, catalogue::AXIS, sin_cos,
};

use crate::generic::disturbance::{ACCEL, GYRO, of};

/// The harmonic orders of a waveform: they hold 99 % of the power of a pulse of 9° (1σ).
pub(crate) const WAVEFORM_ORDERS: u32 = 12;

const fn waveform(
    id: &'static str,
    name: &'static str,
    parameters: &'static [Parameter],
    act: fn(&[Dual64], &[f64], &KinematicState, &mut Signals),
) -> Term {
    Term {
        id,
        also: &[],
        name,
        cause: "unknown",
        equation: "sensor += Σ c_k cos kζ + s_k sin kζ",
        source: "none: a description, not a cause",
        parameters,
        settings: &[AXIS],
        needs: &[],
        partners: &[],
        told_apart_by: "",
        owner: Owner::Run,
        prevalence: Prevalence::Unknown,
        parity: Parity::OfSetting,
        action: Action::Signal(act),
    }
}

/// The names of the amplitudes of a waveform.
const AMPLITUDES: [&str; 24] = [
    "1_cos", "1_sin", "2_cos", "2_sin", "3_cos", "3_sin", "4_cos", "4_sin", "5_cos", "5_sin",
    "6_cos", "6_sin", "7_cos", "7_sin", "8_cos", "8_sin", "9_cos", "9_sin", "10_cos", "10_sin",
    "11_cos", "11_sin", "12_cos", "12_sin",
];

const fn amplitudes(unit: Unit, prior: Prior) -> [Parameter; AMPLITUDES.len()] {
    let mut all = [of("", unit, prior); AMPLITUDES.len()];
    let mut place = 0;
    while place < all.len() {
        all[place] = of(AMPLITUDES[place], unit, prior);
        place += 1;
    }
    all
}

/// On a gyro, repeated every revolution.
pub(crate) static GYRO_WAVEFORM: Term = waveform(
    "gyro_waveform",
    "waveform of a gyro that repeats every revolution",
    const { &amplitudes(Unit::DEG_PER_HOUR, GYRO) },
    |p, settings, moment, out| {
        if let Some(axis) = place_of(settings) {
            out.gyro[axis] += repeated(p, moment.mean.angle);
        }
    },
);

/// On an accelerometer, repeated every revolution.
pub(crate) static ACCEL_WAVEFORM: Term = waveform(
    "accel_waveform",
    "waveform of an accelerometer that repeats every revolution",
    const { &amplitudes(Unit::MICRO_G, ACCEL) },
    |p, settings, moment, out| {
        if let Some(axis) = place_of(settings) {
            out.accel[axis] += repeated(p, moment.mean.angle);
        }
    },
);

/// The terms of waveforms, in the order of [`CHANNELS`].
pub(crate) static WAVEFORMS: [&Term; 2] = [&GYRO_WAVEFORM, &ACCEL_WAVEFORM];

/// The waveform of a channel of a sensor.
pub(crate) fn on_channel(channel: usize) -> Option<TermInstance> {
    let term = *WAVEFORMS.get(channel / 3)?;
    let axis = AXES.get(channel % 3)?;
    Some(TermInstance::new(term).estimated().with_setting(SettingKind::Axis, *axis))
}

/// The channel of a waveform, if it is one.
pub(crate) fn channel_of(waveform: &Term, settings: &[f64]) -> Option<usize> {
    let triad = WAVEFORMS.iter().position(|term| term.is(waveform))?;
    Some(3 * triad + place_of(settings)?)
}

/// The axes as settings.
const AXES: [f64; 3] = [1.0, 2.0, 3.0];

fn place_of(settings: &[f64]) -> Option<usize> {
    AXES.iter().position(|axis| (axis - settings[0]).abs() < 0.5)
}

fn repeated(p: &[Dual64], angle: f64) -> Dual64 {
    let mut sum = Dual64::from(0.0);
    let mut order = 0.0;
    for pair in p.chunks_exact(2) {
        order += 1.0;
        let (sin, cos) = sin_cos(order * angle);
        sum += pair[0] * cos + pair[1] * sin;
    }
    sum
}

/// Whether a term describes a waveform of any shape.
pub(crate) fn is_waveform(term: &Term) -> bool {
    WAVEFORMS.iter().any(|one| one.is(term))
}
