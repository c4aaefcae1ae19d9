//! Reading the results of a campaign from Parquet.

use std::fmt;
use std::path::Path;

use parquet::basic::{Repetition, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;
use rins_campaign::PARAMETERS;

use super::grid::MOST_CELLS;
use super::table::{
    Columns, FAILURE, Heading, INTEGERS, Identity, ModelRecord, Record, Row, RunRows, TEXTS,
};
use crate::error::IoError;
use crate::sound_parquet::SoundParquet;

/// The number of values of all columns of all open files together that are buffered while they are converted to rows.
const BATCH: usize = 1 << 16;

/// The minimum number of rows that are buffered.
const LEAST_ROWS: usize = 64;

/// The maximum number of values (rows times columns) of any file, however small it is.
const MOST_VALUES: u64 = 1 << 28;

/// The maximum memory for the grid's values and the failure reasons, however small the file is that repeats them \[bytes\].
const MOST_TEXT: usize = 1 << 28;

/// The longest unit \[bytes\].
const LONGEST_UNIT: usize = 32;

/// The longest id of a parameter \[bytes\].
const LONGEST_ID: usize = 128;

/// The runs of a result file, one by one, in the order of scenarios and runs.
///
/// Only a few of them are in memory at a time. The iterator ends after an error.
pub struct PartRuns {
    file: SoundParquet,
    heading: Heading,
    /// The columns of the current row group.
    readers: Vec<ColumnReader>,
    /// The number of row groups that were opened.
    groups: usize,
    batch: Vec<Values>,
    /// The maximum number of rows of a batch.
    most_rows: usize,
    /// The next row of the batch.
    row: usize,
    /// The remaining memory for texts \[bytes\].
    room: usize,
    /// The scenario and the number of the previous run.
    last: Option<(u64, u64)>,
    /// The parameters of every run, in their order.
    ids: Option<Vec<String>>,
}

impl fmt::Debug for PartRuns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PartRuns").field("heading", &self.heading).finish_non_exhaustive()
    }
}

impl PartRuns {
    /// Opens a result file.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error, [`IoError::Log`] if the file is not a result file of a campaign in this version.
    pub fn open(path: &Path) -> Result<Self, IoError> {
        Self::open_one_of(path, 1)
    }

    /// Opens one of `n_open` result files that are read at the same time and share the memory of the buffers.
    ///
    /// # Errors
    /// As of [`Self::open`].
    pub fn open_one_of(path: &Path, n_open: usize) -> Result<Self, IoError> {
        let file = SoundParquet::open(path)?;
        let damaged = |error| file.damaged(&error);
        let identity = Identity::from_metadata(file.key_values())
            .ok_or_else(|| damaged(wrong("no campaign of this version of rins")))?;
        let layout = Layout::of(&file, identity.columns()).map_err(damaged)?;
        let columns = file.columns().len();
        if file.rows().saturating_mul(columns as u64) > MOST_VALUES.max(file.length()) {
            return Err(damaged(wrong("more rows than its length can hold")));
        }
        let room = MOST_TEXT.max(usize::try_from(file.length()).unwrap_or(usize::MAX));
        Ok(Self {
            heading: Heading { identity, keys: layout.keys, values: Vec::new() },
            file,
            readers: Vec::new(),
            groups: 0,
            batch: Vec::new(),
            most_rows: (BATCH / columns / n_open.max(1)).max(LEAST_ROWS),
            row: 0,
            room,
            last: None,
            ids: None,
        })
    }

    /// The heading of the runs, with the scenarios that were read so far.
    pub fn heading(&self) -> &Heading {
        &self.heading
    }

    /// Reads the next batch at the end of the current one; returns whether there is a row.
    fn fill(&mut self) -> Result<bool, IoError> {
        let columns = self.file.columns().len();
        loop {
            let damaged = |error| self.file.damaged(&error);
            if self.batch.first().is_some_and(|values| self.row < values.len()) {
                return Ok(true);
            }
            let batch = self.readers.iter_mut();
            self.batch = batch
                .map(|reader| Values::read(reader, self.most_rows))
                .collect::<Result<_, _>>()
                .map_err(damaged)?;
            self.row = 0;
            let rows = self.batch.first().map_or(0, Values::len);
            if self.batch.iter().any(|values| values.len() != rows) {
                return Err(damaged(wrong("columns of different lengths")));
            }
            if rows == 0 {
                if self.groups == self.file.groups() {
                    return Ok(false);
                }
                let group = self.groups;
                self.readers = (0..columns)
                    .map(|place| self.file.column(group, place))
                    .collect::<Result<_, _>>()?;
                self.groups += 1;
            }
        }
    }

