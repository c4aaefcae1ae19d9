//! Errors and latencies of the encoder.

use super::after;
use crate::effect::Law;

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    (
        "encoder_eccentricity",
        Law::Read(|p, _, pose| p[0] * pose.angle.cos() + p[1] * pose.angle.sin()),
    ),
    (
        "encoder_harmonic",
        Law::Read(|p, s, pose| {
            let (sin, cos) = (s[0] * pose.angle).sin_cos();
            p[0] * cos + p[1] * sin
        }),
    ),
    ("encoder_backlash", Law::Read(|p, _, pose| p[0] * pose.sense)),
    ("encoder_slip", Law::Read(|p, s, pose| p[0] * after(s[0], pose.time))),
    ("encoder_latency", Law::Late(|p, _, _| p[0])),
    ("clock_drift", Law::Late(|p, _, time| p[0] * time)),
    ("dropped_samples", Law::Late(|p, s, time| -p[0] * after(s[0], time))),
];
