//! A sample of the rows of a log: the first ones, and others from positions distributed over it.

use std::collections::BTreeSet;
use std::io::{BufReader, Seek, SeekFrom};
use std::path::Path;

use crate::error::{IoError, LogError};
use crate::log::{
    BinaryColumns, Damage, Delimiter, Fields, Head, Lines, LogProblem, all_columns, day,
    nanoseconds, time_of_day,
};
use crate::rig::{Decimal, TextForm};
use crate::source;

/// The most kinds of rows that a column distinguishes.
const MOST_KINDS: usize = 8;

/// The longest text of a kind.
const LONGEST_KIND: usize = 40;

/// The number of rows in a run.
const RUN: usize = 128;

/// The number of runs at the beginning of a log.
const FIRST_RUNS: usize = 8;

/// The number of rows in these.
const FIRST_ROWS: u64 = 1024;

/// The number of runs from positions distributed over the rest of it.
const OTHER_RUNS: u64 = 8;

/// The header of a log and some of its rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sample {
    /// The format of its file, as a rig file names it.
    pub(super) format: &'static str,
    pub(super) delimiter: Delimiter,
    pub(super) decimal: Decimal,
    /// The columns' names, if there are any.
    pub(super) names: Option<Vec<String>>,
    /// The number of columns.
    pub(super) count: usize,
    /// The columns that distinguish rows of several kinds, and their texts.
    pub(super) kinds: Vec<(usize, Vec<String>)>,
    /// What the first row has in each column, if it is a part of a time in text.
    pub(super) clocks: Vec<Option<ClockText>>,
    /// Runs of consecutive rows.
    pub(super) runs: Vec<Run>,
    /// Whether these are all rows of the log.
    pub(super) whole: bool,
}

/// A part of a time in text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClockText {
    Date,
    TimeOfDay,
}

impl ClockText {
    fn of(field: &str) -> Option<Self> {
        match (day(field), time_of_day(field)) {
            (Some(_), _) => Some(Self::Date),
            (None, Some(_)) => Some(Self::TimeOfDay),
            (None, None) => None,
        }
    }
}

/// Consecutive rows: the numbers of each column, NaN where a field is not a number.
pub(super) type Run = Vec<Vec<f64>>;

impl Sample {
    /// Reads a sample of the log at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Log`] if its first rows are not columns of numbers.
    pub(super) fn read(path: &Path) -> Result<Self, IoError> {
        let form = TextForm { decimal: decimal(path)?, skip: None };
        let mut lines = Lines::open(path)?;
        let head = Head::read(&mut lines, form)?;
        let mut first = Rows::new(&head);
        let mut damage = Damage::default();
        let refused = |(line, problem)| LogError::at(path, line, problem);
        if let Some((line, problem)) = head.cut.clone() {
            damage.note(line, problem, FIRST_ROWS).map_err(refused)?;
        }
        for (line, text) in &head.rows {
            match first.push(text) {
                Ok(()) => first.note_text(*line, text),
                Err(problem) => damage.note(*line, problem, FIRST_ROWS).map_err(refused)?,
            }
        }
        let mut whole = false;
        while first.length < RUN * FIRST_RUNS {
            let (line, pushed) = match lines.next() {
                Ok(Some((line, text))) => (line, first.push(text)),
                Ok(None) => {
                    whole = true;
                    break;
                }
                Err(IoError::Log(error)) if error.problem == LogProblem::NotText => {
                    (error.line.unwrap_or_default(), Err(error.problem))
                }
                Err(error) => return Err(error),
            };
            if let Err(problem) = pushed {
                damage.note(line, problem, FIRST_ROWS).map_err(refused)?;
            }
        }
        damage.judge(first.length).map_err(refused)?;
        if first.length == 0 {
            return Err(LogError::of(path, LogProblem::OnlyHeader));
        }
        first.refuse_text(path, head.names.as_deref())?;
        let mut runs = first.runs();
        if !whole {
            runs.extend(others(path, &head));
        }
        let Head { delimiter, decimal, names, count, .. } = head;
        let (kinds, clocks) = (first.kinds(), first.clocks);
        Ok(Self { format: "csv", delimiter, decimal, names, count, kinds, clocks, runs, whole })
    }

