//! Columns of text, whose delimiter is determined automatically.

use std::io::BufRead;
use std::path::{Path, PathBuf};

use super::columns::{Columns, MOST_ROWS, Repeated, Wanted, WantedTime};
use super::head::Head;
use crate::error::{IoError, LogError};
use crate::log::damage::{Damage, is_of_a_row};
use crate::log::fields::Fields;
use crate::log::lines::Lines;
use crate::log::problem::LogProblem;
use crate::log::split_time;
use crate::log::summary::Omission;

/// Whether the columns may have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Header {
    Allowed,
    Refused,
}

/// Reads columns of the text log at `path`.
pub(super) fn read(path: &Path, header: Header, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    read_from(&mut Lines::open(path)?, header, wanted)
}

fn read_from<R: BufRead>(
    lines: &mut Lines<R>,
    header: Header,
    wanted: Wanted<'_>,
) -> Result<Columns, IoError> {
    let head = Head::read(lines, wanted.text)?;
    if let (Header::Refused, Some(first)) = (header, head.header()) {
        let problem = LogProblem::NotANumber { column: "1".into(), text: short(first) };
        return Err(LogError::at(lines.path(), head.line, problem));
    }
    let filter = wanted.rows;
    let mut rows = Rows::new(&head, lines.path(), wanted)?;
    if let Some((line, problem)) = head.cut.clone() {
        rows.note_damage(line, problem)?;
    }
    for (number, line) in &head.rows {
        rows.push(*number, line)?;
    }
    loop {
        match lines.next() {
            Ok(Some((number, line))) => rows.push(number, line)?,
            Ok(None) => break,
            // A part of a file that was not written is often zero.
            Err(IoError::Log(error)) if is_of_a_row(&error.problem) => {
                rows.note_damage(error.line.unwrap_or_default(), error.problem)?;
            }
            Err(error) => return Err(error),
        }
    }
    let Rows { mut columns, damage, .. } = rows;
    let refused = |(line, problem)| LogError::at(lines.path(), line, problem);
    damage.settle(&mut columns).map_err(refused)?;
    columns.left_out.extend(lines.unfinished().map(|line| (line, Omission::Unfinished)));
    if columns.lines.is_empty() {
        let problem = filter.map_or(LogProblem::OnlyHeader, |rows| LogProblem::NoSuchRows {
            column: rows.column.clone(),
            value: rows.value.clone(),
        });
        return Err(LogError::of(lines.path(), problem));
    }
    Ok(columns)
}

/// Reads some rows of a log whose head is known, up to the first that is damaged. The second value is the error of that row.
pub(in crate::log) fn read_rows(
    head: &Head,
    path: &Path,
    wanted: Wanted<'_>,
    lines: &[(u64, String)],
) -> Result<(Columns, Option<IoError>), IoError> {
    let mut rows = Rows::new(head, path, wanted)?;
    for (number, line) in lines {
        rows.push(*number, line)?;
        if let Err((line, problem)) = rows.damage.judge(0) {
            let refused = rows.refused(line, problem);
            return Ok((rows.columns, Some(refused)));
        }
    }
    Ok((rows.columns, None))
}

/// What a field is read as.
#[derive(Clone, Copy, Debug)]
enum Target {
    /// The number of the requested column with this index.
    Number(usize),
    /// The time stamp, or the first part of it.
    Time,
    /// The second part of the time stamp.
    SecondPart,
}

/// The rows while they are read.
struct Rows<'w> {
    head: &'w Head,
    path: PathBuf,
    names: &'w [&'w str],
    time: Option<WantedTime<'w>>,
    /// The places of the requested fields, in their order.
    places: Vec<(usize, Target)>,
    /// The requested column that may be empty.
    sparse: Option<&'w str>,
    /// The place and the text of the field that selects rows.
    filter: Option<(usize, &'w str)>,
    columns: Columns,
    /// The numbers of the row.
    values: Vec<f64>,
    before: String,
    repeated: Repeated,
    damage: Damage,
}

impl<'w> Rows<'w> {
    fn new(head: &'w Head, path: &Path, wanted: Wanted<'w>) -> Result<Self, IoError> {
        let Wanted { names, time, rows, sparse, .. } = wanted;
        let mut places = Vec::with_capacity(names.len() + 2);
        for (index, name) in names.iter().enumerate() {
            places.push((head.place(name, path)?, Target::Number(index)));
        }
        let parts = [Target::Time, Target::SecondPart];
        for (name, part) in time.iter().flat_map(WantedTime::names).zip(parts) {
            places.push((head.place(name, path)?, part));
        }
        places.sort_by_key(|(place, _)| *place);
        let filter = match rows {
            Some(rows) => Some((head.place(&rows.column, path)?, rows.value.as_str())),
            None => None,
        };
        Ok(Self {
            head,
            path: path.into(),
            names,
            time,
            places,
            sparse,
            filter,
            columns: Columns { numbers: vec![Vec::new(); names.len()], ..Columns::default() },
            values: vec![0.0; names.len()],
            before: String::new(),
            repeated: Repeated::default(),
            damage: Damage::default(),
        })
    }

