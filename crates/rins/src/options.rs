//! Options of a calibration or a diagnosis.

use std::path::{Path, PathBuf};

use rins_io::{Axes, InputFile, ModelFile, shown};
use rins_terms::Model;

/// The name of the model of all of eq. (1).
pub(crate) const FULL: &str = "full";

/// The error model that is estimated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelChoice {
    /// The paper's three gyro errors, by the paper's filter of twelve states.
    Paper12,
    /// All of eq. (1), and the attitude of the axis.
    Full,
    /// The model in a model file.
    File(PathBuf),
}

impl ModelChoice {
    /// The model named by `paper12`, `full`, or a file name that ends in `.toml`.
    ///
    /// # Errors
    /// The expected values, if `text` is none of them.
    ///
    /// ```
    /// use rins::ModelChoice;
    /// assert_eq!(ModelChoice::parse("full"), Ok(ModelChoice::Full));
    /// assert!(ModelChoice::parse("half").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        match text {
            "paper12" => Ok(Self::Paper12),
            FULL => Ok(Self::Full),
            path if Path::new(path).extension().is_some_and(|ending| ending == "toml") => {
                Ok(Self::File(path.into()))
            }
            _ => Err("expected paper12, full or a model file such as model.toml".into()),
        }
    }

    /// A model for the general estimator, which excludes the model of the paper's filter.
    ///
    /// # Errors
    /// The expected values, if `text` is no such model.
    pub fn parse_estimated(text: &str) -> Result<Self, String> {
        match Self::parse(text) {
            Ok(choice) if choice != Self::Paper12 => Ok(choice),
            _ => Err("expected full or a model file such as model.toml".into()),
        }
    }
}

/// The treatment of the noise parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoiseChoice {
    /// The noise parameters are estimated by maximum likelihood, from those of the data sheet as initial values.
    #[default]
    Likely,
    /// The noise parameters of the data sheet are used unchanged.
    Given,
}

impl NoiseChoice {
    /// The name in results: `likely` or `given`.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Likely => "likely",
            Self::Given => "given",
        }
    }
}

/// A model to be estimated, with its name.
#[derive(Clone, Debug)]
pub(crate) struct NamedModel {
    pub(crate) name: String,
    pub(crate) model: Model,
    /// Its file, if it has one.
    pub(crate) file: Option<InputFile>,
    /// The digests of the files that its values and sigmas are estimates from.
    pub(crate) digests: Vec<String>,
}

impl NamedModel {
    fn preset(name: &str, model: Model) -> Self {
        Self { name: name.into(), model, file: None, digests: Vec::new() }
    }

    /// The chosen model for a run with these axes; a model file is read.
    pub(crate) fn of(choice: &ModelChoice, axes: &Axes) -> anyhow::Result<Self> {
        Ok(match choice {
            ModelChoice::Paper12 => Self::preset("paper12", Model::paper12()),
            ModelChoice::Full => Self::preset(FULL, Model::full()),
            ModelChoice::File(path) => {
                let ModelFile { model, provenance, .. } = ModelFile::read_along(path, axes)?;
                let digests = provenance.inputs.into_iter().map(|input| input.sha256).collect();
                Self { name: shown(path), model, file: Some(InputFile::of(path)?), digests }
            }
        })
    }
}
