//! What a calibration or a diagnosis is asked for.

use std::path::{Path, PathBuf};

use rins_io::{Axes, ModelFile, shown};
use rins_terms::Model;

/// The error model that is estimated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelChoice {
    /// The paper's three gyro errors, by the paper's filter of twelve states.
    Paper12,
    /// All of eq. (1), and the attitude of the axis.
    Full,
    /// As a model file lists it.
    File(PathBuf),
}

impl ModelChoice {
    /// The model that is meant by `paper12`, `full`, or the name of a file that ends in `.toml`.
    ///
    /// # Errors
    /// What was expected, if `text` is none of these.
    ///
    /// ```
    /// use rins::ModelChoice;
    /// assert_eq!(ModelChoice::parse("full"), Ok(ModelChoice::Full));
    /// assert!(ModelChoice::parse("half").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        match text {
            "paper12" => Ok(Self::Paper12),
            "full" => Ok(Self::Full),
            path if Path::new(path).extension().is_some_and(|ending| ending == "toml") => {
                Ok(Self::File(path.into()))
            }
            _ => Err("expected paper12, full or a model file such as model.toml".into()),
        }
    }

    /// A model for the estimator that takes any: the paper's filter takes its own only.
    ///
    /// # Errors
    /// What was expected, if `text` is no such model.
    pub fn parse_estimated(text: &str) -> Result<Self, String> {
        match Self::parse(text) {
            Ok(choice) if choice != Self::Paper12 => Ok(choice),
            _ => Err("expected full or a model file such as model.toml".into()),
        }
    }
}

/// What is known of the random errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoiseChoice {
    /// The data sheet is a first guess; the most likely noise is estimated.
    #[default]
    Likely,
    /// The data sheet is right.
    Given,
}

/// A model to be estimated, and what it is called.
pub(crate) struct NamedModel {
    pub(crate) name: String,
    pub(crate) model: Model,
}

impl NamedModel {
    /// The model that was chosen, read if it is a file, in a run with these axes.
    pub(crate) fn of(choice: &ModelChoice, axes: &Axes) -> anyhow::Result<Self> {
        let (name, model) = match choice {
            ModelChoice::Paper12 => ("paper12".into(), Model::paper12()),
            ModelChoice::Full => ("full".into(), Model::full()),
            ModelChoice::File(path) => (shown(path), ModelFile::read_along(path, axes)?.model),
        };
        Ok(Self { name, model })
    }
}
