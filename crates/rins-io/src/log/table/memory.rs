//! Columns in memory, in place of a log file.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::columns::{Columns, Wanted, WantedTime, place};
use super::typed::{Numbers, most_rows, stamps, together};
use crate::error::{IoError, LogError};
use crate::input_file::{InputFile, hexadecimal};
use crate::log::problem::LogProblem;

/// A log in memory: named columns of numbers, such as the arrays of another program.
///
/// ```
/// use rins_io::{ColumnNumbers, LogColumns};
/// let mut columns = LogColumns::new("arrays");
/// columns.push("t", ColumnNumbers::Real(vec![0.0, 0.01]));
/// columns.push("gx", ColumnNumbers::Real(vec![15.0, 15.1]));
/// assert_eq!(columns.names().collect::<Vec<_>>(), ["t", "gx"]);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LogColumns {
    /// The name of the log in messages and in the provenance of results.
    pub(crate) path: PathBuf,
    columns: Vec<(String, Numbers)>,
}

impl LogColumns {
    /// A log without columns. `name` stands for the path of a file in messages and in the provenance.
    pub fn new(name: impl Into<PathBuf>) -> Self {
        Self { path: name.into(), columns: Vec::new() }
    }

    /// Appends a column.
    pub fn push(&mut self, name: impl Into<String>, numbers: Numbers) {
        self.columns.push((name.into(), numbers));
    }

    /// The names of the columns, in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// The name, and the SHA-256 of the columns: of each its name, a zero byte, its length as 64-bit integer, and its numbers,
    /// little-endian.
    pub fn digest(&self) -> InputFile {
        let mut digest = Sha256::new();
        let mut portion = Vec::with_capacity(1 << 16);
        for (name, numbers) in &self.columns {
            digest.update(name);
            digest.update([0]);
            digest.update((numbers.len() as u64).to_le_bytes());
            for start in (0..numbers.len()).step_by(1 << 13) {
                let end = numbers.len().min(start + (1 << 13));
                portion.clear();
                match numbers {
                    Numbers::Real(list) => {
                        list[start..end].iter().for_each(|n| portion.extend(n.to_le_bytes()));
                    }
                    Numbers::Whole(list) => {
                        list[start..end].iter().for_each(|n| portion.extend(n.to_le_bytes()));
                    }
                }
                digest.update(&portion);
            }
        }
        InputFile { path: self.path.clone(), sha256: hexadecimal(digest) }
    }
}

/// Takes the requested columns, which are not copied.
pub(in crate::log) fn take(log: LogColumns, wanted: Wanted<'_>) -> Result<Columns, IoError> {
    let LogColumns { path, columns } = log;
    let path: &Path = &path;
    let refuse = |problem| LogError::of(path, problem);
    let (present, lists): (Vec<String>, Vec<Numbers>) = columns.into_iter().unzip();
    let mut lists: Vec<Option<Numbers>> = lists.into_iter().map(Some).collect();
    let Wanted { names, time, .. } = wanted;
    let asked: Vec<&str> =
        names.iter().copied().chain(time.iter().flat_map(WantedTime::names)).collect();
    let mut taken: Vec<Numbers> = Vec::with_capacity(asked.len());
    let mut places = Vec::with_capacity(asked.len());
    for name in &asked {
        let place = place(name, &present).map_err(refuse)?;
        let earlier = places.iter().position(|known| *known == place);
        let list = match (lists[place].take(), earlier) {
            (Some(list), _) => list,
            // A column that is requested twice, for example as time and as sample counter.
            (None, Some(earlier)) => taken[earlier].clone(),
            (None, None) => return Err(refuse(LogProblem::TwoColumns { column: (*name).into() })),
        };
        if let Some(first) = taken.first()
            && first.len() != list.len()
        {
            let (samples, expected) = (list.len(), first.len());
            let other = format!("column {:?}", asked[0]);
            return Err(refuse(LogProblem::UnequalLength { samples, other, expected }));
        }
        places.push(place);
        taken.push(list);
    }
    let (rows, most) = (taken.first().map_or(0, Numbers::len) as u64, most_rows(u64::MAX));
    if rows > most {
        return Err(refuse(LogProblem::ManyRows { most }));
    }
    let stamps = time.map(|time| stamps(path, time, &mut taken)).transpose()?;
    together(path, names, taken.into_iter().map(Numbers::plain).collect(), stamps)
}
