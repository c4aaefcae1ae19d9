//! What the causes gain on data that played no part.

use rins_diagnosis::{Drift, Gain, GainError, GainVerdict};
use rins_estimation::Fit;
use rins_frames::units::DEG;
use serde_json::{Value, json};

use crate::commands::calibrate::{Case, Prepared};

/// On what a gain is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum On {
    /// The last part of every stretch of the runs that were diagnosed.
    Ends,
    /// All their stretches at the fastest rate.
    Fastest,
    /// Another run, of this name.
    Run(String),
}

/// A gain, or why there is none to be told.
pub(crate) struct Measured {
    pub(crate) on: On,
    pub(crate) gain: Result<Gain, GainError>,
}

impl Measured {
    /// What `after` gains over `before` on a part of the runs of a case, or on another run.
    pub(crate) fn of(case: &Case, held_out: Option<&Prepared>, fits: (&Fit, &Fit)) -> Self {
        let (imu, knowledge) = (case.imu(), case.knowledge());
        let runs = case.given();
        match held_out {
            None => Self { on: On::Ends, gain: Gain::within(&runs, fits, imu, knowledge) },
            Some(other) => Self {
                on: On::Run(other.name.clone()),
                gain: Gain::on(std::slice::from_ref(&other.run), &runs, fits, imu, knowledge),
            },
        }
    }

    /// What `after` gains where the table turns fastest, both estimated at the slower rates.
    pub(crate) fn at_the_fastest_rate(case: &Case, fits: (&Fit, &Fit)) -> Self {
        let gain = Gain::at_the_fastest_rate(&case.given(), fits, case.imu(), case.knowledge());
        Self { on: On::Fastest, gain }
    }

    /// For a machine.
    pub(super) fn json(&self) -> Value {
        let held_out = match &self.on {
            On::Ends => "last 30 % of each segment".to_owned(),
            On::Fastest => "all at the fastest rate".to_owned(),
            On::Run(rig) => format!("last 30 % of each segment of {rig}"),
        };
        let rig = match &self.on {
            On::Run(rig) => Some(rig),
            On::Ends | On::Fastest => None,
        };
        let gain = match &self.gain {
            Ok(gain) => gain,
            Err(error) => {
                let why = error.to_string();
                return json!({"held_out": held_out, "verdict": "not_measurable", "why": why});
            }
        };
        let per_sample = |score: f64| score / gain.samples as f64;
        let drifts: Vec<Value> = gain.drifts.iter().map(drift).collect();
        let longest = drifts.last().cloned().unwrap_or_default();
        json!({
            "held_out": held_out,
            "rig": rig,
            "samples": gain.samples,
            "blocks": gain.blocks,
            "log_score_per_sample": {
                "before": per_sample(gain.before.log_score),
                "after": per_sample(gain.after.log_score),
            },
            "log_score_rise": gain.rise(),
            "log_score_rise_95": [gain.interval.0, gain.interval.1],
            "nis_mean": {"before": gain.before.nis_mean, "after": gain.after.nis_mean},
            "nis_dof": gain.before.nis_dof,
            "velocity_drift_m_s": longest["velocity_m_s"],
            "attitude_drift_deg": longest["attitude_deg"],
            "drift_after_s": longest["after_s"],
            "drifts": drifts,
            "verdict": match gain.verdict {
                GainVerdict::Improved => "improved",
                GainVerdict::NoImprovement => "no_improvement",
            },
        })
    }
}

fn drift(drift: &Drift) -> Value {
    let [before, after] = drift.attitude.map(|angle| angle / DEG);
    json!({
        "after_s": drift.after,
        "windows": drift.windows,
        "velocity_m_s": {"before": drift.velocity[0], "after": drift.velocity[1]},
        "attitude_deg": {"before": before, "after": after},
    })
}
