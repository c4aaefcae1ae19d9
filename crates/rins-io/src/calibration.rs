//! Calibration files: the estimated errors of an IMU, for the compensation of other runs.

mod covariance;
mod measured;
mod range;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

pub use covariance::Covariance;
pub use measured::Measured;
pub use range::CalibratedRange;
use rins_frames::SignedAxes;
use rins_imu::{Compensation, ImuError, TriadError};
use rins_terms::catalogue::REFERENCE_TEMPERATURE;
use rins_terms::{Model, Role, TermInstance};

use crate::document::{Document, quoted};
use crate::error::{IoError, KeyError, KeyProblem};
use crate::model::REFERENCE;
use crate::output::{Overwrite, write_file};
use crate::parameter::{self, LeftOut, Parameter, parameters};
use crate::provenance::{self, Provenance};
use crate::rig::Axes;
use crate::section::Section;
use crate::term::{self, Use};

/// The versions of the format: version 2 may contain terms and a covariance.
/// A file that contains neither is written as version 1.
const SCHEMAS: [u64; 2] = [1, 2];

/// The keys that only version 2 has.
const NEWER: [&str; 7] =
    ["term", "covariance", REFERENCE, "range", "measured", "provenance", "prior"];

/// The values of the key `spin`.
const SPINS: &str = r#""x", "y", "z", "-x", "-y" or "-z""#;

/// The comment at the beginning of every calibration file.
const MEANING: &str = "\
# Errors of an inertial measurement unit in its own body axes x, y and z, for any spin axis.
#
#   measured    = true + bias + (S + M) true
#   compensated = (I + S + M)^-1 (measured - bias)
#
# S: scale errors, on the diagonal. M: misalignments, off it, named by row and column:
# gyro.misalignment.xz is the fraction of a rate about z in gyro x.
";

/// The comment above the terms.
const TERMS: &str = "
# Further effects. Each term adds its equation, for the true rate and force, to a reading. All of them are
# compensated together: true = measured - (bias + (S + M) true + terms(true)), iterated to convergence.
";

/// The comment above the standard deviations.
const SIGMAS: &str = "
# 1 sigma of each estimated number. The other numbers are assumed values.
[sigma]
";

/// The comment above the standard deviations before the calibration.
const PRIORS: &str = "
# 1 sigma of each estimated number before the calibration.
[prior]
";

/// The errors of an IMU and their standard deviations, the content of a calibration file.
///
/// ```
/// # use std::path::Path;
/// use rins_imu::{Axis, ImuError, TriadError};
/// use rins_io::{Calibration, Parameter};
///
/// let gyro = TriadError::default().with_scale(Axis::Z, 300e-6);
/// let sigma = Parameter { id: "gyro.scale.z".into(), value: 0.02, unit: "ppm" };
/// let calibration = Calibration {
///     sigmas: vec![sigma],
///     notes: vec!["gyro.scale.z: also a bias of the z gyro".into()],
///     ..Calibration::of(ImuError { gyro, ..ImuError::default() })
/// };
/// let text = calibration.to_toml();
/// assert!(text.contains("[sigma]\ngyro.scale.z = \"0.02 ppm\"\n"));
/// let again = Calibration::parse(&text, Path::new("calibration.toml"))?;
/// assert!((again.error.gyro.matrix[(2, 2)] - 300e-6).abs() < 1e-18);
/// // Of no other number does the file claim to know how far off it is.
/// assert_eq!((again.sigmas.len(), again.notes), (1, calibration.notes));
/// # Ok::<(), rins_io::IoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The path of the file; empty if there is none.
    pub path: PathBuf,
    /// The errors, along the sensors' own axes.
    pub error: ImuError,
    /// The axes of the run from which the calibration was made, selected from the sensors' own: the terms are along these.
    pub spin: Axes,
    /// The standard deviations of the estimated numbers, by id and in the units of
    /// [`parameters`](crate::parameters), along the sensors' own axes; the other numbers have none.
    pub sigmas: Vec<Parameter>,
    /// Remarks on the numbers: which of them are combinations, and the conditions under which these are valid.
    pub notes: Vec<String>,
    /// The terms beyond bias, scale error and misalignment, with the standard deviations of the estimated parameters, in a run
    /// with the axes [`spin`](Self::spin); the file has them along the sensors' own axes.
    pub terms: Model,
    /// The covariance of the estimated numbers, by ids along the sensors' own axes.
    pub covariance: Option<Covariance>,
    /// The reference temperature of the values, if terms depend on temperature \[°C\].
    pub reference_temperature: f64,
    /// The range covered by the runs from which the calibration was made.
    pub range: CalibratedRange,
    /// When and how these runs were made.
    pub measured: Measured,
    /// The program and the files from which it was made.
    pub provenance: Provenance,
    /// The standard deviations of the numbers before the calibration, by id and in the units of [`parameters`](crate::parameters):
    /// what the runs said of them is what the covariance says beyond these.
    pub priors: Vec<Parameter>,
}

