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

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;
    use std::path::Path;

    use super::*;
    use crate::log::{LogPolicy, read_columns, read_log};
    use crate::rig::Rig;

    const RIG: &str = r#"
[site]
latitude = "34.25 deg"
height = "0 m"
[log]
path = "log.csv"
time = { column = "t", unit = "ms" }
gyro = { columns = ["gx", "gy", "gz"], unit = "deg/s", axes = ["-y", "x", "z"] }
accel = { columns = ["ax", "ay", "az"], unit = "g" }
table_angle = { column = "angle", unit = "deg" }
"#;

    const NAMES: [&str; 8] = ["t", "gx", "gy", "gz", "ax", "ay", "az", "angle"];

    /// Rows with an angle that wraps and a row that is damaged.
    fn rows() -> Vec<[f64; 8]> {
        let row = |k: u32| {
            let t = f64::from(k);
            let damaged = if k == 77 { f64::NAN } else { 10.0 + 1e-3 * t };
            let angle = (0.7 * t).rem_euclid(360.0);
            [10.0 * t, 0.01 * t, -1e-3 * t, damaged, 1e-4 * t, 0.02, 1.0 + 1e-5 * t, angle]
        };
        (1..=600).map(row).collect()
    }

    fn columns(rows: &[[f64; 8]]) -> LogColumns {
        let mut columns = LogColumns::new("log.csv");
        for (place, name) in NAMES.iter().enumerate() {
            columns.push(*name, Numbers::Real(rows.iter().map(|row| row[place]).collect()));
        }
        columns
    }

    #[test]
    fn columns_in_memory_are_read_as_those_of_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rig.toml");
        let mut text = NAMES.join(",") + "\n";
        for row in rows() {
            let fields = row.map(|number| number.to_string());
            writeln!(text, "{}", fields.join(",")).unwrap();
        }
        std::fs::write(folder.path().join("log.csv"), text).unwrap();
        let of_file = read_log(Rig::parse(RIG, &path).unwrap(), LogPolicy::default()).unwrap();
        let rig = Rig::parse(RIG, &path).unwrap();
        let ours = read_columns(rig, columns(&rows()), LogPolicy::default()).unwrap();
        assert_eq!(ours.recording, of_file.recording);
        assert_eq!(ours.recording.len(), 599, "one row is damaged");
        assert_eq!(ours.summary.left_out.len(), 1);
    }

    #[test]
    fn errors_of_columns_name_the_row_and_the_column() {
        let refused = |rig: &str, columns| {
            let rig = Rig::parse(rig, Path::new("rig.toml")).unwrap();
            read_columns(rig, columns, LogPolicy::default()).unwrap_err()
        };
        let mut none = LogColumns::new("arrays");
        none.push("t", Numbers::Whole(vec![1, 2, 3]));
        let error = refused(RIG, none);
        assert_eq!((error.key(), error.path()), (Some("gx"), Path::new("arrays")));
        let mut rows = rows();
        rows.iter_mut().skip(20).take(50).for_each(|row| row[5] = f64::INFINITY);
        let error = refused(RIG, columns(&rows));
        assert_eq!((error.key(), error.line()), (Some("ay"), Some(21)));
        let psins = "[site]\nlatitude = \"45 deg\"\nheight = \"0 m\"\n[log]\npath = \"log.imu\"\nformat = \"psins\"\n";
        assert_eq!(refused(psins, LogColumns::new("arrays")).key(), Some("[log] format"));
    }

    #[test]
    fn digest_depends_on_names_and_numbers() {
        let digest = |name: &str, last: f64| {
            let mut columns = LogColumns::new("arrays");
            columns.push(name, Numbers::Real(vec![0.0, last]));
            columns.digest().sha256
        };
        // sha256(b"t\0" + (2).to_bytes(8, "little") + struct.pack("<2d", 0, 1)), by Python's hashlib.
        assert_eq!(
            digest("t", 1.0),
            "3fe63e896c7311a8d03d0cc59d1c6fd520cb23ee77ad68950d05ffa99612e7e8"
        );
        assert_ne!(digest("u", 1.0), digest("t", 1.0));
        assert_ne!(digest("t", 2.0), digest("t", 1.0));
    }
}
