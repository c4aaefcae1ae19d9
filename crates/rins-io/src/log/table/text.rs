//! Columns of text, whose delimiter is determined automatically.

use std::io::BufRead;
use std::path::Path;

use super::columns::{Columns, MOST_ROWS, Repeated, Wanted};
use super::head::Head;
use crate::error::{IoError, LogError};
use crate::log::fields::Fields;
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
    let Wanted { names, mut time, rows } = wanted;
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
    let filter = match rows {
        Some(rows) => Some((head.place(&rows.column, lines.path())?, rows.value.as_str())),
        None => None,
    };

    let mut columns = Columns { numbers: vec![Vec::new(); names.len()], ..Columns::default() };
    let path = lines.path().to_path_buf();
    let mut before = String::new();
    let mut repeated = Repeated::default();
    let mut row = |number: u64, line: &str| -> Result<(), IoError> {
        if let Some((place, value)) = filter
            && Fields::of(line, head.delimiter).nth(place).is_none_or(|field| field != value)
        {
            return Ok(());
        }
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
        let problem = rows.map_or(LogProblem::OnlyHeader, |rows| LogProblem::NoSuchRows {
            column: rows.column.clone(),
            value: rows.value.clone(),
        });
        return Err(LogError::of(lines.path(), problem));
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