    /// Reads a sample of a Parquet or MATLAB file; none of a file of another format.
    ///
    /// # Errors
    /// [`IoError`] if it cannot be read.
    pub(super) fn of_binary(path: &Path) -> Result<Option<Self>, IoError> {
        let all = all_columns(path)?;
        Ok(all.map(Self::of_columns))
    }

    fn of_columns(BinaryColumns { format, names, numbers }: BinaryColumns) -> Self {
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
        let (kinds, clocks) = (Vec::new(), vec![None; count]);
        let names = Some(names);
        Self {
            format,
            delimiter,
            decimal: Decimal::Point,
            names,
            count,
            kinds,
            clocks,
            runs,
            whole,
        }
    }

    /// The name of a column in a rig file: its own name or, if that is not unique, its number.
    pub(super) fn name(&self, column: usize) -> String {
        let names = self.names.as_deref().unwrap_or_default();
        match names.get(column) {
            Some(name) if names.iter().filter(|other| *other == name).count() == 1 => name.clone(),
            _ => (column + 1).to_string(),
        }
    }

    /// Whether the column holds numbers.
    pub(super) fn is_numeric(&self, column: usize) -> bool {
        self.clocks[column].is_none()
            && self.runs.iter().any(|run| run[column].iter().any(|number| number.is_finite()))
    }

    /// Whether the column's numbers differ.
    pub(super) fn varies(&self, column: usize) -> bool {
        let mut numbers = self.runs.iter().flat_map(|run| run[column].iter());
        let first = numbers.next();
        numbers.any(|number| Some(number) != first)
    }

    /// Whether all numbers of a triad are whole: they may be counts of any scale.
    pub(super) fn is_whole(&self, triad: [usize; 3]) -> bool {
        let whole = |number: &f64| number.fract() == 0.0 || number.is_nan();
        self.runs.iter().all(|run| triad.iter().all(|&column| run[column].iter().all(whole)))
    }

    /// The number of rows.
    pub(super) fn rows(&self) -> usize {
        self.runs.iter().map(|run| run.first().map_or(0, Vec::len)).sum()
    }
}

/// The decimal mark of the text log at `path`: a comma if with it more fields of the first rows are numbers, and none of them has
/// a point.
fn decimal(path: &Path) -> Result<Decimal, IoError> {
    let numbers = |decimal: Decimal| -> Result<(usize, bool), IoError> {
        let mut lines = Lines::open(path)?;
        let head = Head::read(&mut lines, TextForm { decimal, skip: None })?;
        let mut rows: Vec<String> = head.rows.iter().map(|(_, row)| row.clone()).collect();
        while rows.len() < RUN
            && let Some((_, row)) = lines.next()?
        {
            rows.push(row.to_string());
        }
        let (mut count, mut has_point) = (0, false);
        for field in rows.iter().flat_map(|row| Fields::of(row, head.delimiter)) {
            count += usize::from(decimal.number(&field).is_some());
            has_point |= Decimal::Point.number(&field).is_some() && field.contains('.');
        }
        Ok((count, has_point))
    };
    let (points, _) = numbers(Decimal::Point)?;
    let (commas, has_point) = numbers(Decimal::Comma)?;
    Ok(if commas > points && !has_point { Decimal::Comma } else { Decimal::Point })
}

/// Runs from positions distributed over the log; fewer if it cannot be read there.
fn others(path: &Path, head: &Head) -> Vec<Run> {
    let length = source::length(path).unwrap_or_default();
    let places = (1..=OTHER_RUNS).map(|index| length / (OTHER_RUNS + 1) * index);
    places.filter_map(|place| run_at(path, head, place)).collect()
}

fn run_at(path: &Path, head: &Head, place: u64) -> Option<Run> {
    let mut file = source::open(path).ok()?;
    file.seek(SeekFrom::Start(place)).ok()?;
    let mut lines = Lines::new(BufReader::new(file), path);
    // The first line is probably only the end of one.
    lines.next().ok()??;
    let mut rows = Rows::new(head);
    while rows.length < RUN {
        // Reading the whole log reports the invalid line; a draft uses the remaining rows.
        let Ok(Some((_, text))) = lines.next() else { break };
        if rows.push(text).is_err() {
            break;
        }
    }
    (rows.length > 1).then_some(rows.columns)
}

