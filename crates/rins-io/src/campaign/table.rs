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
}

impl Identity {
    /// The version of the program, because numbers may change with it.
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");

    /// The identity in one line.
    pub(super) fn line(&self) -> String {
        let Self { scenario, runs, seed, shard: (shard, of) } = self;
        let scenario = serde_json::Value::from(scenario.as_str());
        format!("rins {} runs {runs} seed {seed} shard {shard}/{of} {scenario}", Self::VERSION)
    }

    /// The identity of the whole campaign.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self { shard: (1, 1), ..self.clone() }
    }

    fn metadata(&self) -> Vec<KeyValue> {
        let (shard, of) = self.shard;
        [
            ("rins.version", Self::VERSION.into()),
            ("rins.scenario", self.scenario.clone()),
            ("rins.runs", self.runs.to_string()),
            ("rins.seed", self.seed.to_string()),
            ("rins.shard", format!("{shard}/{of}")),
        ]
        .map(|(key, value)| KeyValue::new(key.into(), value))
        .into()
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
        })
    }
}

/// The result of one run for one parameter, in the unit of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The true value.
    pub truth: f64,
    /// The estimate; NaN if the run failed.
    pub estimate: f64,
    /// Its covariances with the three parameters.
    pub covariances: [f64; 3],
    /// The run's mean normalized innovation squared divided by its degrees of freedom.
    pub nis_ratio: f64,
}

/// A row: the scenario, the run, the parameter, and the result.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The index of the scenario in the grid, from 0.
    pub cell: u64,
    /// The index of the run, from 0.
    pub run: u64,
    /// The parameter's id.
    pub parameter: String,
    /// The unit of the numbers.
    pub unit: String,
    /// The result.
    pub record: Record,
    /// The failure reason; empty if the run did not fail.
    pub failure: String,
}

/// The rows of a run: its parameters in their order.
pub type RunRows = [Row; PARAMETERS.len()];

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

/// The integer columns.
pub(super) const INTEGERS: [&str; 2] = ["cell", "run"];
/// The text columns, which follow those of the grid.
pub(super) const TEXTS: [&str; 2] = ["parameter", "unit"];
/// The floating-point columns.
pub(super) const NUMBERS: [&str; 7] =
    ["truth", "estimate", "sigma", "covariance_1", "covariance_2", "covariance_3", "nis_ratio"];
/// The last column.
pub(super) const FAILURE: &str = "failure";

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
    for name in NUMBERS {
        fields.push(field(name, Physical::DOUBLE, None)?);
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
        for column in 0..NUMBERS.len() {
            numbers(&mut group, rows, column)?;
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
    let values: Vec<f64> = rows.iter().map(|row| row.numbers()[place]).collect();
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<DoubleType>().write_batch(&values, None, None)?;
    column.close()
}

fn missing() -> ParquetError {
    ParquetError::General("a column is missing".into())
}

impl Row {
    /// The numbers, in the order of the columns.
    fn numbers(&self) -> [f64; NUMBERS.len()] {
        let Record { truth, estimate, covariances: [a, b, c], nis_ratio } = self.record;
        let of_itself =
            place(&self.parameter).map_or(f64::NAN, |place| self.record.covariances[place]);
        [truth, estimate, of_itself.sqrt(), a, b, c, nis_ratio]
    }
}

/// The index of a parameter among the three.
fn place(parameter: &str) -> Option<usize> {
    PARAMETERS.iter().position(|id| *id == parameter)
}
