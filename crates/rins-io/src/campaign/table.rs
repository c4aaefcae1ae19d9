//! The results of a campaign, and their Parquet format: a row for each run and parameter.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use rins_campaign::PARAMETERS;

use crate::error::IoError;
use crate::output::{Overwrite, write_file};

/// The number of rows in a row group, which are in memory together.
const GROUP: usize = 1 << 14;

/// The identity of a result file: the campaign and the shard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The scenario file's text.
    pub scenario: String,
    /// The number of runs of each scenario.
    pub runs: u64,
    /// The seed.
    pub seed: u64,
    /// The number of the shard, from 1, and the number of shards.
    pub shard: (u64, u64),
    /// The estimated model; `None` for the three parameters of the paper's filter.
    pub model: Option<CampaignModel>,
}

/// The model that a campaign estimates, with the sources of noise and true values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CampaignModel {
    /// The name: `full`, or the path of the model file.
    pub name: String,
    /// The text of the model file; empty if there is none.
    pub text: String,
    /// The source of the noise parameters.
    pub noise: String,
    /// The source of the true values.
    pub truth: String,
    /// The number of estimated parameters.
    pub parameters: usize,
}

impl Identity {
    /// The version of the program, because numbers may change with it.
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");

    /// The identity in one line.
    pub(super) fn line(&self) -> String {
        let Self { scenario, runs, seed, shard: (shard, of), model } = self;
        let scenario = serde_json::Value::from(scenario.as_str());
        let line =
            format!("rins {} runs {runs} seed {seed} shard {shard}/{of} {scenario}", Self::VERSION);
        let Some(CampaignModel { name, text, noise, truth, parameters }) = model else {
            return line;
        };
        let [name, text] = [name, text].map(|text| serde_json::Value::from(text.as_str()));
        format!("{line} model {name} noise {noise} truth {truth} parameters {parameters} {text}")
    }

    /// The identity of the whole campaign.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self { shard: (1, 1), ..self.clone() }
    }

    fn metadata(&self) -> Vec<KeyValue> {
        let (shard, of) = self.shard;
        let mut pairs = vec![
            ("rins.version", Self::VERSION.into()),
            ("rins.scenario", self.scenario.clone()),
            ("rins.runs", self.runs.to_string()),
            ("rins.seed", self.seed.to_string()),
            ("rins.shard", format!("{shard}/{of}")),
        ];
        if let Some(model) = &self.model {
            pairs.extend([
                ("rins.model", model.name.clone()),
                ("rins.model_text", model.text.clone()),
                ("rins.noise", model.noise.clone()),
                ("rins.truth", model.truth.clone()),
                ("rins.parameters", model.parameters.to_string()),
            ]);
        }
        pairs.into_iter().map(|(key, value)| KeyValue::new(key.into(), value)).collect()
    }

    pub(super) fn from_metadata(metadata: &[KeyValue]) -> Option<Self> {
        let get = |key: &str| {
            metadata.iter().find(|pair| pair.key == key).and_then(|pair| pair.value.as_deref())
        };
        (get("rins.version")? == Self::VERSION).then_some(())?;
        let (shard, of) = get("rins.shard")?.split_once('/')?;
        Some(Self {
            scenario: get("rins.scenario")?.into(),
            runs: get("rins.runs")?.parse().ok()?,
            seed: get("rins.seed")?.parse().ok()?,
            shard: (shard.parse().ok()?, of.parse().ok()?),
            model: match get("rins.model") {
                None => None,
                Some(name) => Some(CampaignModel {
                    name: name.into(),
                    text: get("rins.model_text")?.into(),
                    noise: get("rins.noise")?.into(),
                    truth: get("rins.truth")?.into(),
                    parameters: get("rins.parameters")?
                        .parse()
                        .ok()
                        .filter(|number| (1..=MOST_PARAMETERS).contains(number))?,
                }),
            },
        })
    }

    /// The columns of the results.
    pub(super) fn columns(&self) -> Columns {
        Columns { parameters: self.parameters(), model: self.model.is_some() }
    }

    /// The number of parameters, and of rows of a run.
    pub fn parameters(&self) -> usize {
        self.model.as_ref().map_or(PARAMETERS.len(), |model| model.parameters)
    }
}

/// The result of one run for one parameter, in the unit of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The true value.
    pub truth: f64,
    /// The estimate; NaN if the run failed.
    pub estimate: f64,
    /// Its covariances with all parameters, in their order.
    pub covariances: Vec<f64>,
    /// The run's mean normalized innovation squared divided by its degrees of freedom.
    pub nis_ratio: f64,
    /// The further columns of a campaign with a model.
    pub of_model: Option<ModelRecord>,
}

