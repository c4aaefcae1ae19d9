//! Choices among named alternatives.

use clap::ValueEnum;
use rins::{NoiseChoice, TruthChoice};

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

/// Source of the true values of a simulated run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Truth {
    /// Drawn in each run from the prior distribution of the model (simulation-based calibration)
    Prior,
    /// The errors that the scenario states, in all runs
    Scenario,
}

impl From<Truth> for TruthChoice {
    fn from(truth: Truth) -> Self {
        match truth {
            Truth::Prior => Self::Prior,
            Truth::Scenario => Self::Scenario,
        }
    }
}
