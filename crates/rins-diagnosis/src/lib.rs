//! What a model of an inertial measurement unit on a rate table leaves unexplained, and what would explain it.
//!
//! [`diagnose`] in ten sentences:
//!
//! 1. A *hypothesis* is what acts beyond the given model: effects, each with its settings (a time, a frequency, an order) and its
//!    support (the parameters that are not zero); noise processes that the data sheet does not state; and stated priors that are too
//!    narrow (`hypothesis`).
//! 2. It has one *score*, the logarithm of its marginal likelihood plus that of its prior probability (`search::state`).
//! 3. Amplitudes are integrated out in closed form with a prior that is log-uniform over the typical range of the catalogue and has
//!    heavy tails, a mixture of Gaussians (`hypothesis::magnitude`, `evidence::block`, `evidence::exact`).
//! 4. Settings are integrated out about their best values, with a prior that is uniform in time and order, and log-uniform in frequency
//!    and time constant (`search::sought`).
//! 5. Noise parameters are estimated again for every hypothesis, with priors about the data sheet (`rins_estimation`).
//! 6. The prior probability is a product of one of something against nothing, one for every term by its prevalence, one for its support,
//!    and one for its settings; structures without a physical cause are terms with a low prior (`hypothesis::support`, `generic`).
//! 7. A linear pass over the runs scores every term at once, over a grid of its settings and where the innovations are largest
//!    (`proposal`, `evidence::screen`).
//! 8. The search adds one effect or two, drops, exchanges one for one, one for two or two for one, adds or drops a noise process, and
//!    widens or restores a prior; it fits the best few moves without linearization, takes the best, and ends when none is better
//!    (`search`).
//! 9. Each cause of the last hypothesis is reported with the alternatives that hold 98 % of the probability or fit as well, and with a
//!    p-value for the whole search (`search::alternatives`).
//! 10. What remains is tested against white noise, and what the causes gain is measured on data that were not used for the fit
//!     (`criticism`, `prediction`).
//!
//! Gross errors (units, axes, lost samples) are found by `rins_inspection::inspect`, and must be corrected first. What no effect explains
//! is [`Unexplained`] and gets no name.
//!
//! Numbers are in SI units and radians.
mod criticism;
mod evidence;
mod generic;
mod hypothesis;
mod prediction;
mod proposal;
mod search;
mod verdict;

mod case;
mod diagnosis;
mod median;
mod supposed;

pub use criticism::noise::stuck;
pub use criticism::structure::{Stratum, Structure};
pub use criticism::unexplained::Unexplained;
pub use diagnosis::{Diagnosis, DiagnosisError, FALSE_ALARMS, diagnose};
pub use generic::between_runs::same_in_all_runs;
pub use prediction::drift::Drift;
pub use prediction::gain::{Gain, GainError, GainVerdict, PredictiveScore};
pub use prediction::overlay::Overlay;
pub use proposal::candidates::{Candidate, candidates};
pub use supposed::suppose;
pub use verdict::cause::{Cause, Rival};
pub use verdict::false_alarms::false_alarms;
pub use verdict::limits::{Limit, limits};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