impl Calibration {
    /// A calibration from a run about z, without standard deviations and remarks.
    pub fn of(error: ImuError) -> Self {
        Self {
            path: PathBuf::new(),
            error,
            spin: Axes::IDENTITY,
            sigmas: Vec::new(),
            notes: Vec::new(),
            terms: Model::default(),
            covariance: None,
            reference_temperature: REFERENCE_TEMPERATURE.default,
            range: CalibratedRange::default(),
            measured: Measured::default(),
            provenance: Provenance::default(),
            priors: Vec::new(),
        }
    }

    /// Reads the calibration file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Key`] if one of its numbers is missing,
    /// unknown or of the wrong dimension, if a standard deviation is not positive, if the
    /// errors cannot be compensated, or if the file has another version of the format.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::read(path)?)
    }

    /// The calibration in `text`, parsed as the content of the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`], as for [`Calibration::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::parse(text, path)?)
    }

    fn from_document(document: &Document) -> Result<Self, IoError> {
        let older = ["schema", "spin", "notes", "gyro", "accel", "sigma"];
        let known: Vec<&str> = older.into_iter().chain(NEWER).collect();
        let root = Section::root(document, &known)?;
        match root.count("schema", "1 or 2")? {
            Some(schema) if !SCHEMAS.contains(&schema) => {
                return Err(root.not_allowed("schema", "1 or 2"));
            }
            Some(1) => {
                if let Some(key) = NEWER.into_iter().find(|key| root.has(key)) {
                    return Err(root.conflict(key, "needs schema = 2"));
                }
            }
            Some(_) => {}
            None => return Err(root.missing("schema", "1 or 2")),
        }
        let error = both(&root)?;
        let notes = root.list_of_texts("notes", "a list of texts")?;
        let sigmas = match root.section("sigma", &["gyro", "accel"])? {
            Some(section) => parameter::read_sigmas(&section)?,
            None => Vec::new(),
        };
        let priors = match root.section("prior", &["gyro", "accel"])? {
            Some(section) => parameter::read_sigmas(&section)?,
            None => Vec::new(),
        };
        let measured = measured::read(&root)?;
        let provenance = provenance::read(&root)?;
        let spin = match root.text("spin", SPINS)? {
            Some(name) => Axes::spin(name).ok_or_else(|| root.not_allowed("spin", SPINS))?,
            None => Axes::IDENTITY,
        };
        let reference = root.celsius(REFERENCE)?;
        let terms = terms(&root, &spin.into(), reference)?;
        let ids = parameters(&error).into_iter().map(|parameter| parameter.id);
        let of_terms = own_places(&terms, &spin.into()).into_iter().map(|(id, _)| id);
        let known: Vec<String> = ids.chain(of_terms).collect();
        let of_terms = own_places(&terms, &spin.into()).into_iter();
        let stated: Vec<(String, f64)> = of_terms
            .filter_map(|(id, (term, place))| match terms.terms[term].roles[place] {
                Role::Within(sigma) => {
                    let unit = terms.terms[term].term.parameters[place].unit;
                    Some((id, sigma / unit.factor))
                }
                _ => None,
            })
            .chain(sigmas.iter().map(|sigma| (sigma.id.clone(), sigma.value)))
            .collect();
        let covariance = covariance::read(&root, &known, &stated)?;
        let path = document.path.clone();
        let range = range::read(&root)?;
        let calibration = Self {
            path,
            error,
            spin,
            sigmas,
            notes,
            terms,
            covariance,
            reference_temperature: reference.unwrap_or(REFERENCE_TEMPERATURE.default),
            range,
            measured,
            provenance,
            priors,
        };
        calibration.compensation()?;
        Ok(calibration)
    }

    /// The errors as they act in a run with these axes, selected from the sensors' own: bias, scale error and misalignment, and
    /// the terms.
    ///
    /// # Errors
    /// [`IoError::Key`] if a term has a parameter that acts only in a run about the calibration's axis, such as the scale factor
    /// asymmetry of one gyro, and this run is about another axis.
    pub fn in_run(&self, axes: &Axes) -> Result<(ImuError, Model), IoError> {
        let from_spin = SignedAxes::from(axes.after(&self.spin.inverse()));
        for chosen in &self.terms.terms {
            if let Some(name) = chosen.without_place(&from_spin).first() {
                let place = chosen.term.parameters.iter().position(|p| p.name == *name);
                let own = chosen.term.own_name(place.unwrap_or_default(), &self.spin.into());
                let reason = format!(
                    "{}.{own} was estimated in a run about {}; it is not defined in a run about {}",
                    chosen.term.id,
                    self.spin.spin_name(),
                    axes.spin_name()
                );
                let (path, key) = (self.path.clone(), "[[term]]".to_string());
                let problem = KeyProblem::Conflict { reason };
                return Err(Box::new(KeyError { path, line: None, key, problem }).into());
            }
        }
        Ok((self.error.along(&SignedAxes::from(*axes).matrix()), self.terms.carried(&from_spin)))
    }

    /// The ids of the terms' parameters along the sensors' own axes, with their positions in [`terms`](Self::terms).
    pub fn own_terms(&self) -> Vec<(String, (usize, usize))> {
        own_places(&self.terms, &self.spin.into())
    }

    /// The compensation of bias, scale error and misalignment, without the terms
    /// ([`rins_terms::compensated`] compensates all of them).
    ///
    /// # Errors
    /// [`IoError::Key`] if they cannot be compensated.
    pub fn compensation(&self) -> Result<Compensation, IoError> {
        self.error.compensation().map_err(|refusal| {
            let key = match refusal.triad {
                rins_imu::Triad::Gyro => "[gyro]",
                rins_imu::Triad::Accel => "[accel]",
            };
            let problem = KeyProblem::Conflict { reason: refusal.reason.to_string() };
            let (path, key) = (self.path.clone(), key.to_string());
            Box::new(KeyError { path, line: None, key, problem }).into()
        })
    }

    /// The text of the calibration file.
    pub fn to_toml(&self) -> String {
        let range = range::written(&self.range);
        let measured = measured::written(&self.measured) + &provenance::written(&self.provenance);
        let known = !measured.is_empty() || !self.priors.is_empty();
        let newer =
            !self.terms.terms.is_empty() || self.covariance.is_some() || !range.is_empty() || known;
        let mut text = format!("{MEANING}schema = {}\n", SCHEMAS[usize::from(newer)]);
        if self.spin != Axes::IDENTITY {
            // Writing to a string cannot fail, here and below.
            let _ = writeln!(text, "spin = {:?}", self.spin.spin_name());
        }
        if newer {
            let _ = writeln!(text, "{REFERENCE} = \"{} degC\"", self.reference_temperature);
        }
        if !self.notes.is_empty() {
            text.push_str("notes = [\n");
            for note in &self.notes {
                let _ = writeln!(text, "    {},", quoted(note));
            }
            text.push_str("]\n");
        }
        text.push_str(&range);
        text.push_str(&measured);
        let mut push = |header: &str, triad: &TriadError, keys| {
            text.push_str("\n[");
            text.push_str(header);
            text.push_str("]\n");
            text.push_str(&parameter::written(triad, keys));
        };
        push("gyro", &self.error.gyro, &parameter::GYRO);
        push("accel", &self.error.accel, &parameter::ACCEL);
        if !self.sigmas.is_empty() {
            text.push_str(SIGMAS);
        }
        for Parameter { id, value, unit } in &self.sigmas {
            let _ = writeln!(text, "{id} = \"{value} {unit}\"");
        }
        if !self.priors.is_empty() {
            text.push_str(PRIORS);
        }
        for Parameter { id, value, unit } in &self.priors {
            let _ = writeln!(text, "{id} = \"{value} {unit}\"");
        }
        if let Some(covariance) = &self.covariance {
            text.push_str(&covariance::written(covariance));
        }
        if !self.terms.terms.is_empty() {
            text.push_str(TERMS);
        }
        for chosen in &self.terms.terms {
            text.push_str(&term::written(chosen, Use::Calibration, &self.spin.into()));
        }
        text
    }

    /// Writes the calibration file atomically.
    ///
    /// # Errors
    /// As [`write_file`].
    pub fn write(&self, path: &Path, overwrite: Overwrite) -> Result<(), IoError> {
        write_file(path, overwrite, |file| {
            file.write_all(self.to_toml().as_bytes()).map_err(IoError::file("write", path))
        })
    }
}

