//! Columns of Parquet files.

mod pages;
mod whole;

use std::path::Path;

use parquet::basic::{ConvertedType, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use self::pages::SoundPages;
use self::whole::Whole;
use super::typed::{Numbers, most_rows, together};
use super::{Columns, MOST_COLUMNS, Wanted, place};
use crate::error::{IoError, LogError};
use crate::log::problem::LogProblem;
use crate::source;

/// The rows that are read at a time.
const BATCH: usize = 1 << 16;

/// By how much a page may grow when it is decompressed, over what any file may have.
const MOST_GROWTH: i64 = 256;

/// Reads columns of the Parquet file at `path`, row group by row group.
pub(super) fn read(path: &Path, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let failed = || IoError::file("read", path);
    let file = source::chunks(path).map_err(failed())?;
    let length = source::length(path).map_err(failed())?;
    if length == 0 {
        return Err(LogError::of(path, LogProblem::Empty));
    }
    let damaged = |error: ParquetError| LogError::of(path, damage(&error));
    let reader = SerializedFileReader::new(Whole(file)).map_err(damaged)?;
    let metadata = reader.metadata();
    let schema = metadata.file_metadata().schema_descr();
    let refuse = |problem| LogError::of(path, problem);
    if schema.num_columns() > MOST_COLUMNS {
        return Err(refuse(LogProblem::ManyColumns { most: MOST_COLUMNS }));
    }
    let most = most_rows(length);
    let rows: i64 = metadata.row_groups().iter().map(|group| group.num_rows().max(0)).sum();
    if rows.unsigned_abs() > most {
        return Err(refuse(LogProblem::ManyRows { most }));
    }
    let present: Vec<String> =
        schema.columns().iter().map(|column| column.path().string()).collect();
    let Wanted { names, time } = wanted;
    let asked = names.iter().copied().chain(time.as_ref().map(|(name, _)| *name));
    let mut lists = Vec::with_capacity(names.len() + 1);
    for name in asked {
        let place = place(name, &present).map_err(refuse)?;
        let kind = Kind::of(&schema.column(place)).ok_or_else(|| {
            let found = schema.column(place).physical_type().to_string();
            refuse(LogProblem::WrongColumn { column: name.into(), found })
        })?;
        let mut list = kind.empty();
        for (index, group) in metadata.row_groups().iter().enumerate() {
            let chunk = group.columns().get(place).ok_or_else(|| {
                damaged(ParquetError::General("a row group lacks a column".into()))
            })?;
            refuse_unsound(chunk, length).map_err(refuse)?;
            let pages = reader
                .get_row_group(index)
                .and_then(|group| group.get_column_page_reader(place))
                .map_err(damaged)?;
            let pages = Box::new(SoundPages::new(pages, &schema.column(place), most));
            let pages = get_column_reader(schema.column(place), pages);
            let before = list.len();
            match read_chunk(pages, kind, most, &mut list) {
                Ok(Some(null)) => {
                    let problem = LogProblem::EmptyField { column: name.into() };
                    return Err(LogError::at(path, (before + null) as u64 + 1, problem));
                }
                Ok(None) => {}
                Err(error) => return Err(damaged(error)),
            }
        }
        if i64::try_from(list.len()) != Ok(rows) {
            return Err(damaged(ParquetError::General(format!(
                "column {name:?} has {} of {rows} rows",
                list.len()
            ))));
        }
        lists.push(list);
    }
    let stamps = time.map(|(name, instants)| {
        let list = lists.pop().map_or_else(Vec::new, |list| list.stamps(instants));
        (name, list)
    });
    let numbers = lists.into_iter().map(Numbers::plain).collect();
    together(path, names, numbers, stamps)
}

/// What the parser says, as one line.
fn damage(error: &ParquetError) -> LogProblem {
    let text = error.to_string();
    LogProblem::Damaged { format: "Parquet", message: text.lines().collect::<Vec<_>>().join(", ") }
}

/// Refuses a column that lies nowhere, or that says that a few bytes hold very many.
fn refuse_unsound(chunk: &ColumnChunkMetaData, length: u64) -> Result<(), LogProblem> {
    let start = chunk.dictionary_page_offset().unwrap_or(chunk.data_page_offset());
    // The parser takes these for granted.
    if start < 0 || chunk.compressed_size() < 0 {
        let message = "a column's place in the file is negative".into();
        return Err(LogProblem::Damaged { format: "Parquet", message });
    }
    let most = i64::try_from(length).unwrap_or(i64::MAX).saturating_mul(MOST_GROWTH);
    if chunk.uncompressed_size() > most.max(1 << 24) {
        return Err(LogProblem::ManyRows { most: most_rows(length) });
    }
    Ok(())
}

/// How numbers are kept in a column.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Real,
    Signed,
    Unsigned,
}

impl Kind {
    /// `None` if it holds no numbers, or not one a row.
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

/// Adds a row group's numbers to `list`; the index of the first that is missing, if one is.
fn read_chunk(
    pages: ColumnReader,
    kind: Kind,
    most: u64,
    list: &mut Numbers,
) -> Result<Option<usize>, ParquetError> {
    let unsigned = kind == Kind::Unsigned;
    match (pages, list) {
        (ColumnReader::DoubleColumnReader(pages), Numbers::Real(list)) => {
            batches(pages, most, list, Some)
        }
        (ColumnReader::FloatColumnReader(pages), Numbers::Real(list)) => {
            batches(pages, most, list, |number| Some(number.into()))
        }
        (ColumnReader::Int32ColumnReader(pages), Numbers::Whole(list)) => {
            let widen = |n: i32| Some(if unsigned { n.cast_unsigned().into() } else { n.into() });
            batches(pages, most, list, widen)
        }
        (ColumnReader::Int64ColumnReader(pages), Numbers::Whole(list)) => {
            batches(pages, most, list, |n| (n >= 0 || !unsigned).then_some(n))
        }
        _ => Err(ParquetError::General("a column changes its type".into())),
    }
}

fn batches<T: DataType, N>(
    mut pages: ColumnReaderImpl<T>,
    most: u64,
    list: &mut Vec<N>,
    number: impl Fn(T::T) -> Option<N>,
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
        if values < rows {
            let most = levels.iter().copied().max().unwrap_or_default().max(1);
            let null = levels.iter().position(|level| *level < most).unwrap_or_default();
            return Ok(Some(list.len() - before + null));
        }
        if rows == 0 {
            return Ok(None);
        }
        for &value in &batch {
            list.push(number(value).ok_or_else(|| {
                ParquetError::General("a number is larger than any time or count".into())
            })?);
        }
        if list.len() as u64 > most {
            return Err(ParquetError::General("more rows than are declared".into()));
        }
    }
}
