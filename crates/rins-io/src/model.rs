//! Model files: the estimated terms with their initial values and priors.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rins_frames::SignedAxes;
use rins_terms::catalogue::REFERENCE_TEMPERATURE;
use rins_terms::{Model, TermInstance};

use crate::document::Document;
use crate::error::IoError;
use crate::output::{Overwrite, write_file};
use crate::provenance::{self, Provenance};
use crate::rig::Axes;
use crate::section::Section;
use crate::term::{self, Use};

/// The version of the format.
const SCHEMA: u64 = 1;

/// The key of the reference temperature of temperature coefficients, for terms that do not state their own.
pub(crate) const REFERENCE: &str = REFERENCE_TEMPERATURE.name;

/// The comment at the beginning of every model file.
const MEANING: &str = "\
# Estimated terms: those of the base, and those below. A term below replaces the same term of the base.
# estimate = true, false or a list of parameters; values are the start of the estimation, or the fixed
# values; sigma is the prior uncertainty, if it is not that of the data sheet.
";

/// A model to be estimated, the content of a model file.
///
/// ```
/// # use std::path::Path;
/// let text = r#"
/// schema = 1
/// base = "paper12"
///
/// [[term]]
/// id = "gyro.bias"
/// estimate = ["z"]
/// sigma = { z = "0.1 deg/h" }
/// "#;
/// let model = rins_io::ModelFile::parse(text, Path::new("model.toml"))?.model;
/// assert_eq!(model.terms.len(), 3);
/// assert_eq!(model.find("gyro.bias.z"), Some((2, 2)));
/// # Ok::<(), rins_io::IoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ModelFile {
    /// The path of the file; empty if there is none.
    pub path: PathBuf,
    /// Its terms, those of the base first, in a run with these axes.
    pub model: Model,
    /// The axes of the run, selected from the sensors' own: the names and values in the file are along these, and the bases refer
    /// to the spin axis.
    pub axes: Axes,
    /// The program and the files that its values and sigmas come from, if they are estimates.
    pub provenance: Provenance,
}

type Preset = fn() -> Model;

/// The base models that a file can extend, the largest first.
const BASES: [(&str, Preset); 3] =
    [("full", Model::full), ("paper12", Model::paper12), ("none", Model::default)];

impl ModelFile {
    /// A model without a file, for a run about z.
    pub fn of(model: Model) -> Self {
        let (path, provenance) = (PathBuf::new(), Provenance::default());
        Self { path, model, axes: Axes::IDENTITY, provenance }
    }

    /// The same model for a run with these axes.
    #[must_use]
    pub fn with_axes(self, axes: Axes) -> Self {
        Self { axes, ..self }
    }

    /// The same model, estimated by this program from these files.
    #[must_use]
    pub fn with_provenance(self, provenance: Provenance) -> Self {
        Self { provenance, ..self }
    }

    /// Reads the model file at `path` for a run about z.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Key`] if a term, setting or parameter is unknown, has the
    /// wrong dimension or is out of range, or if a term is listed twice.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::read_along(path, &Axes::IDENTITY)
    }

    /// Reads the model file at `path` for a run with these axes.
    ///
    /// # Errors
    /// As for [`ModelFile::read`]; a parameter that a run about this axis does not have is unknown.
    pub fn read_along(path: &Path, axes: &Axes) -> Result<Self, IoError> {
        Self::from_document(&Document::read(path)?, axes)
    }

    /// The model in `text`, parsed as the content of the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`], as for [`ModelFile::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::parse(text, path)?, &Axes::IDENTITY)
    }

    fn from_document(document: &Document, axes: &Axes) -> Result<Self, IoError> {
        let root = Section::root(document, &["schema", "base", REFERENCE, "term", "provenance"])?;
        match root.count("schema", "1")? {
            Some(SCHEMA) => {}
            Some(_) => return Err(root.not_allowed("schema", "1")),
            None => return Err(root.missing("schema", "1")),
        }
        let Some(base) = root.choice("base", &BASES)? else {
            return Err(root.missing("base", r#"one of "full", "paper12", "none""#));
        };
        let mut model = base();
        let reference = root.celsius(REFERENCE)?;
        // The terms of the base that the file has not changed so far.
        let mut unsaid: Vec<bool> = vec![true; model.terms.len()];
        for table in term::tables(&root, "term")? {
            let chosen = term::read_about(&table, Use::Model, &SignedAxes::from(*axes), reference)?;
            match model.terms.iter().position(|listed| same(listed, &chosen)) {
                None => model.terms.push(chosen),
                Some(place) if unsaid.get(place) == Some(&true) => {
                    unsaid[place] = false;
                    model.terms[place] = chosen;
                }
                Some(_) => {
                    let reason = format!("{} is listed twice", chosen.term.id);
                    return Err(table.conflict("id", reason));
                }
            }
        }
        let provenance = provenance::read(&root)?;
        Ok(Self { path: document.path.clone(), model, axes: *axes, provenance })
    }

    /// The text of the model file.
    pub fn to_toml(&self) -> String {
        let terms = &self.model.terms;
        let opens = |base: &Model| {
            base.terms.len() <= terms.len()
                && base.terms.iter().zip(terms).all(|(base, term)| same(base, term))
        };
        let mut bases = BASES.iter().map(|(name, base)| (*name, base()));
        let (name, base) =
            bases.find(|(_, base)| opens(base)).unwrap_or(("none", Model::default()));
        let mut text = format!("{MEANING}schema = {SCHEMA}\nbase = {name:?}\n");
        if let Some(reference) = self.model.reference_temperature() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{REFERENCE} = \"{reference} degC\"");
        }
        for (place, chosen) in terms.iter().enumerate() {
            if base.terms.get(place) != Some(chosen) {
                text.push_str(&term::written(chosen, Use::Model, &SignedAxes::from(self.axes)));
            }
        }
        text + &provenance::written(&self.provenance)
    }

    /// Writes the model file atomically.
    ///
    /// # Errors
    /// As for [`write_file`].
    pub fn write(&self, path: &Path, overwrite: Overwrite) -> Result<(), IoError> {
        write_file(path, overwrite, |file| {
            file.write_all(self.to_toml().as_bytes()).map_err(IoError::file("write", path))
        })
    }
}

/// Whether both are the same effect: the same term with the same settings.
fn same(a: &TermInstance, b: &TermInstance) -> bool {
    a.term.is(b.term) && a.settings == b.settings
}
