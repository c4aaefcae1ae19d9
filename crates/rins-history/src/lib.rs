//! How the parameters of a sensor vary between runs.
//!
//! **What it does.** A [`History`] holds the estimates of the same parameters from several runs, each with its information matrix and the
//! [`Conditions`] of the run: unit, power-on, date, time since power-on, temperature. [`History::homogeneity`] tests whether a parameter
//! is the same in all runs. [`History::explain`] compares hypotheses of how parameters vary ([`Variation`]): constant, drift with the date
//! or with the time since power-on, warm-up, a polynomial of temperature, thermal hysteresis, turn-on repeatability, a random walk, a
//! change at a date, a unit or a run unlike the others. [`Explanation::forecast`] is the predictive distribution of a parameter in a run
//! that was not measured.
//!
//! The model is linear and Gaussian: `θ_ij = μ_j + Σ_k φ_k(i) a_k`, with the conditions `φ_k(i)` of run `i` and amplitudes `a_k` whose
//! scale has a log-uniform prior over the typical range of parameter `j` ([`rins_bayes::ScaleMixture`]). The score of a hypothesis is the
//! logarithm of its marginal likelihood plus that of its prior probability. Forecasts are means over all hypotheses, weighted by their
//! posterior probabilities.
//!
//! **What it does not do.** It reads no files, and what varies within a run is not its subject.
//!
//! The scale error of a gyro at four temperatures, in ppm:
//! ```
//! use nalgebra::DMatrix;
//! use rins_history::{Conditions, History, Kind, Quantity, RunEstimate};
//! let at = |power_on: usize, temperature: f64| Conditions {
//!     power_on,
//!     temperature: Some(temperature),
//!     ..Conditions::default()
//! };
//! let measured = [(20.0, 100.2), (40.0, 140.1), (60.0, 179.7), (30.0, 120.1)];
//! let runs = measured.iter().enumerate().map(|(run, &(temperature, value))| {
//!     let variance = DMatrix::from_element(1, 1, 0.2 * 0.2);
//!     RunEstimate::measured(at(run, temperature), (1, &[0]), &[value], &variance)
//! });
//! let scale = Quantity { id: "gyro.scale.z".into(), typical: (1.0, 300.0) };
//! let history = History::new(vec![scale], runs.collect::<Result<_, _>>()?)?;
//! let explanation = history.explain();
//! assert_eq!(explanation.causes()[0].variation.kind(), Kind::Linear);
//! let forecast = explanation.forecast(0, at(4, 50.0))?.expect("observed");
//! assert!((forecast.mean() - 160.0).abs() < 1.0);
//! # Ok::<(), rins_history::HistoryError>(())
//! ```
mod baseline;
mod conditions;
mod error;
mod explanation;
mod forecast;
mod history;
mod hypothesis;
mod information;
mod run_estimate;
mod search;
mod variation;

pub use baseline::{Past, baselines};
pub use conditions::Conditions;
pub use error::HistoryError;
pub use explanation::{Alternative, Cause, Explanation};
pub use forecast::Forecast;
pub use history::{History, Homogeneity};
pub use run_estimate::{Quantity, RunEstimate};
pub use variation::{Kind, Variation};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
