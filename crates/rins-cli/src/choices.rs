//! Choices among named alternatives.

use clap::ValueEnum;
use rins::{NoiseChoice, Search};

/// Source of the noise parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Noise {
    /// Estimated by maximum likelihood; the data sheet gives the initial values and priors
    Likely,
    /// Data-sheet values
    Given,
}

/// How effects are searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Searched {
    /// One effect after the other, the most significant first
    Stepwise,
    /// By one score of a whole hypothesis, its marginal likelihood times its prior (experimental)
    Evidence,
}

impl From<Searched> for Search {
    fn from(searched: Searched) -> Self {
        match searched {
            Searched::Stepwise => Self::Stepwise,
            Searched::Evidence => Self::Evidence,
        }
    }
}

impl From<Noise> for NoiseChoice {
    fn from(noise: Noise) -> Self {
        match noise {
            Noise::Likely => Self::Likely,
            Noise::Given => Self::Given,
        }
    }
}