    /// The next row, that of the parameter `place` of its run; `None` at the end.
    fn read(&mut self, place: usize) -> Result<Option<Row>, IoError> {
        if !self.fill()? {
            return Ok(None);
        }
        let at = Place { batch: &self.batch, row: self.row };
        let row = read_row(&mut self.heading, &at, place, &mut self.room);
        self.row += 1;
        row.map(Some).map_err(|error| self.file.damaged(&error))
    }

    /// The rows of the next run; `None` at the end.
    fn run(&mut self) -> Result<Option<RunRows>, IoError> {
        let n_rows = self.heading.identity.parameters();
        let mut rows = Vec::with_capacity(n_rows);
        while rows.len() < n_rows {
            match self.read(rows.len())? {
                Some(row) => rows.push(row),
                None if rows.is_empty() => return Ok(None),
                None => break,
            }
        }
        let damaged = |what| self.file.damaged(&wrong(what));
        let [first, ..] = &rows[..] else { return Ok(None) };
        let place = (first.cell, first.run);
        let of_model = self.heading.identity.model.is_some();
        let ids = self.ids.get_or_insert_with(|| {
            if of_model {
                rows.iter().map(|row| row.parameter.clone()).collect()
            } else {
                PARAMETERS.map(String::from).into()
            }
        });
        if rows.len() != n_rows
            || rows.iter().any(|row| (row.cell, row.run) != place)
            || rows.iter().zip(ids).any(|(row, id)| row.parameter != *id)
        {
            return Err(damaged(if of_model {
                "a run without its parameters in their order"
            } else {
                "a run without its three parameters in their order"
            }));
        }
        if self.last.is_some_and(|last| place <= last) {
            return Err(damaged("runs that are not in their order"));
        }
        self.last = Some(place);
        Ok(Some(rows))
    }
}

impl Iterator for PartRuns {
    type Item = Result<RunRows, IoError>;

    fn next(&mut self) -> Option<Self::Item> {
        let run = self.run();
        if run.is_err() {
            (self.groups, self.batch) = (self.file.groups(), Vec::new());
            self.readers.clear();
        }
        run.transpose()
    }
}

fn wrong(what: &str) -> ParquetError {
    ParquetError::General(what.into())
}

/// The columns of a result file.
struct Layout {
    keys: Vec<String>,
}

impl Layout {
    fn of(file: &SoundParquet, own: Columns) -> Result<Self, ParquetError> {
        let columns = file.columns();
        let (numbers, counts) = (own.numbers(), own.counts());
        let fixed = INTEGERS.len() + TEXTS.len() + numbers.len() + counts.len() + 1;
        let n_keys = columns.len().checked_sub(fixed).ok_or_else(|| wrong("too few columns"))?;
        let keys: Vec<String> = columns[INTEGERS.len()..INTEGERS.len() + n_keys]
            .iter()
            .map(|column| column.name().into())
            .collect();
        let texts = keys.iter().map(String::as_str).chain(TEXTS);
        let expected = (INTEGERS.into_iter().map(|name| (name, Type::INT64)))
            .chain(texts.map(|name| (name, Type::BYTE_ARRAY)))
            .chain(numbers.iter().map(|name| (name.as_str(), Type::DOUBLE)))
            .chain(counts.iter().map(|&name| (name, Type::INT64)))
            .chain([(FAILURE, Type::BYTE_ARRAY)]);
        for (column, (name, kind)) in columns.iter().zip(expected) {
            if !is(column, name, kind) {
                return Err(wrong(&format!("a campaign has a column {name:?} of {kind} here")));
            }
        }
        Ok(Self { keys })
    }
}

/// Whether a column has this name and type, and a value in each row.
fn is(column: &ColumnDescriptor, name: &str, kind: Type) -> bool {
    column.name() == name
        && column.physical_type() == kind
        && column.path().parts().len() == 1
        && column.self_type().get_basic_info().repetition() == Repetition::REQUIRED
}

/// The values of a column in a batch of rows.
enum Values {
    Integers(Vec<i64>),
    Numbers(Vec<f64>),
    Texts(Vec<ByteArray>),
}