/// The columns that only a campaign with a model has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelRecord {
    /// The prior sigma of the parameter, in its unit.
    pub prior_sigma: f64,
    /// The rank of the true value in the posterior, from 0 to 1: its probability integral transform.
    pub rank: f64,
    /// The NEES of the well-determined combinations of the run.
    pub nees: f64,
    /// Its degrees of freedom.
    pub nees_dof: u64,
    /// The number of iterations of the run.
    pub iterations: u64,
    /// Whether the estimate of the run converged.
    pub converged: bool,
}

/// A row: the scenario, the run, the parameter, and the result.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The index of the scenario in the grid, from 0.
    pub cell: u64,
    /// The index of the run, from 0.
    pub run: u64,
    /// The index of the parameter, from 0.
    pub place: usize,
    /// The parameter's id.
    pub parameter: String,
    /// The unit of the numbers.
    pub unit: String,
    /// The result.
    pub record: Record,
    /// The failure reason; empty if the run did not fail.
    pub failure: String,
}

/// The rows of a run: its parameters in their order, at least one.
pub type RunRows = Vec<Row>;

/// The heading of the results of a campaign or a shard.
#[derive(Clone, Debug, PartialEq)]
pub struct Heading {
    /// The identity of the campaign.
    pub identity: Identity,
    /// The keys of the grid.
    pub keys: Vec<String>,
    /// The values of the keys, for each scenario of the grid; empty for a scenario without rows.
    pub values: Vec<Vec<String>>,
}

/// The maximum number of parameters of a model.
const MOST_PARAMETERS: usize = 256;

/// The integer columns at the beginning.
pub(super) const INTEGERS: [&str; 2] = ["cell", "run"];
/// The text columns, which follow those of the grid.
pub(super) const TEXTS: [&str; 2] = ["parameter", "unit"];
/// The integer columns after the floating-point columns.
const COUNTS: [&str; 3] = ["nees_dof", "iterations", "converged"];
/// The last column.
pub(super) const FAILURE: &str = "failure";

/// The columns of the results between the texts and the last column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Columns {
    /// The number of parameters.
    pub(super) parameters: usize,
    /// Whether there are the columns of a campaign with a model.
    pub(super) model: bool,
}

impl Columns {
    /// The floating-point columns.
    pub(super) fn numbers(self) -> Vec<String> {
        let covariances = (1..=self.parameters).map(|other| format!("covariance_{other}"));
        let own = |names: &'static [&str]| names.iter().map(|&name| name.to_owned());
        let (first, last): (&[&str], &[&str]) = if self.model {
            (&["truth", "estimate", "sigma", "prior_sigma", "rank"], &["nis_ratio", "nees"])
        } else {
            (&["truth", "estimate", "sigma"], &["nis_ratio"])
        };
        own(first).chain(covariances).chain(own(last)).collect()
    }

    /// The integer columns after them.
    pub(super) const fn counts(self) -> &'static [&'static str] {
        if self.model { &COUNTS } else { &[] }
    }
}

/// Writes results run by run and atomically; the runs are consumed as they are written.
///
/// # Errors
/// [`IoError::Output`] if an existing file must not be replaced, [`IoError::File`] on a system error, or the first error among
/// the runs.
pub fn write_part(
    path: &Path,
    overwrite: Overwrite,
    heading: &Heading,
    runs: impl IntoIterator<Item = Result<RunRows, IoError>>,
) -> Result<(), IoError> {
    let mut runs = runs.into_iter();
    write_file(path, overwrite, |out| {
        let mut refused = None;
        let sound = std::iter::from_fn(|| match runs.next()? {
            Ok(rows) => Some(rows),
            Err(error) => {
                refused = Some(error);
                None
            }
        })
        .fuse();
        encode(heading, sound.flatten(), out)
            .map_err(|error| IoError::file("write", path)(std::io::Error::other(error)))?;
        refused.map_or(Ok(()), Err)
    })
}

type Out<'a> = &'a mut (dyn Write + Send);