/// The number in a field; the seconds since 1970 of a date, with or without a time of day; the seconds of a time of day.
fn number(field: &str, decimal: Decimal) -> Option<f64> {
    if let Some(number) = decimal.number(field) {
        return Some(number).filter(|number| number.is_finite());
    }
    let instant = nanoseconds(field).or_else(|| time_of_day(field));
    let start = || day(field).map(|start| start as f64);
    instant.map(|instant| instant as f64 * 1e-9).or_else(start)
}

/// The rows while they are read.
struct Rows {
    delimiter: Delimiter,
    decimal: Decimal,
    columns: Run,
    length: usize,
    /// The parts of times in text in the first row.
    clocks: Vec<Option<ClockText>>,
    /// Texts in the first rows where numbers are expected.
    texts: Vec<Option<(u64, String)>>,
    /// The different texts of each column, at most one more than [`MOST_KINDS`].
    different: Vec<BTreeSet<String>>,
}

impl Rows {
    fn new(head: &Head) -> Self {
        Self {
            delimiter: head.delimiter,
            decimal: head.decimal,
            columns: vec![Vec::new(); head.count],
            different: vec![BTreeSet::new(); head.count],
            length: 0,
            clocks: vec![None; head.count],
            texts: vec![None; head.count],
        }
    }

    /// Adds a row, unless its number of fields differs from that of the first line.
    fn push(&mut self, text: &str) -> Result<(), LogProblem> {
        let expected = self.columns.len();
        let fields: Vec<_> = Fields::of(text, self.delimiter).take(expected + 2).collect();
        let trailing =
            fields.len() == expected + 1 && fields.last().is_some_and(|last| last.is_empty());
        if fields.len() != expected && !trailing {
            let got = Fields::of(text, self.delimiter).count();
            return Err(LogProblem::FieldCount { got, expected });
        }
        if self.length == 0 {
            let clocks = self.clocks.iter_mut().zip(&fields);
            clocks.for_each(|(clock, field)| *clock = ClockText::of(field));
        }
        let columns = self.columns.iter_mut().zip(&mut self.different);
        for ((column, different), field) in columns.zip(fields) {
            let number = number(&field, self.decimal);
            if number.is_none() && different.len() <= MOST_KINDS && !different.contains(&*field) {
                different.insert(field.chars().take(LONGEST_KIND).collect());
            }
            column.push(number.unwrap_or(f64::NAN));
        }
        self.length += 1;
        Ok(())
    }

    /// The columns of texts, at least two different ones, and their texts.
    fn kinds(&self) -> Vec<(usize, Vec<String>)> {
        let columns = self.different.iter().zip(&self.columns).enumerate();
        let of_texts = columns.filter(|(_, (different, numbers))| {
            (2..=MOST_KINDS).contains(&different.len()) && numbers.iter().all(|n| n.is_nan())
        });
        of_texts
            .map(|(place, (different, _))| (place, different.iter().cloned().collect()))
            .collect()
    }

    fn note_text(&mut self, line: u64, row: &str) {
        for (text, field) in self.texts.iter_mut().zip(Fields::of(row, self.delimiter)) {
            if text.is_none() && !field.is_empty() && number(&field, self.decimal).is_none() {
                *text = Some((line, field.chars().take(40).collect()));
            }
        }
    }

    /// Refuses a column of numbers that begins with a text, probably from a second header,
    /// and a log without any column of numbers.
    fn refuse_text(&self, path: &Path, names: Option<&[String]>) -> Result<(), IoError> {
        let has_numbers = |column: &Vec<f64>| column.iter().any(|number| !number.is_nan());
        let hopeless = !self.columns.iter().any(has_numbers);
        for (index, (text, column)) in self.texts.iter().zip(&self.columns).enumerate() {
            let Some((line, text)) = text else { continue };
            let has_comma = text.contains(',') && Decimal::Comma.number(text).is_some();
            if hopeless || has_numbers(column) || has_comma {
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