    /// Appends the row in `line`, unless it is that of another sensor or repeats the one before.
    fn push(&mut self, number: u64, line: &str) -> Result<(), IoError> {
        let delimiter = self.head.delimiter;
        if let Some((place, value)) = self.filter
            && Fields::of(line, delimiter).nth(place).is_none_or(|field| field != value)
        {
            return Ok(());
        }
        // Some loggers write a sample twice; without a time stamp it could be two samples.
        if self.time.is_some() {
            let is_same = line == self.before;
            self.repeated
                .count(number, is_same)
                .map_err(|(line, problem)| LogError::at(&self.path, line, problem))?;
            if is_same {
                self.columns.left_out.push((number, Omission::Repeated));
                return Ok(());
            }
            self.before.clear();
            self.before.push_str(line);
        }
        let time = match self.values(line) {
            Ok(time) => time,
            Err(problem) => return self.note_damage(number, problem),
        };
        if self.columns.lines.len() as u64 >= MOST_ROWS {
            return Err(self.refused(number, LogProblem::ManyRows { most: MOST_ROWS }));
        }
        for (list, value) in self.columns.numbers.iter_mut().zip(&self.values) {
            list.push(*value);
        }
        self.columns.time.extend(time);
        self.columns.lines.push(number);
        Ok(())
    }

    fn note_damage(&mut self, line: u64, problem: LogProblem) -> Result<(), IoError> {
        let noted = self.damage.note(line, problem, MOST_ROWS);
        noted.map_err(|(line, problem)| self.refused(line, problem))
    }

    fn refused(&self, line: u64, problem: LogProblem) -> IoError {
        LogError::at(&self.path, line, problem)
    }

    /// Reads the numbers of a row, and returns its time stamp.
    fn values(&mut self, line: &str) -> Result<Option<f64>, LogProblem> {
        let decimal = self.head.decimal;
        let mut places = self.places.iter().copied().peekable();
        let mut fields = Fields::of(line, self.head.delimiter);
        let mut time = None;
        let mut parts = [None, None];
        let mut count = 0;
        let mut ends_empty = false;
        for field in fields.by_ref() {
            while let Some((_, target)) = places.next_if(|(place, _)| *place == count) {
                match target {
                    Target::Number(index)
                        if field.is_empty() && self.sparse == Some(self.names[index]) =>
                    {
                        self.values[index] = f64::NAN;
                    }
                    Target::Number(index) => {
                        let number = decimal.number(&field);
                        self.values[index] = number_of(self.names[index], &field, number)?;
                    }
                    Target::Time => match &mut self.time {
                        Some(WantedTime { column, split: None, instants }) => {
                            time = Some(number_of(
                                column,
                                &field,
                                instants.seconds(&decimal.plain(&field)),
                            )?);
                        }
                        _ => parts[0] = Some(field.clone()),
                    },
                    Target::SecondPart => parts[1] = Some(field.clone()),
                }
            }
            count += 1;
            ends_empty = field.is_empty();
        }
        if fields.has_open_quote() {
            return Err(LogProblem::OpenQuote);
        }
        // Some loggers end each line of numbers, but not the header, with a delimiter.
        let expected = self.head.count;
        if count != expected && !(count == expected + 1 && ends_empty) {
            return Err(LogProblem::FieldCount { got: count, expected });
        }
        if let (
            [Some(first), Some(second)],
            Some(WantedTime { column, split: Some(split), instants }),
        ) = (parts, &mut self.time)
        {
            time = Some(split_time::seconds(
                instants,
                split,
                (column, &first),
                &decimal.plain(&second),
            )?);
        }
        Ok(time)
    }
}

/// A field, shortened for an error message.
fn short(field: &str) -> String {
    field.chars().take(40).collect()
}

fn number_of(name: &str, field: &str, value: Option<f64>) -> Result<f64, LogProblem> {
    let column = name.to_string();
    let text = || short(field);
    match value {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(LogProblem::NotFinite { column, text: text() }),
        None if field.is_empty() => Err(LogProblem::EmptyField { column }),
        None => Err(LogProblem::NotANumber { column, text: text() }),
    }
}
