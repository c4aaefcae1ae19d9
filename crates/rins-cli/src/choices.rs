//! Choices among named alternatives.

use clap::ValueEnum;
use rins::NoiseChoice;

/// Source of the noise parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Noise {
    /// Estimated by maximum likelihood; the data sheet gives the initial values and priors
    Likely,
    /// Data-sheet values
    Given,
}

impl From<Noise> for NoiseChoice {
    fn from(noise: Noise) -> Self {
        match noise {
            Noise::Likely => Self::Likely,
            Noise::Given => Self::Given,
        }
    }
}
