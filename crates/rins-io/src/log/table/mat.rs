//! Columns of the matrices in MATLAB level 5 files, which `save` writes with `-v6` and `-v7`.
//!
//! ‹matfile5›. A column is named as in MATLAB: `imu(:,3)`, `imu.wb(:,1)` in a structure, or `t` for a
//! vector.

mod element;

use std::io::{BufReader, Read};
use std::path::Path;

use flate2::read::ZlibDecoder;

use self::element::{Elements, Matrix};
use super::columns::{Columns, MOST_COLUMNS, Wanted, WantedTime, place};
use super::typed::{Numbers, most_rows, stamps, together};
use crate::error::{IoError, LogError};
use crate::log::problem::LogProblem;
use crate::source;

const FORMAT: &str = "MATLAB level 5";

/// The maximum depth of nested structures.
const DEEPEST: usize = 4;

/// The maximum number of variables and fields that are examined.
const MOST_VARIABLES: usize = 4096;

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Reads columns of the matrices in the file at `path`.
pub(super) fn read(path: &Path, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let Wanted { names, time, .. } = wanted;
    let asked: Vec<&str> =
        names.iter().copied().chain(time.iter().flat_map(WantedTime::names)).collect();
    let mut found = found(path, &asked)?;
    let mut lists = found.lists(&asked).map_err(|problem| LogError::of(path, problem))?;
    let stamps = time.map(|time| stamps(path, time, &mut lists)).transpose()?;
    together(path, names, lists.into_iter().map(Numbers::plain).collect(), stamps)
}

/// The names of the columns of the matrices in the file at `path` that are as long as the longest.
pub(super) fn names(path: &Path) -> Result<Vec<String>, IoError> {
    let found = found(path, &[])?;
    let most = found.present.iter().map(|(_, rows)| *rows).max().unwrap_or_default();
    let longest = found.present.into_iter().filter(|(_, rows)| *rows == most);
    Ok(longest.map(|(name, _)| name).collect())
}

/// What a file holds of the columns that are asked for.
fn found(path: &Path, asked: &[&str]) -> Result<Found, IoError> {
    let failed = || IoError::file("read", path);
    let file = source::open(path).map_err(failed())?;
    let length = source::length(path).map_err(failed())?;
    if length == 0 {
        return Err(LogError::of(path, LogProblem::Empty));
    }
    let mut found = Found::new(asked, most_rows(length));
    let mut reader = BufReader::with_capacity(1 << 16, file);
    found.read(&mut reader).map_err(|problem| match problem {
        Problem::System(source) if source.kind() != std::io::ErrorKind::UnexpectedEof => {
            // Damaged compressed bytes are not a system error.
            match source.kind() {
                std::io::ErrorKind::InvalidData | std::io::ErrorKind::InvalidInput => {
                    LogError::of(path, damaged(&source.to_string()))
                }
                _ => failed()(source),
            }
        }
        Problem::System(_) => LogError::of(path, damaged("it ends too early")),
        Problem::Log(problem) => LogError::of(path, problem),
    })?;
    Ok(found)
}

fn damaged(message: &str) -> LogProblem {
    LogProblem::Damaged { format: FORMAT, message: message.into() }
}

/// The reason why a file was not read to its end.
enum Problem {
    System(std::io::Error),
    Log(LogProblem),
}

impl From<std::io::Error> for Problem {
    fn from(error: std::io::Error) -> Self {
        Self::System(error)
    }
}

/// The data of the requested columns found so far.
struct Found {
    /// The variable and column of each; `None` as column if a vector is requested.
    asked: Vec<(String, Option<usize>)>,
    lists: Vec<Option<Numbers>>,
    /// The existing columns, and their lengths.
    present: Vec<(String, u64)>,
    most: u64,
}

impl Found {
    fn new(asked: &[&str], most: u64) -> Self {
        let asked: Vec<_> = asked.iter().map(|name| parsed(name)).collect();
        let lists = vec![None; asked.len()];
        Self { asked, lists, present: Vec::new(), most }
    }

    fn read(&mut self, reader: &mut dyn Read) -> Result<(), Problem> {
        let mut header = [0; 128];
        reader.read_exact(&mut header)?;
        let big = match (&header[126..], header[124], header[125]) {
            (b"IM", 0, 1) => false,
            (b"MI", 1, 0) => true,
            (b"IM", 0, 2) | (b"MI", 2, 0) => {
                return Err(Problem::Log(damaged(
                    "it is of version 7.3, which is HDF5; save it with -v7",
                )));
            }
            _ => return Err(Problem::Log(damaged("its header is not one of MATLAB's"))),
        };
        let mut elements = Elements::new(reader, big);
        let mut variables = 0;
        while let Some(tag) = elements.tag()? {
            variables += 1;
            if variables > MOST_VARIABLES {
                return Err(Problem::Log(damaged("more variables than any log has")));
            }
            match tag.kind {
                MATRIX => self.matrix(&mut elements, tag.length, "", 0)?,
                COMPRESSED => {
                    let mut limited = elements.limited(tag.length);
                    let mut inflated = ZlibDecoder::new(&mut limited);
                    let mut inner = Elements::new(&mut inflated, big);
                    match inner.tag()? {
                        Some(tag) if tag.kind == MATRIX => {
                            self.matrix(&mut inner, tag.length, "", 0)?;
                        }
                        _ => {}
                    }
                    // The remainder, a checksum or two, is skipped.
                    std::io::copy(&mut limited, &mut std::io::sink())?;
                    if limited.limit() > 0 {
                        return Err(std::io::Error::from(std::io::ErrorKind::UnexpectedEof).into());
                    }
                }
                _ => elements.skip(tag.length)?,
            }
        }
        Ok(())
    }

