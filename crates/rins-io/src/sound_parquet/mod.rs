//! Parquet files that are checked for the properties which the parser assumes.

mod pages;
mod runs;
mod whole;

use std::path::{Path, PathBuf};

use parquet::basic::Compression;
use parquet::column::reader::{ColumnReader, get_column_reader};
use parquet::errors::ParquetError;
use parquet::file::metadata::{ColumnChunkMetaData, KeyValue};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescPtr;

use self::pages::SoundPages;
use self::whole::Whole;
use crate::error::{IoError, LogError};
use crate::log::{LogProblem, MOST_COLUMNS, most_rows};
use crate::source;

/// The maximum growth of a page by decompression, beyond the size that any file may have.
const MOST_GROWTH: u64 = 256;

/// A Parquet file whose pages are checked before they are parsed.
pub(crate) struct SoundParquet {
    path: PathBuf,
    /// The length \[bytes\].
    length: u64,
    reader: SerializedFileReader<Whole<source::Chunks>>,
}

impl SoundParquet {
    /// Opens the file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Log`] if it is not a Parquet file, or has more
    /// rows or columns than permitted.
    pub(crate) fn open(path: &Path) -> Result<Self, IoError> {
        let failed = || IoError::file("read", path);
        let file = source::chunks(path).map_err(failed())?;
        let length = source::length(path).map_err(failed())?;
        let refuse = |problem| LogError::of(path, problem);
        if length == 0 {
            return Err(refuse(LogProblem::Empty));
        }
        let whole = Whole { file, most: most_bytes(length) };
        let reader = SerializedFileReader::new(whole).map_err(|error| refuse(damage(&error)))?;
        let sound = Self { path: path.into(), length, reader };
        if sound.columns().len() > MOST_COLUMNS {
            return Err(refuse(LogProblem::ManyColumns { most: MOST_COLUMNS }));
        }
        let most = sound.most_rows();
        if sound.rows() > most {
            return Err(refuse(LogProblem::ManyRows { most }));
        }
        Ok(sound)
    }

    /// The length of the file \[bytes\].
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    /// The maximum number of rows of a file of this length.
    pub(crate) fn most_rows(&self) -> u64 {
        most_rows(self.length)
    }

    /// The number of rows according to its metadata.
    pub(crate) fn rows(&self) -> u64 {
        let groups = self.reader.metadata().row_groups().iter();
        groups.fold(0, |rows, group| rows.saturating_add(group.num_rows().max(0).unsigned_abs()))
    }

    /// The number of row groups.
    pub(crate) fn groups(&self) -> usize {
        self.reader.metadata().num_row_groups()
    }

    /// The descriptions of its columns.
    pub(crate) fn columns(&self) -> &[ColumnDescPtr] {
        self.reader.metadata().file_metadata().schema_descr().columns()
    }

    /// The key-value metadata.
    pub(crate) fn key_values(&self) -> &[KeyValue] {
        let pairs = self.reader.metadata().file_metadata().key_value_metadata();
        pairs.map_or(&[], Vec::as_slice)
    }

    /// A reader of a column's part in one row group.
    ///
    /// # Errors
    /// [`IoError::Log`] if its position is outside the file, or a few bytes are said to hold a very large number of values.
    pub(crate) fn column(&self, group: usize, place: usize) -> Result<ColumnReader, IoError> {
        let damaged = |error| self.damaged(&error);
        let part =
            self.reader.metadata().row_group(group).columns().get(place).ok_or_else(|| {
                damaged(ParquetError::General("a row group lacks a column".into()))
            })?;
        if !is_readable(part.compression()) {
            let named = part.compression().to_string();
            let codec = named.split('(').next().unwrap_or_default().to_lowercase();
            return Err(LogError::of(&self.path, LogProblem::Codec { codec }));
        }
        refuse_unsound(part, self.length).map_err(|problem| LogError::of(&self.path, problem))?;
        let group = self.reader.get_row_group(group).map_err(damaged)?;
        let pages = group.get_column_page_reader(place).map_err(damaged)?;
        let column = &self.columns()[place];
        let pages = SoundPages::new(pages, column, self.most_rows());
        Ok(get_column_reader(column.clone(), Box::new(pages)))
    }

    /// The error of the parser as an error of this file.
    pub(crate) fn damaged(&self, error: &ParquetError) -> IoError {
        LogError::of(&self.path, damage(error))
    }
}

/// Whether the parser is built with the codec of these pages.
fn is_readable(compression: Compression) -> bool {
    matches!(compression, Compression::UNCOMPRESSED | Compression::SNAPPY | Compression::GZIP(_))
}

/// The error message of the parser as one line.
fn damage(error: &ParquetError) -> LogProblem {
    let text = error.to_string();
    LogProblem::Damaged { format: "Parquet", message: text.lines().collect::<Vec<_>>().join(", ") }
}

/// The maximum number of bytes to which a column of a file of this length may be decompressed.
fn most_bytes(length: u64) -> u64 {
    length.saturating_mul(MOST_GROWTH).max(1 << 24)
}

/// Refuses a column whose position is outside the file, or whose few bytes are said to hold a very large number of values.
fn refuse_unsound(part: &ColumnChunkMetaData, length: u64) -> Result<(), LogProblem> {
    let start = part.dictionary_page_offset().unwrap_or(part.data_page_offset());
    // The parser assumes these properties.
    if start < 0 || part.compressed_size() < 0 {
        let message = "a column's place in the file is negative".into();
        return Err(LogProblem::Damaged { format: "Parquet", message });
    }
    if part.uncompressed_size().max(0).unsigned_abs() > most_bytes(length) {
        return Err(LogProblem::ManyRows { most: most_rows(length) });
    }
    Ok(())
}
