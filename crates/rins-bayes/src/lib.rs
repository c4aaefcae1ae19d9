//! Bayes factors of amplitudes in closed form.
//!
//! **What it does.** The amplitude of an effect that may be anywhere between negligible and gross has a [`ScaleMixture`] prior: given a
//! scale `s` it is N(0, s²), and `ln s` is uniform over a typical range, with tails. The integral of a Gaussian likelihood over this
//! prior is a finite sum, [`Block`]. [`ln_tail`] is the p-value of a chi-square statistic as a logarithm.
//!
//! **What it does not do.** It contains no inertial navigation, and no search over hypotheses.
//!
//! One amplitude, estimated as 5 ± 1:
//! ```
//! use nalgebra::{DMatrix, DVector};
//! use rins_bayes::{Block, ScaleMixture};
//! let prior = ScaleMixture::between(0.1, 10.0);
//! let (information, score) = (DMatrix::from_element(1, 1, 1.0), DVector::from_element(1, 5.0));
//! let block = Block::of(information, &score, &prior);
//! // The maximum of the likelihood ratio is 12.5 nats; the prior costs about four of them.
//! assert!((block.ln_factor - 9.0).abs() < 1.0);
//! ```
mod block;
mod chi_square;
mod scale_mixture;

pub use block::{Block, log_sum};
pub use chi_square::ln_tail;
pub use scale_mixture::{Component, ScaleMixture};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
