//! What a model of an inertial measurement unit on a rate table leaves unexplained, and what would explain it.
//!
//! **What it does.** [`diagnose`] fits a model to a run, tries every effect of the catalogue on what is left (events at
//! any time, harmonics of any order), and names the one that explains it best, with its amplitude, the chance
//! that it is nothing, and the rivals that this run cannot tell from it; then it looks for the next.
//!
//! **What it does not do.** Gross errors (units, axes, lost samples) are found by `rins_inspection::inspect`, and must be
//! mended first. Nothing is named by force: what no effect explains is [`Unexplained`].
//!
//! Numbers are in SI units and radians.
mod candidates;
mod dead_zone;
mod evidence;
mod hypothesis;
mod probability;
mod score;
mod search;
mod suggested;
mod survey;
mod trial;

mod by_evidence;
mod case;
mod cause;
mod diagnosis;
mod every_turn;
mod settling;
mod sought;
mod supposed;

mod bursts;
mod disturbance;
mod harmonics;
mod jolt;
mod levels;
mod limits;
mod lines;
mod median;
mod named;
mod noise;
mod noisier;
mod periodic;
mod residuals;
mod rounding;
mod shocks;
mod sinusoid;
mod spectrum;
mod structure;
mod switching;
mod tails;
mod timing;
mod uneven;
mod unexplained;
mod wander;
mod waves;

mod gain;
mod gain_drift;
mod gain_overlay;
mod gain_spans;

pub use by_evidence::{diagnose_by_evidence, evaluate_by_evidence};
pub use candidates::{Candidate, candidates};
pub use cause::{Cause, Rival};
pub use diagnosis::{Diagnosis, DiagnosisError, FALSE_ALARMS, diagnose};
pub use gain::{Gain, GainError, GainVerdict, PredictiveScore};
pub use gain_drift::Drift;
pub use gain_overlay::Overlay;
pub use limits::{Limit, chance, limits};
pub use noise::stuck;
pub use structure::{Stratum, Structure};
pub use supposed::suppose;
pub use unexplained::Unexplained;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
