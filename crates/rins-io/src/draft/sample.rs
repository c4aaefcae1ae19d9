//! A few rows of a log: its first, and some from places all through it.

use std::io::{BufReader, Seek, SeekFrom};
use std::path::Path;

use crate::error::{IoError, LogError};
use crate::log::{Delimiter, Fields, Head, Lines, LogProblem, all_columns, nanoseconds};
use crate::source;

/// The rows of a run.
const RUN: usize = 128;

/// The runs from the beginning of a log.
const FIRST_RUNS: usize = 8;

/// The runs from places all through the rest of it.
const OTHER_RUNS: u64 = 8;

/// What a log's header and some of its rows say.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sample {
    /// The format of its file, as a rig file names it.
    pub(super) format: &'static str,
    pub(super) delimiter: Delimiter,
    /// The columns' names, where there are any.
    pub(super) names: Option<Vec<String>>,
    /// The number of columns.
    pub(super) count: usize,
    /// Runs of rows that follow each other.
    pub(super) runs: Vec<Run>,
    /// Whether these are all rows of the log.
    pub(super) whole: bool,
}

/// Rows that follow each other: the numbers of each column, not a number where there is none.
pub(super) type Run = Vec<Vec<f64>>;

impl Sample {
    /// Looks at the log at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Log`] if its first rows are no columns of
    /// numbers.
    pub(super) fn read(path: &Path) -> Result<Self, IoError> {
        if let Some((format, names, numbers)) = all_columns(path)? {
            return Ok(Self::of_columns(format, names, &numbers));
        }
        let mut lines = Lines::open(path)?;
        let head = Head::read(&mut lines)?;
        let mut first = Rows::new(&head);
        for (line, text) in &head.rows {
            first.push(text).map_err(|problem| LogError::at(path, *line, problem))?;
            first.note_text(*line, text);
        }
        let mut whole = false;
        while first.length < RUN * FIRST_RUNS {
            let Some((line, text)) = lines.next()? else {
                whole = true;
                break;
            };
            first.push(text).map_err(|problem| LogError::at(path, line, problem))?;
        }
        if first.length == 0 {
            return Err(LogError::of(path, LogProblem::OnlyHeader));
        }
        first.refuse_text(path, head.names.as_deref())?;
        let mut runs = first.runs();
        if !whole {
            runs.extend(others(path, &head));
        }
        let Head { delimiter, names, count, .. } = head;
        Ok(Self { format: "csv", delimiter, names, count, runs, whole })
    }

    /// Of the columns of a binary file.
    fn of_columns(format: &'static str, names: Vec<String>, numbers: &[Vec<f64>]) -> Self {
        let rows = numbers.first().map_or(0, Vec::len);
        let run = |start: usize| -> Run {
            let end = (start + RUN).min(rows);
            numbers.iter().map(|column| column[start..end].to_vec()).collect()
        };
        let first = (0..rows.min(RUN * FIRST_RUNS)).step_by(RUN);
        let places = usize::try_from(OTHER_RUNS).unwrap_or_default();
        let others = (1..=places).map(|index| rows / (places + 1) * index);
        let whole = rows <= RUN * FIRST_RUNS;
        let others = others.filter(|start| !whole && *start >= RUN * FIRST_RUNS);
        let runs = first.chain(others).map(run).collect();
        let (delimiter, count) = (Delimiter::Comma, names.len());
        Self { format, delimiter, names: Some(names), count, runs, whole }
    }

    /// What to call a column in a rig file: by its name or, where that is not its own, by its
    /// place.
    pub(super) fn name(&self, column: usize) -> String {
        let names = self.names.as_deref().unwrap_or_default();
        match names.get(column) {
            Some(name) if names.iter().filter(|other| *other == name).count() == 1 => name.clone(),
            _ => (column + 1).to_string(),
        }
    }

    /// Whether the column holds numbers.
    pub(super) fn is_numeric(&self, column: usize) -> bool {
        self.runs.iter().any(|run| run[column].iter().any(|number| number.is_finite()))
    }