fn both(section: &Section<'_>) -> Result<ImuError, IoError> {
    let triad = |key: &str, keys| match section.section(key, &parameter::KEYS)? {
        Some(triad) => parameter::read(&triad, keys, LeftOut::Refused),
        None => Err(section.missing(key, "the keys bias, scale and misalignment")),
    };
    let gyro = triad("gyro", &parameter::GYRO)?;
    Ok(ImuError { gyro, accel: triad("accel", &parameter::ACCEL)? })
}

/// The terms beyond bias, scale error and misalignment.
fn terms(root: &Section<'_>, axes: &SignedAxes, reference: Option<f64>) -> Result<Model, IoError> {
    let mut model = Model::default();
    for table in term::tables(root, "term")? {
        let chosen = term::read_about(&table, Use::Calibration, axes, reference)?;
        term::refuse_triads(&table, &chosen, |sensor| format!("[{sensor}]"))?;
        if !chosen.term.is_signal() {
            return Err(table.conflict("id", format!("{} cannot be compensated", chosen.term.id)));
        }
        model.terms.push(chosen);
    }
    Ok(model)
}

/// The ids of all parameters of a run's terms along the sensors' own axes, with their positions.
fn own_places(terms: &Model, axes: &SignedAxes) -> Vec<(String, (usize, usize))> {
    let own = |(term, chosen): (usize, &TermInstance)| {
        let order = chosen.term.own_order(axes).into_iter();
        order.map(move |place| (terms.own_id(term, place, axes), (term, place))).collect::<Vec<_>>()
    };
    terms.terms.iter().enumerate().flat_map(own).collect()
}
