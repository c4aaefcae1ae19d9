//! Readings that are late: of gyros, accelerometers and the encoder.
//!
//! A late reading is that of an earlier instant, the acceleration over the sample going on: exact at any
//! constant rate and along any ramp.

use nalgebra::Vector3;
use num_dual::{Dual64, DualNum};

use crate::catalogue::parameters::{TIME, parameter, usual};
use crate::moment::{Instant, Moment, Stretch};
use crate::signals::DualVector;
use crate::term::{Action, Need, Owner, Parameter, Parity, Prior, Term};
use crate::unit::Unit;

const fn delay(prior: Prior) -> Parameter {
    parameter("delay", Unit::MILLISECOND, prior)
}

/// How far the table turned over the last `delay` before an instant at this rate \[rad\], or turns over the next one if it
/// is negative; `before` and `after` are what comes before the instant and after it.
fn turned_within(delay: Dual64, rate: f64, [before, after]: [Stretch; 2]) -> Dual64 {
    if delay.re < 0.0 {
        -after.turned(-delay, rate, after.acceleration)
    } else {
        before.turned(delay, rate, -before.acceleration)
    }
}

/// The sample that a moment is of.
fn own(moment: &Moment) -> Stretch {
    let Instant { rate, acceleration, .. } = moment.mean;
    Stretch { duration: moment.interval, rate, acceleration }
}

/// The same from the end of a sample.
fn turned_to_end(delay: Dual64, moment: &Moment) -> Dual64 {
    turned_within(delay, moment.end.rate, [own(moment), moment.beside[1]])
}

/// The same from its middle.
fn turned_to_middle(delay: Dual64, moment: &Moment) -> Dual64 {
    delay * moment.mean.rate - delay * delay * (0.5 * moment.mean.acceleration)
}

/// Adds by how much `vector`, of fixed direction in the axis frame, differed when the table stood
/// back by `turn`.
fn add_earlier(to: &mut DualVector, vector: &Vector3<f64>, turn: Dual64) {
    let half = (turn * 0.5).sin();
    let (sin, versine) = (turn.sin(), half * half * 2.0);
    to[0] -= versine * vector.x + sin * vector.y;
    to[1] += sin * vector.x - versine * vector.y;
}

/// Gyros that are read late.
pub static GYRO_LAG: Term = Term {
    id: "gyro_lag",
    also: &[],
    name: "lag of the gyros",
    cause: "filters and electronics delay the gyros against the stamps of the samples",
    equation: "gyro = ω(t - τ)",
    source: "the definition of a pure delay",
    parameters: &[delay(usual((0.1, 5.0), (0.5, 10.0), (2.0, 20.0)))],
    settings: &[],
    needs: &[Need::Reversal],
    partners: &["encoder_latency", "accel_latency", "encoder.zero"],
    told_apart_by: "ramps show the gyros against the encoder; only two of the three delays exist, but for \
                    what the Earth's rate shows of the third",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        add_earlier(&mut out.gyro, &moment.rate, turned_to_middle(p[0], moment));
        // The rate over as long a time before: both its ends are late.
        let start = moment.end.rate - moment.mean.acceleration * moment.interval;
        let to_start = turned_within(p[0], start, [moment.beside[0], own(moment)]);
        let late = turned_to_end(p[0], moment) - to_start;
        out.gyro[2] -= late / moment.interval;
    }),
};

/// Accelerometers that are read late.
pub static ACCEL_LATENCY: Term = Term {
    id: "accel_latency",
    also: &[],
    name: "latency of the accelerometers",
    cause: "the accelerometers are delayed against the stamps of the samples; half a sample is a convention",
    equation: "accel = f(t - τ)",
    source: "the definition of a pure delay",
    parameters: &[delay(usual((0.05, 10.0), (0.05, 10.0), (0.05, 10.0)))],
    settings: &[],
    needs: &[Need::Tilt, Need::Reversal],
    partners: &["gyro_lag", "encoder.zero", "axis.attitude", "gyro_magnetic"],
    told_apart_by: "turn the table both ways",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        add_earlier(&mut out.accel, &moment.force, turned_to_middle(p[0], moment));
    }),
};

/// An angle that is read late.
///
/// A reference of attitude that lags is the same.
pub static ENCODER_LATENCY: Term = Term {
    id: "encoder_latency",
    also: &["readout_lag"],
    name: "latency of the table angle",
    cause: "the angle, or the attitude it stands for, is that of an earlier instant; half a sample is a convention",
    equation: "angle = ζ(t - τ)",
    source: "the definition of a pure delay",
    parameters: &[delay(Prior::Anywhere(0.1, 20.0))],
    settings: &[],
    needs: &[Need::TableAngle, Need::Reversal],
    partners: &[
        "gyro_lag",
        "encoder_backlash",
        "clock_drift",
        "gyro_scale_asymmetry",
        "encoder.zero",
    ],
    told_apart_by: "turn both ways at two rates, with several reversals",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| out.angle -= turned_to_end(p[0], moment)),
};

/// An encoder whose clock is not the IMU's.
pub static CLOCK_DRIFT: Term = Term {
    id: "clock_drift",
    also: &[],
    name: "drift of the encoder's clock",
    cause: "the encoder's time stamps drift against the IMU's: a delay that grows",
    equation: "angle = ζ(t - ε t)",
    source: "the definition of a clock's rate error",
    parameters: &[parameter("rate", Unit::PPM, Prior::Anywhere(1.0, 50.0))],
    settings: &[],
    needs: &[Need::TableAngle, Need::Reversal],
    partners: &["encoder_latency", "base_tilt_ramp", "gyro_scale_ramp", "gyro.scale"],
    told_apart_by: "several reversals, spread over the run",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        out.angle -= turned_to_end(p[0] * moment.end.time, moment);
    }),
};

/// Angles that were lost from the encoder's records.
///
/// Records that were read twice are a negative loss.
pub static DROPPED_SAMPLES: Term = Term {
    id: "dropped_samples",
    also: &[],
    name: "dropped samples of the encoder",
    cause: "angles are lost between encoder and log and nobody counts them: all later ones come too soon",
    equation: "angle = ζ(t + τ H(t - t0))",
    source: "pairing of records by their number",
    parameters: &[parameter("lost", Unit::MILLISECOND, Prior::Anywhere(1.0, 100.0))],
    settings: &[TIME],
    needs: &[Need::TableAngle],
    partners: &["encoder_slip", "encoder_latency"],
    told_apart_by: "turn the other way, or at another rate, after it happened",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        if moment.end.time >= settings[0] {
            out.angle -= turned_to_end(-p[0], moment);
        }
    }),
};