impl Values {
    fn read(reader: &mut ColumnReader, rows: usize) -> Result<Self, ParquetError> {
        Ok(match reader {
            ColumnReader::Int64ColumnReader(reader) => Self::Integers(next(reader, rows)?),
            ColumnReader::DoubleColumnReader(reader) => Self::Numbers(next(reader, rows)?),
            ColumnReader::ByteArrayColumnReader(reader) => Self::Texts(next(reader, rows)?),
            _ => return Err(wrong("a column changes its type")),
        })
    }

    fn len(&self) -> usize {
        match self {
            Self::Integers(values) => values.len(),
            Self::Numbers(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }
}

fn next<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
) -> Result<Vec<T::T>, ParquetError> {
    let mut values = Vec::new();
    reader.read_records(rows, None, None, &mut values)?;
    Ok(values)
}

/// A row of a batch.
struct Place<'b> {
    batch: &'b [Values],
    row: usize,
}

impl Place<'_> {
    fn whole(&self, column: usize) -> Result<u64, ParquetError> {
        match &self.batch[column] {
            Values::Integers(values) => {
                u64::try_from(values[self.row]).map_err(|_| wrong("a negative count"))
            }
            _ => Err(wrong("a column changes its type")),
        }
    }

    fn number(&self, column: usize) -> Result<f64, ParquetError> {
        match &self.batch[column] {
            Values::Numbers(values) => Ok(values[self.row]),
            _ => Err(wrong("a column changes its type")),
        }
    }

    fn text(&self, column: usize) -> Result<&str, ParquetError> {
        match &self.batch[column] {
            Values::Texts(values) => values[self.row].as_utf8(),
            _ => Err(wrong("a column changes its type")),
        }
    }

    /// A text of any length, which is subtracted from the remaining `room`.
    fn long_text(&self, column: usize, room: &mut usize) -> Result<String, ParquetError> {
        let text = self.text(column)?;
        let left = room.checked_sub(text.len());
        *room = left.ok_or_else(|| wrong("more text than its length can hold"))?;
        Ok(text.into())
    }
}

/// The row at this place, that of the parameter `index` of its run; its scenario is added to the heading.
fn read_row(
    heading: &mut Heading,
    at: &Place<'_>,
    index: usize,
    room: &mut usize,
) -> Result<Row, ParquetError> {
    let n_keys = heading.keys.len();
    let cell = at.whole(0)?;
    let place = usize::try_from(cell).ok().filter(|place| *place < MOST_CELLS);
    let place = place.ok_or_else(|| wrong("a scenario beyond those that a grid can have"))?;
    if place >= heading.values.len() {
        // Rows are in the order of scenarios.
        heading.values.resize(place + 1, Vec::new());
        heading.values[place] = (0..n_keys)
            .map(|key| at.long_text(INTEGERS.len() + key, room))
            .collect::<Result<_, _>>()?;
    } else if place + 1 != heading.values.len() {
        return Err(wrong("rows that are not in the order of their scenarios"));
    }
    let texts = INTEGERS.len() + n_keys;
    let first = texts + TEXTS.len();
    let number = |place: usize| at.number(first + place);
    let Columns { parameters, model } = heading.identity.columns();
    let parameter = at.text(texts)?;
    if !model && !PARAMETERS.contains(&parameter) || parameter.len() > LONGEST_ID {
        return Err(wrong("a parameter that no campaign estimates"));
    }
    let unit = at.text(texts + 1)?;
    if unit.len() > LONGEST_UNIT {
        return Err(wrong("an unknown unit"));
    }
    let before = if model { 5 } else { 3 };
    let after = before + parameters;
    let of_model = |()| {
        Ok::<_, ParquetError>(ModelRecord {
            prior_sigma: number(3)?,
            rank: number(4)?,
            nees: number(after + 1)?,
            nees_dof: at.whole(first + after + 2)?,
            iterations: at.whole(first + after + 3)?,
            converged: at.whole(first + after + 4)? != 0,
        })
    };
    let last = first + after + if model { 5 } else { 1 };
    Ok(Row {
        cell,
        run: at.whole(1)?,
        place: index,
        parameter: parameter.into(),
        unit: unit.into(),
        record: Record {
            truth: number(0)?,
            estimate: number(1)?,
            covariances: (before..after).map(number).collect::<Result<_, _>>()?,
            nis_ratio: number(after)?,
            of_model: model.then_some(()).map(of_model).transpose()?,
        },
        failure: at.long_text(last, room)?,
    })
}
