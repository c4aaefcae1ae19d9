//! The first lines of a text log: its preamble, delimiter and column names.

use std::io::BufRead;
use std::path::Path;

use super::columns::{MOST_COLUMNS, listed, place};
use crate::error::{IoError, LogError};
use crate::log::fields::{Delimiter, Fields};
use crate::log::lines::Lines;
use crate::log::problem::LogProblem;
use crate::rig::{Decimal, TextForm};

/// The maximum number of lines of a preamble.
const LONGEST_PREAMBLE: usize = 200;

/// The number of consecutive rows of numbers that end a preamble.
const ROWS: usize = 3;

/// The minimum number of columns of a log with a preamble.
const FEWEST_COLUMNS: usize = 3;

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
    let Head { delimiter, names, rows, .. } =
        Head::read(&mut Lines::open(path)?, TextForm::default())?;
    let fields = |(_, row): &(u64, String)| Fields::of(row, delimiter).map(String::from).collect();
    Ok(LogHead { delimiter, names, rows: rows.iter().take(2).map(fields).collect() })
}

/// A line with its number.
type Line = (u64, String);

fn fields(text: &str, delimiter: Delimiter) -> Vec<String> {
    Fields::of(text, delimiter).map(String::from).collect()
}

/// How the lines are divided into fields and numbers.
#[derive(Clone, Copy, Debug)]
struct Division {
    delimiter: Delimiter,
    decimal: Decimal,
}

impl Division {
    /// Whether a field is not a number.
    fn is_word(self, field: &str) -> bool {
        self.decimal.number(field).is_none()
    }
}

/// What the fields of a line have in common.
#[derive(Clone, Copy, Debug)]
struct Shape {
    /// The number of fields.
    count: usize,
    /// Whether at least half of the fields are not numbers, as in a line of names.
    is_words: bool,
    /// Whether the fields are the units below a line of names; a malformed number is not a unit.
    is_units: bool,
    /// Whether the line ends with a delimiter.
    ends_empty: bool,
}

impl Shape {
    fn of(text: &str, division: Division) -> Self {
        let (mut count, mut words) = (0, 0);
        let (mut is_units, mut ends_empty) = (true, false);
        for field in Fields::of(text, division.delimiter) {
            let is_word = division.is_word(&field);
            let is_malformed = field.starts_with(|l: char| l.is_ascii_digit() || "+-.".contains(l));
            count += 1;
            words += usize::from(is_word);
            ends_empty = field.is_empty();
            is_units &= ends_empty || is_word && !is_malformed;
        }
        Self { count, is_words: words * 2 >= count, is_units, ends_empty }
    }

    /// Whether this is the line of units below `count` names.
    fn is_units_of(self, count: usize) -> bool {
        self.is_units && self.count == count
    }
}

/// The number of lines before the header of a log, or before its first row if it has no header; `None` if the log has no
/// preamble.
///
/// A preamble is the text above the header: the rows have the same number of fields as the header, and the preamble lines do not.
/// Lines that are read are appended to `begun`.
fn preamble<R: BufRead>(
    begun: &mut Vec<Line>,
    (stated, decimal): (Option<Delimiter>, Decimal),
    lines: &mut Lines<R>,
) -> Result<Option<usize>, IoError> {
    let divided = |first: &str, second: &str| {
        let sniffed = || Delimiter::sniff(first, Some(second), decimal);
        Division { delimiter: stated.unwrap_or_else(sniffed), decimal }
    };
    let [(_, first), (_, second)] = &begun[..] else { return Ok(None) };
    let division = divided(first, second);
    let (names, row) = (Shape::of(first, division), Shape::of(second, division));
    let is_below = row.count == names.count || row.ends_empty && row.count == names.count + 1;
    if is_below && !row.is_words {
        return Ok(None);
    }
    while begun.len() < LONGEST_PREAMBLE {
        let Some(line) = lines.next()?.map(|(line, text)| (line, text.to_string())) else {
            return Ok(None);
        };
        begun.push(line);
        let Some(start) = begun.len().checked_sub(ROWS) else { continue };
        let division = divided(&begun[start].1, &begun[start + 1].1);
        let shape = |(_, text): &Line| Shape::of(text, division);
        let rows: Vec<Shape> = begun[start..].iter().map(shape).collect();
        let count = rows[0].count;
        let are_rows = rows.iter().all(|row| row.count == count && !row.is_words);
        if !are_rows || count < FEWEST_COLUMNS {
            continue;
        }
        let above: Vec<Shape> = begun[..start].iter().map(shape).collect();
        // Some loggers end each row, but not the header, with a delimiter.
        let end_empty = rows.iter().all(|row| row.ends_empty);
        let is_header = |place: usize| {
            let names = above[place];
            names.is_words && (names.count == count || end_empty && names.count + 1 == count)
        };
        let is_units = |place: usize| {
            place > 0 && is_header(place - 1) && above[place].is_units_of(above[place - 1].count)
        };
        // The header is the line above the rows, or above the units.
        let header = match start.checked_sub(1) {
            Some(place) if is_units(place) => Some(place - 1),
            Some(place) if is_header(place) => Some(place),
            _ => None,
        };
        // Without a header, all lines above the rows are words, or a row whose beginning was not recorded is the only one.
        let is_cut = || above.len() == 1 && above[0].count < count;
        let is_start = || above.iter().all(|line| line.is_words) || is_cut();
        return Ok(header.or_else(|| is_start().then_some(start)));
    }
    Ok(None)
}

