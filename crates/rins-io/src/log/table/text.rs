//! Columns of text, whose delimiter is determined automatically.

use std::io::BufRead;
use std::path::Path;

use super::columns::{Columns, MOST_COLUMNS, MOST_ROWS, Repeated, Wanted, listed, place};
use crate::error::{IoError, LogError};
use crate::log::fields::{Delimiter, Fields};
use crate::log::lines::Lines;
use crate::log::problem::LogProblem;
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
    let Wanted { names, mut time } = wanted;
    let head = Head::read(lines)?;
    if let (Header::Refused, Some(first)) = (header, head.header()) {
        let problem = LogProblem::NotANumber { column: "1".into(), text: short(first) };
        return Err(LogError::at(lines.path(), head.line, problem));
    }
    let mut places = Vec::with_capacity(names.len() + 1);
    for (index, name) in names.iter().enumerate() {
        places.push((head.place(name, lines.path())?, Some(index)));
    }
    if let Some((name, _)) = &time {
        places.push((head.place(name, lines.path())?, None));
    }
    places.sort_by_key(|(place, _)| *place);

    let mut columns = Columns { numbers: vec![Vec::new(); names.len()], ..Columns::default() };
    let path = lines.path().to_path_buf();
    let mut before = String::new();
    let mut repeated = Repeated::default();
    let mut row = |number: u64, line: &str| -> Result<(), IoError> {
        // Some loggers write a sample twice; without a time stamp it could be two samples.
        if time.is_some() {
            let is_same = line == before;
            repeated
                .count(number, is_same)
                .map_err(|(line, problem)| LogError::at(&path, line, problem))?;
            if is_same {
                columns.left_out.push((number, Omission::Repeated));
                return Ok(());
            }
            before.clear();
            before.push_str(line);
        }
        let refuse = |problem| LogError::at(&path, number, problem);
        let mut places = places.iter().copied().peekable();
        let mut fields = Fields::of(line, head.delimiter);
        let mut count = 0;
        let mut ends_empty = false;
        for field in fields.by_ref() {
            while let Some((_, index)) = places.next_if(|(place, _)| *place == count) {
                let (name, value) = match (index, &mut time) {
                    (None, Some((name, instants))) => (*name, instants.seconds(&field)),
                    (index, _) => (names[index.unwrap_or_default()], field.parse().ok()),
                };
                let value = number_of(name, &field, value).map_err(refuse)?;
                match index {
                    Some(index) => columns.numbers[index].push(value),
                    None => columns.time.push(value),
                }
            }
            count += 1;
            ends_empty = field.is_empty();
        }
        if fields.has_open_quote() {
            return Err(refuse(LogProblem::OpenQuote));
        }
        // Some loggers end each line of numbers, but not the header, with a delimiter.
        let trailing = count == head.count + 1 && ends_empty;
        if count != head.count && !trailing {
            return Err(refuse(LogProblem::FieldCount { got: count, expected: head.count }));
        }
        if columns.lines.len() as u64 >= MOST_ROWS {
            return Err(refuse(LogProblem::ManyRows { most: MOST_ROWS }));
        }
        columns.lines.push(number);
        Ok(())
    };
    for (number, line) in &head.rows {
        row(*number, line)?;
    }
    while let Some((number, line)) = lines.next()? {
        row(number, line)?;
    }
    columns.left_out.extend(lines.unfinished().map(|line| (line, Omission::Unfinished)));
    if columns.lines.is_empty() {
        return Err(LogError::of(lines.path(), LogProblem::OnlyHeader));
    }
    Ok(columns)
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

/// The first lines of a text log, which are read before the columns are assigned.
#[derive(Clone, Debug, PartialEq)]
pub struct LogHead {
    /// The delimiter.
    pub delimiter: Delimiter,
    /// The columns' names, if there are any.
    pub names: Option<Vec<String>>,
    /// The fields of the first rows, at most two.
    pub rows: Vec<Vec<String>>,
}