    /// How many rows there are.
    pub(super) fn rows(&self) -> usize {
        self.runs.iter().map(|run| run.first().map_or(0, Vec::len)).sum()
    }
}

/// Runs from places all through the log; fewer where it cannot be read there.
fn others(path: &Path, head: &Head) -> Vec<Run> {
    let length = source::length(path).unwrap_or_default();
    let places = (1..=OTHER_RUNS).map(|index| length / (OTHER_RUNS + 1) * index);
    places.filter_map(|place| run_at(path, head, place)).collect()
}

fn run_at(path: &Path, head: &Head, place: u64) -> Option<Run> {
    let mut file = source::open(path).ok()?;
    file.seek(SeekFrom::Start(place)).ok()?;
    let mut lines = Lines::new(BufReader::new(file), path);
    // The first line is most likely the end of one.
    lines.next().ok()??;
    let mut rows = Rows::new(head);
    while rows.length < RUN {
        // Reading the whole log names the line that is wrong; a draft makes do with the rest.
        let Ok(Some((_, text))) = lines.next() else { break };
        if rows.push(text).is_err() {
            break;
        }
    }
    (rows.length > 1).then_some(rows.columns)
}

/// The number in a field; the seconds since 1970 of a date with a time of day.
fn number(field: &str) -> Option<f64> {
    match field.parse::<f64>() {
        Ok(number) => Some(number).filter(|number| number.is_finite()),
        Err(_) => nanoseconds(field).map(|instant| instant as f64 * 1e-9),
    }
}

/// Rows that are being read.
struct Rows {
    delimiter: Delimiter,
    columns: Run,
    length: usize,
    /// What stands in place of a number in the first rows.
    texts: Vec<Option<(u64, String)>>,
}

impl Rows {
    fn new(head: &Head) -> Self {
        Self {
            delimiter: head.delimiter,
            columns: vec![Vec::new(); head.count],
            length: 0,
            texts: vec![None; head.count],
        }
    }

    /// Adds a row, unless it has another number of fields than the first line.
    fn push(&mut self, text: &str) -> Result<(), LogProblem> {
        let expected = self.columns.len();
        let fields: Vec<_> = Fields::of(text, self.delimiter).take(expected + 2).collect();
        let trailing =
            fields.len() == expected + 1 && fields.last().is_some_and(|last| last.is_empty());
        if fields.len() != expected && !trailing {
            let got = Fields::of(text, self.delimiter).count();
            return Err(LogProblem::FieldCount { got, expected });
        }
        for (column, field) in self.columns.iter_mut().zip(fields) {
            column.push(number(&field).unwrap_or(f64::NAN));
        }
        self.length += 1;
        Ok(())
    }

    fn note_text(&mut self, line: u64, row: &str) {
        for (text, field) in self.texts.iter_mut().zip(Fields::of(row, self.delimiter)) {
            if text.is_none() && !field.is_empty() && number(&field).is_none() {
                *text = Some((line, field.chars().take(40).collect()));
            }
        }
    }

    /// Refuses a column of numbers that begins with a text, most likely that of a second header,
    /// and a log that has no column of numbers.
    fn refuse_text(&self, path: &Path, names: Option<&[String]>) -> Result<(), IoError> {
        let has_numbers = |column: &Vec<f64>| column.iter().any(|number| !number.is_nan());
        let hopeless = !self.columns.iter().any(has_numbers);
        for (index, (text, column)) in self.texts.iter().zip(&self.columns).enumerate() {
            let Some((line, text)) = text else { continue };
            if hopeless || has_numbers(column) {
                let column = names.and_then(|names| names.get(index).cloned());
                let column = column.unwrap_or_else(|| (index + 1).to_string());
                let problem = LogProblem::NotANumber { column, text: text.clone() };
                return Err(LogError::at(path, *line, problem));
            }
        }
        Ok(())
    }

    fn runs(&self) -> Vec<Run> {
        let part = |start: usize| -> Run {
            let end = (start + RUN).min(self.length);
            self.columns.iter().map(|column| column[start..end].to_vec()).collect()
        };
        (0..self.length).step_by(RUN).map(part).collect()
    }
}