/// The first lines of a text log.
#[derive(Debug)]
pub(crate) struct Head {
    pub(crate) delimiter: Delimiter,
    pub(crate) decimal: Decimal,
    /// The columns' names, if there are any.
    pub(crate) names: Option<Vec<String>>,
    /// The number of columns.
    pub(crate) count: usize,
    /// The line of the names, or the first line of numbers.
    pub(super) line: u64,
    /// The rows of numbers in these lines.
    pub(crate) rows: Vec<(u64, String)>,
    /// The line and the problem of a first row whose beginning is missing.
    pub(crate) cut: Option<(u64, LogProblem)>,
}

impl Head {
    pub(crate) fn read<R: BufRead>(lines: &mut Lines<R>, form: TextForm) -> Result<Self, IoError> {
        let TextForm { decimal, skip } = form;
        lines.skip(skip.unwrap_or_default())?;
        let owned = |(line, text): (u64, &str)| (line, text.to_string());
        let empty = |lines: &Lines<R>| LogError::of(lines.path(), lines.emptiness());
        let mut opening = lines.next()?.map(owned).ok_or_else(|| empty(lines))?;
        let stated = Delimiter::stated(&opening.1);
        if stated.is_some() {
            opening = lines.next()?.map(owned).ok_or_else(|| empty(lines))?;
        }
        let comment = lines.comment().map(str::to_string);
        let mut begun = vec![opening];
        begun.extend(lines.next()?.map(owned));
        let mut before = Vec::new();
        if skip.is_none()
            && let Some(begins) = preamble(&mut begun, (stated, decimal), lines)?
        {
            before.extend(begun.drain(..begins));
        }
        let head = Self::of(begun, (stated, decimal), comment, lines)?;
        let division = Division { delimiter: head.delimiter, decimal };
        let cut = match &before[..] {
            [(line, text)] if head.names.is_none() && !Shape::of(text, division).is_words => {
                let got = Shape::of(text, division).count;
                Some((*line, LogProblem::FieldCount { got, expected: head.count }))
            }
            _ => None,
        };
        Ok(Self { cut, ..head })
    }

    /// The head of a log that begins with these lines, without a preamble.
    fn of<R: BufRead>(
        begun: Vec<Line>,
        (stated, decimal): (Option<Delimiter>, Decimal),
        comment: Option<String>,
        lines: &mut Lines<R>,
    ) -> Result<Self, IoError> {
        let mut begun = begun.into_iter();
        let (line, first) = begun.next().expect("the first line is there");
        let mut rest: Vec<Line> = begun.collect();
        let second = rest.first().map(|(_, text)| &text[..]);
        let delimiter = stated.unwrap_or_else(|| Delimiter::sniff(&first, second, decimal));
        let division = Division { delimiter, decimal };
        let fields = |text: &str| fields(text, delimiter);
        let opening = fields(&first);
        let count = opening.len();
        if count > MOST_COLUMNS {
            let problem = LogProblem::ManyColumns { most: MOST_COLUMNS };
            return Err(LogError::at(lines.path(), line, problem));
        }
        if Shape::of(&first, division).is_words {
            let is_units = |(_, text): &Line| Shape::of(text, division).is_units_of(count);
            if rest.first().is_some_and(is_units) {
                rest.remove(0);
                if rest.is_empty() {
                    rest.extend(lines.next()?.map(|(line, text)| (line, text.to_string())));
                }
            }
            return Ok(Self {
                delimiter,
                decimal,
                names: Some(opening),
                count,
                line,
                rows: rest,
                cut: None,
            });
        }
        // Array libraries write the names in a comment.
        let names = comment.map(|text| fields(&text));
        let names = names.filter(|names| {
            names.len() == count && names.iter().all(|name| division.is_word(name))
        });
        rest.insert(0, (line, first));
        Ok(Self { delimiter, decimal, names, count, line, rows: rest, cut: None })
    }

    /// The first name in a line of names that is not a comment.
    pub(super) fn header(&self) -> Option<&str> {
        let above = self.rows.first().is_none_or(|(line, _)| *line > self.line);
        self.names.as_ref().filter(|_| above)?.first().map(String::as_str)
    }

    /// The index, from zero, of the column called `name`.
    pub(super) fn place(&self, name: &str, path: &Path) -> Result<usize, IoError> {
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