/// Reads the first lines of the text log at `path`.
///
/// # Errors
/// [`IoError::File`] if it cannot be read, [`IoError::Log`] if it is empty or not text.
pub fn peek(path: &Path) -> Result<LogHead, IoError> {
    let Head { delimiter, names, rows, .. } = Head::read(&mut Lines::open(path)?)?;
    let fields = |(_, row): &(u64, String)| Fields::of(row, delimiter).map(String::from).collect();
    Ok(LogHead { delimiter, names, rows: rows.iter().map(fields).collect() })
}

/// The first lines of a text log.
pub(crate) struct Head {
    pub(crate) delimiter: Delimiter,
    /// The columns' names, if there are any.
    pub(crate) names: Option<Vec<String>>,
    /// The number of columns.
    pub(crate) count: usize,
    /// The line of the names, or the first line of numbers.
    line: u64,
    /// The rows of numbers in these lines.
    pub(crate) rows: Vec<(u64, String)>,
}

impl Head {
    pub(crate) fn read<R: BufRead>(lines: &mut Lines<R>) -> Result<Self, IoError> {
        let owned = |(line, text): (u64, &str)| (line, text.to_string());
        let empty = |lines: &Lines<R>| LogError::of(lines.path(), lines.emptiness());
        let mut opening = lines.next()?.map(owned).ok_or_else(|| empty(lines))?;
        let stated = Delimiter::stated(&opening.1);
        if stated.is_some() {
            opening = lines.next()?.map(owned).ok_or_else(|| empty(lines))?;
        }
        let (line, first) = opening;
        let comment = lines.comment().map(str::to_string);
        let mut second = lines.next()?.map(owned);
        let delimiter = stated.unwrap_or_else(|| {
            Delimiter::sniff(&first, second.as_ref().map(|(_, text)| text.as_str()))
        });
        let fields =
            |text: &str| -> Vec<String> { Fields::of(text, delimiter).map(String::from).collect() };
        let opening = fields(&first);
        let count = opening.len();
        if count > MOST_COLUMNS {
            let problem = LogProblem::ManyColumns { most: MOST_COLUMNS };
            return Err(LogError::at(lines.path(), line, problem));
        }
        let is_word = |field: &String| field.parse::<f64>().is_err();
        if opening.iter().filter(|field| is_word(field)).count() * 2 >= count {
            // A second header line may contain units; a malformed number is not a unit.
            let is_unit = |field: &String| {
                is_word(field)
                    && !field.starts_with(|l: char| l.is_ascii_digit() || "+-.".contains(l))
            };
            let units = |(_, text): &(u64, String)| {
                let fields = fields(text);
                fields.len() == count && fields.iter().all(|f| f.is_empty() || is_unit(f))
            };
            if second.as_ref().is_some_and(units) {
                second = lines.next()?.map(owned);
            }
            let rows = second.into_iter().collect();
            return Ok(Self { delimiter, names: Some(opening), count, line, rows });
        }
        // Array libraries write the names in a comment.
        let names = comment.map(|text| fields(&text));
        let names = names.filter(|names| names.len() == count && names.iter().all(is_word));
        let rows = std::iter::once((line, first)).chain(second).collect();
        Ok(Self { delimiter, names, count, line, rows })
    }

    /// The first name in a line of names that is not a comment.
    fn header(&self) -> Option<&str> {
        let above = self.rows.first().is_none_or(|(line, _)| *line > self.line);
        self.names.as_ref().filter(|_| above)?.first().map(String::as_str)
    }

    /// The index, from zero, of the column called `name`.
    fn place(&self, name: &str, path: &Path) -> Result<usize, IoError> {
        let names = self.names.as_deref().unwrap_or_default();
        let by_number = name.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
        let found = match (place(name, names), by_number) {
            (Err(LogProblem::NoColumn { .. }), Some(place)) if place < self.count => Ok(place),
            (Err(LogProblem::NoColumn { column, suggestion, .. }), _) => {
                Err(LogProblem::NoColumn { column, suggestion, present: self.present() })
            }
            (found, _) => found,
        };
        found.map_err(|problem| LogError::at(path, self.line, problem))
    }

    /// A list of the existing columns, for an error message.
    fn present(&self) -> String {
        match &self.names {
            Some(names) => listed(names),
            None => format!("\"1\" to \"{}\", as the log has no header", self.count),
        }
    }
}