fn encode(
    heading: &Heading,
    mut rows: impl Iterator<Item = Row>,
    out: Out<'_>,
) -> Result<(), ParquetError> {
    let field = |name: &str, physical, logical| {
        let builder = Type::primitive_type_builder(name, physical).with_logical_type(logical);
        builder.with_repetition(Repetition::REQUIRED).build().map(Arc::new)
    };
    let text = |name: &str| field(name, Physical::BYTE_ARRAY, Some(LogicalType::String));
    let mut fields = Vec::new();
    for name in INTEGERS {
        fields.push(field(name, Physical::INT64, None)?);
    }
    for name in heading.keys.iter().map(String::as_str).chain(TEXTS) {
        fields.push(text(name)?);
    }
    let columns = heading.identity.columns();
    let n_numbers = columns.numbers().len();
    for name in columns.numbers() {
        fields.push(field(&name, Physical::DOUBLE, None)?);
    }
    for name in columns.counts() {
        fields.push(field(name, Physical::INT64, None)?);
    }
    fields.push(text(FAILURE)?);
    let schema = Type::group_type_builder("campaign").with_fields(fields).build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("rins {}", Identity::VERSION))
        .set_key_value_metadata(Some(heading.identity.metadata()));
    let properties = Arc::new(properties.build());
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), properties)?;
    loop {
        let rows: Vec<Row> = rows.by_ref().take(GROUP).collect();
        if rows.is_empty() {
            break;
        }
        let rows = &rows[..];
        let mut group = writer.next_row_group()?;
        integers(&mut group, rows, |row| row.cell)?;
        integers(&mut group, rows, |row| row.run)?;
        for key in 0..heading.keys.len() {
            let value = |row: &Row| {
                let cell = usize::try_from(row.cell).unwrap_or(usize::MAX);
                heading.values.get(cell).map_or("", |values| values[key].as_str()).to_string()
            };
            texts(&mut group, rows, value)?;
        }
        texts(&mut group, rows, |row| row.parameter.clone())?;
        texts(&mut group, rows, |row| row.unit.clone())?;
        for column in 0..n_numbers {
            numbers(&mut group, rows, column)?;
        }
        for column in 0..columns.counts().len() {
            integers(&mut group, rows, |row| row.counts()[column])?;
        }
        texts(&mut group, rows, |row| row.failure.clone())?;
        group.close()?;
    }
    writer.close()?;
    Ok(())
}

type Group<'w, 'a> = SerializedRowGroupWriter<'w, Out<'a>>;

fn integers(
    group: &mut Group<'_, '_>,
    rows: &[Row],
    of: impl Fn(&Row) -> u64,
) -> Result<(), ParquetError> {
    let values: Vec<i64> =
        rows.iter().map(|row| i64::try_from(of(row)).unwrap_or(i64::MAX)).collect();
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<Int64Type>().write_batch(&values, None, None)?;
    column.close()
}

fn texts(
    group: &mut Group<'_, '_>,
    rows: &[Row],
    of: impl Fn(&Row) -> String,
) -> Result<(), ParquetError> {
    let values: Vec<ByteArray> =
        rows.iter().map(|row| ByteArray::from(of(row).into_bytes())).collect();
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<ByteArrayType>().write_batch(&values, None, None)?;
    column.close()
}

fn numbers(group: &mut Group<'_, '_>, rows: &[Row], place: usize) -> Result<(), ParquetError> {
    let values: Vec<f64> = rows.iter().map(|row| row.number(place)).collect();
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<DoubleType>().write_batch(&values, None, None)?;
    column.close()
}

fn missing() -> ParquetError {
    ParquetError::General("a column is missing".into())
}

impl Row {
    /// A number, in the order of [`Columns::numbers`].
    fn number(&self, column: usize) -> f64 {
        let Record { truth, estimate, covariances, nis_ratio, of_model } = &self.record;
        let more = of_model.map_or([f64::NAN; 2], |model| [model.prior_sigma, model.rank]);
        let before = if of_model.is_some() { 5 } else { 3 };
        match column {
            0 => *truth,
            1 => *estimate,
            2 => covariances.get(self.place).map_or(f64::NAN, |variance| variance.sqrt()),
            3 | 4 if of_model.is_some() => more[column - 3],
            _ => match covariances.get(column - before) {
                Some(covariance) => *covariance,
                None if column == before + covariances.len() => *nis_ratio,
                None => of_model.map_or(f64::NAN, |model| model.nees),
            },
        }
    }

    /// The integers of [`COUNTS`].
    fn counts(&self) -> [u64; COUNTS.len()] {
        self.record.of_model.map_or([0; COUNTS.len()], |model| {
            [model.nees_dof, model.iterations, u64::from(model.converged)]
        })
    }
}
