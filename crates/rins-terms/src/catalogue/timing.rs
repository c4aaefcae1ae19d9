//! Latency of gyros, accelerometers and the encoder.
//!
//! A delayed reading is that of an earlier time.

use nalgebra::Vector3;
use num_dual::{Dual64, DualNum};

use crate::catalogue::parameters::{TIME, parameter, usual};
use crate::kinematic_state::KinematicState;
use crate::signals::DualVector;
use crate::term::{Action, Need, Owner, Parameter, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

const fn delay(prior: Prior) -> Parameter {
    parameter("delay", Unit::MILLISECOND, prior)
}

/// Rotation of the table during `delay` before the end of the sample \[rad\].
fn turned_to_end(delay: Dual64, moment: &KinematicState) -> Dual64 {
    moment.turned_before(&moment.end, delay)
}

/// The same before the time at which the table has the mean angle of the sample.
fn turned_to_middle(delay: Dual64, moment: &KinematicState) -> Dual64 {
    moment.turned_before(&moment.mean, delay)
}

/// Adds the change of `vector`, constant in the axis frame, if the table angle is smaller by `turn`.
fn add_earlier(to: &mut DualVector, vector: &Vector3<f64>, turn: Dual64) {
    let half = (turn * 0.5).sin();
    let (sin, versine) = (turn.sin(), half * half * 2.0);
    to[0] -= versine * vector.x + sin * vector.y;
    to[1] += sin * vector.x - versine * vector.y;
}

/// Latency of the gyros.
pub static GYRO_LAG: Term = Term {
    id: "gyro_lag",
    also: &[],
    name: "latency of the gyros",
    cause: "filters and electronics delay the gyros relative to the time stamps of the samples",
    equation: "gyro = ω(t - τ)",
    source: "definition of a pure delay",
    parameters: &[delay(usual((0.1, 5.0), (0.5, 10.0), (2.0, 20.0)))],
    settings: &[],
    needs: &[Need::Reversal],
    partners: &["encoder_latency", "accel_latency", "encoder.zero"],
    told_apart_by: "ramps of the rate, gyros against the encoder; only two of the three latencies are \
                    observable, apart from the effect of the Earth's rate",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        add_earlier(&mut out.gyro, &moment.rate, turned_to_middle(p[0], moment));
        // The rate over an interval of equal length before: both its ends are delayed.
        let turned = moment.mean.rate * moment.interval;
        let late =
            turned_to_end(p[0], moment) - turned_to_end(p[0] + moment.interval, moment) + turned;
        out.gyro[2] -= late / moment.interval;
    }),
};

/// Latency of the accelerometers.
pub static ACCEL_LATENCY: Term = Term {
    id: "accel_latency",
    also: &[],
    name: "latency of the accelerometers",
    cause: "the accelerometers are delayed relative to the time stamps of the samples; half a sample is a convention",
    equation: "accel = f(t - τ)",
    source: "definition of a pure delay",
    parameters: &[delay(usual((0.05, 10.0), (0.05, 10.0), (0.05, 10.0)))],
    settings: &[],
    needs: &[Need::Tilt, Need::Reversal],
    partners: &["gyro_lag", "encoder.zero", "axis.attitude", "gyro_magnetic"],
    told_apart_by: "rotate in both directions",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        add_earlier(&mut out.accel, &moment.force, turned_to_middle(p[0], moment));
    }),
};

/// Latency of the table angle.
///
/// The latency of an attitude reference is the same effect.
pub static ENCODER_LATENCY: Term = Term {
    id: "encoder_latency",
    also: &["readout_lag"],
    name: "latency of the table angle",
    cause: "the angle, or the attitude reference, is older than the IMU sample; half a sample is a convention",
    equation: "angle = ζ(t - τ)",
    source: "definition of a pure delay",
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
    told_apart_by: "rotate in both directions at two rates, with several reversals",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| out.angle -= turned_to_end(p[0], moment)),
};

/// Rate error of the clock of the encoder.
pub static CLOCK_DRIFT: Term = Term {
    id: "clock_drift",
    also: &[],
    name: "drift of the encoder clock",
    cause: "the time stamps of the encoder drift relative to those of the IMU: an increasing latency",
    equation: "angle = ζ(t - ε t)",
    source: "definition of the rate error of a clock",
    parameters: &[parameter("rate", Unit::PPM, Prior::Anywhere(1.0, 50.0))],
    settings: &[],
    needs: &[Need::TableAngle, Need::Reversal],
    partners: &["encoder_latency", "base_tilt_ramp", "gyro_scale_ramp", "gyro.scale"],
    told_apart_by: "several reversals, distributed over the run",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        out.angle -= turned_to_end(p[0] * moment.end.time, moment);
    }),
};

/// Lost records of the encoder.
///
/// Records that were read twice are a negative loss.
pub static DROPPED_SAMPLES: Term = Term {
    id: "dropped_samples",
    also: &[],
    name: "dropped samples of the encoder",
    cause: "angles are lost between encoder and log without a record: all later ones are assigned to samples that are too early",
    equation: "angle = ζ(t + τ H(t - t0))",
    source: "pairing of records by their number",
    parameters: &[parameter("lost", Unit::MILLISECOND, Prior::Anywhere(1.0, 100.0))],
    settings: &[TIME],
    needs: &[Need::TableAngle],
    partners: &["encoder_slip", "encoder_latency"],
    told_apart_by: "rotate in the other direction, or at another rate, after the event",
    owner: Owner::Run,
    prevalence: Prevalence::Particular,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        if moment.end.time >= settings[0] {
            out.angle -= turned_to_end(-p[0], moment);
        }
    }),
};
