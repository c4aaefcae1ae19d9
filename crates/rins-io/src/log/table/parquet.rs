//! Columns of Parquet files.

use std::path::Path;

use parquet::basic::{ConvertedType, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;

use super::columns::{Columns, Wanted, WantedTime, place};
use super::typed::{Numbers, stamps, together};
use crate::error::{IoError, LogError};
use crate::log::problem::LogProblem;
use crate::sound_parquet::SoundParquet;

/// The number of rows that are read at once.
const BATCH: usize = 1 << 16;

/// Reads columns of the Parquet file at `path`, row group by row group.
pub(super) fn read(path: &Path, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let file = SoundParquet::open(path)?;
    let (rows, most) = (file.rows(), file.most_rows());
    let refuse = |problem| LogError::of(path, problem);
    let present: Vec<String> = file.columns().iter().map(|column| column.path().string()).collect();
    let Wanted { names, time, .. } = wanted;
    let asked = names.iter().copied().chain(time.iter().flat_map(WantedTime::names));
    let mut lists = Vec::with_capacity(names.len() + 1);
    for name in asked {
        let place = place(name, &present).map_err(refuse)?;
        let column = &file.columns()[place];
        let kind = Kind::of(column).ok_or_else(|| {
            let found = column.physical_type().to_string();
            refuse(LogProblem::WrongColumn { column: name.into(), found })
        })?;
        let mut list = kind.empty();
        for group in 0..file.groups() {
            let before = list.len();
            match read_part(file.column(group, place)?, kind, most, &mut list) {
                Ok(Some(null)) => {
                    let problem = LogProblem::EmptyField { column: name.into() };
                    return Err(LogError::at(path, (before + null) as u64 + 1, problem));
                }
                Ok(None) => {}
                Err(error) => return Err(file.damaged(&error)),
            }
        }
        if list.len() as u64 != rows {
            return Err(file.damaged(&ParquetError::General(format!(
                "column {name:?} has {} of {rows} rows",
                list.len()
            ))));
        }
        lists.push(list);
    }
    let stamps = time.map(|time| stamps(path, time, &mut lists)).transpose()?;
    let numbers = lists.into_iter().map(Numbers::plain).collect();
    together(path, names, numbers, stamps)
}

/// The names of the columns of numbers of the Parquet file at `path`.
pub(super) fn names(path: &Path) -> Result<Vec<String>, IoError> {
    let file = SoundParquet::open(path)?;
    let numeric = file.columns().iter().filter(|column| Kind::of(column).is_some());
    Ok(numeric.map(|column| column.path().string()).collect())
}

/// The representation of a column's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Real,
    Signed,
    Unsigned,
}

impl Kind {
    /// The representation; `None` if the column does not contain one number per row.
    fn of(column: &ColumnDescriptor) -> Option<Self> {
        if column.max_rep_level() > 0 {
            return None;
        }
        let unsigned = matches!(
            column.converted_type(),
            ConvertedType::UINT_8
                | ConvertedType::UINT_16
                | ConvertedType::UINT_32
                | ConvertedType::UINT_64
        );
        match (column.physical_type(), column.converted_type()) {
            (Type::FLOAT | Type::DOUBLE, _) => Some(Self::Real),
            (Type::INT32 | Type::INT64, ConvertedType::DECIMAL) => None,
            (Type::INT32 | Type::INT64, _) if unsigned => Some(Self::Unsigned),
            (Type::INT32 | Type::INT64, _) => Some(Self::Signed),
            _ => None,
        }
    }

    fn empty(self) -> Numbers {
        if self == Self::Real { Numbers::Real(Vec::new()) } else { Numbers::Whole(Vec::new()) }
    }
}

/// Appends a row group's numbers to `list`, NaN where one is missing; of integers, returns the index of the first missing number, if there is one.
fn read_part(
    pages: ColumnReader,
    kind: Kind,
    most: u64,
    list: &mut Numbers,
) -> Result<Option<usize>, ParquetError> {
    let unsigned = kind == Kind::Unsigned;
    match (pages, list) {
        (ColumnReader::DoubleColumnReader(pages), Numbers::Real(list)) => {
            batches(pages, most, list, Reading { number: Some, missing: Some(f64::NAN) })
        }
        (ColumnReader::FloatColumnReader(pages), Numbers::Real(list)) => {
            let number = |number: f32| Some(number.into());
            batches(pages, most, list, Reading { number, missing: Some(f64::NAN) })
        }
        (ColumnReader::Int32ColumnReader(pages), Numbers::Whole(list)) => {
            let widen = |n: i32| Some(if unsigned { n.cast_unsigned().into() } else { n.into() });
            batches(pages, most, list, Reading { number: widen, missing: None })
        }
        (ColumnReader::Int64ColumnReader(pages), Numbers::Whole(list)) => {
            let number = |n: i64| (n >= 0 || !unsigned).then_some(n);
            batches(pages, most, list, Reading { number, missing: None })
        }
        _ => Err(ParquetError::General("a column changes its type".into())),
    }
}

/// The reading of a column's values.
struct Reading<F, N> {
    /// The number of a value; `None` if it is too large.
    number: F,
    /// What stands for a missing number, if anything can.
    missing: Option<N>,
}

fn batches<T: DataType, N: Copy, F: Fn(T::T) -> Option<N>>(
    mut pages: ColumnReaderImpl<T>,
    most: u64,
    list: &mut Vec<N>,
    Reading { number, missing }: Reading<F, N>,
) -> Result<Option<usize>, ParquetError>
where
    T::T: Copy,
{
    let before = list.len();
    let (mut batch, mut levels) = (Vec::with_capacity(BATCH), Vec::with_capacity(BATCH));
    loop {
        batch.clear();
        levels.clear();
        let (rows, values, _) = pages.read_records(BATCH, Some(&mut levels), None, &mut batch)?;
        if rows == 0 {
            return Ok(None);
        }
        let present = levels.iter().copied().max().unwrap_or_default().max(1);
        let mut read = batch.iter();
        for row in 0..rows {
            let is_missing = values < rows && levels.get(row).is_none_or(|level| *level < present);
            let value = if is_missing { None } else { read.next() };
            let number = match (value, missing) {
                (Some(&value), _) => number(value),
                (None, Some(missing)) => Some(missing),
                (None, None) => return Ok(Some(list.len() - before)),
            };
            list.push(number.ok_or_else(|| {
                ParquetError::General("a number is larger than any time or count".into())
            })?);
        }
        if list.len() as u64 > most {
            return Err(ParquetError::General("more rows than are declared".into()));
        }
    }
}