    /// Examines a matrix `outer.name`, whose tag has been read.
    fn matrix(
        &mut self,
        elements: &mut Elements<'_>,
        length: u64,
        outer: &str,
        depth: usize,
    ) -> Result<(), Problem> {
        let end = elements.position().saturating_add(length);
        if length == 0 {
            return Ok(());
        }
        let matrix = Matrix::read(elements)?;
        let name = match (outer, matrix.name.as_str()) {
            ("", name) => name.to_string(),
            (outer, "") => outer.to_string(),
            (outer, name) => format!("{outer}.{name}"),
        };
        if self.present.len() > MOST_VARIABLES {
            return Err(Problem::Log(damaged("more columns than any log has")));
        }
        if matrix.is_numeric() && matrix.dimensions.len() == 2 {
            self.numbers(elements, &matrix, &name)?;
        } else if matrix.is_one_structure() && depth < DEEPEST {
            for field in Matrix::fields(elements)? {
                let Some(tag) = elements.tag()?.filter(|tag| tag.kind == MATRIX) else {
                    return Err(Problem::Log(damaged("a field is not an array")));
                };
                let inside = elements.position().saturating_add(tag.length) <= end;
                if !inside {
                    return Err(Problem::Log(damaged("a field is longer than its structure")));
                }
                self.matrix(elements, tag.length, &format!("{name}.{field}"), depth + 1)?;
            }
        }
        match end.checked_sub(elements.position()) {
            Some(rest) => Ok(elements.skip(rest)?),
            None => Err(Problem::Log(damaged("an array is longer than its element"))),
        }
    }

    /// Reads the requested columns of a matrix.
    fn numbers(
        &mut self,
        elements: &mut Elements<'_>,
        matrix: &Matrix,
        name: &str,
    ) -> Result<(), Problem> {
        let (mut rows, mut columns) = (matrix.dimensions[0], matrix.dimensions[1]);
        let vector = rows == 1 || columns == 1;
        if vector {
            (rows, columns) = (rows.max(columns), 1);
            self.present.push((name.to_string(), rows));
        } else {
            let named = (1..=columns.min(64)).map(|column| (format!("{name}(:,{column})"), rows));
            self.present.extend(named);
        }
        let wanted: Vec<(usize, u64)> = self
            .asked
            .iter()
            .enumerate()
            .filter(|(_, (variable, _))| variable == name)
            .filter_map(|(place, (_, column))| match column {
                None => vector.then_some((place, 0)),
                Some(column) => Some((place, *column as u64)).filter(|(_, c)| *c < columns),
            })
            .collect();
        if wanted.is_empty() {
            return Ok(());
        }
        if rows > self.most {
            return Err(Problem::Log(LogProblem::ManyRows { most: self.most }));
        }
        if columns > MOST_COLUMNS as u64 {
            return Err(Problem::Log(LogProblem::ManyColumns { most: MOST_COLUMNS }));
        }
        if matrix.is_complex {
            return Err(Problem::Log(damaged("a column has complex numbers")));
        }
        let data = elements.data(rows, columns)?.ok_or_else(|| {
            Problem::Log(damaged(&format!(
                "{name} has a number of values that differs from its size"
            )))
        })?;
        for column in 0..columns {
            let asked: Vec<usize> =
                wanted.iter().filter(|(_, c)| *c == column).map(|(place, _)| *place).collect();
            if asked.is_empty() {
                elements.skip(rows * data.size)?;
                continue;
            }
            let list = elements.column(&data, rows)?;
            for place in asked {
                self.lists[place] = Some(list.clone());
            }
        }
        Ok(())
    }

    fn lists(&mut self, asked: &[&str]) -> Result<Vec<Numbers>, LogProblem> {
        let mut lists: Vec<Numbers> = Vec::with_capacity(asked.len());
        for (name, list) in asked.iter().zip(&mut self.lists) {
            let Some(list) = list.take() else {
                let present: Vec<String> =
                    self.present.iter().map(|(name, _)| name.clone()).collect();
                let missing = place(name, &present).err();
                return Err(missing.unwrap_or_else(|| damaged("a variable occurs twice")));
            };
            if let Some(first) = lists.first()
                && first.len() != list.len()
            {
                let other = asked[0].into();
                let (samples, expected) = (list.len(), first.len());
                return Err(LogProblem::UnequalLength { samples, other, expected });
            }
            lists.push(list);
        }
        Ok(lists)
    }
}

/// A variable, and the column that `(:,n)` selects.
fn parsed(name: &str) -> (String, Option<usize>) {
    let inside = name.strip_suffix(')').and_then(|rest| rest.split_once("(:,"));
    if let Some((variable, column)) = inside
        && let Some(column) = column.trim().parse::<usize>().ok().and_then(|n| n.checked_sub(1))
    {
        return (variable.to_string(), Some(column));
    }
    (name.to_string(), None)
}
