//! The scenarios of a grid: one for each combination of what `[grid]` lists.

use std::path::Path;

use crate::document::{Document, Entry, Node, Value};
use crate::error::{IoError, KeyError, KeyProblem};
use crate::scenario::ScenarioFile;

/// The most scenarios of a grid.
pub(super) const MOST_CELLS: usize = 100_000;

/// The most text that all scenarios of a grid may be, which is held some ten times over \[bytes\].
const MOST_TEXT: usize = 1 << 27;

/// A scenario file, and those that its `[grid]` makes of it.
///
/// Each key of `[grid]` names a key of the file, its sections and places in lists joined by points, and
/// lists what stands there in turn, or gives a range:
///
/// ```
/// # use std::path::Path;
/// # let scenario = r#"
/// # [site]
/// # latitude = "34.25 deg"
/// # longitude = "108.9 deg"
/// # height = "400 m"
/// # [log]
/// # rate = "50 Hz"
/// # table_rate = {}
/// # [table]
/// # profile = [{ rate = "10 deg/s", duration = "36 s" }]
/// # [truth]
/// # seed = 1
/// # attitude = { roll = "30 deg", pitch = "20 deg", yaw = "40 deg" }
/// # noise = { gyro = "off", accel = "off" }
/// # "#;
/// let grid = r#"
/// [grid]
/// "truth.attitude.roll" = ["0 deg", "30 deg"]
/// "table.profile.0.rate" = { from = "5 deg/s", to = "15 deg/s", steps = 3 }
/// "#;
/// let text = format!("{scenario}{grid}");
/// let grid = rins_io::ScenarioGrid::parse(&text, Path::new("scenario.toml"))?;
/// assert_eq!(grid.cells.len(), 6);
/// assert_eq!(grid.cells[1].values, ["0 deg", "10 deg/s"]); // the last key runs fastest
/// # Ok::<(), rins_io::IoError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ScenarioGrid {
    /// The keys of the grid, in the order of the file.
    pub keys: Vec<String>,
    /// The scenarios; one without a grid.
    pub cells: Vec<GridCell>,
    /// The file's text.
    pub text: String,
}

/// One scenario of a grid.
#[derive(Clone, Debug)]
pub struct GridCell {
    /// What stands at each of the grid's keys, as it is written.
    pub values: Vec<String>,
    /// The scenario.
    pub file: ScenarioFile,
}

/// A key of the grid and what stands there in turn.
struct Axis {
    key: String,
    line: usize,
    values: Vec<Value>,
}

impl ScenarioGrid {
    /// Reads the scenario file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read; else as [`ScenarioGrid::parse`].
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::parse(&Document::text(path)?, path)
    }

    /// The scenarios that `text` describes, as if it stood in the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`] if `[grid]` is not one, or any of its scenarios is wrong.
    pub fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        let document = Document::parse(text, path)?;
        let mut base = document.clone();
        base.root.retain(|entry| entry.key != "grid");
        let mut axes = Vec::new();
        if let Some(grid) = document.root.iter().find(|entry| entry.key == "grid") {
            collect(path, "", grid, &mut axes)?;
        }
        let mut lengths = axes.iter().map(|axis| axis.values.len());
        let cells = lengths.try_fold(1, usize::checked_mul).filter(|cells| *cells <= MOST_CELLS);
        let Some(cells) = cells else {
            let reason = format!("more than {MOST_CELLS} combinations");
            return Err(refusal(path, "", None, KeyProblem::Conflict { reason }));
        };
        if cells > 1 && cells.saturating_mul(text.len()) > MOST_TEXT {
            let most = MOST_TEXT >> 20;
            let reason = format!(
                "{cells} scenarios of {} bytes are more than {most} MiB; split the grid into several campaigns",
                text.len()
            );
            return Err(refusal(path, "", None, KeyProblem::Conflict { reason }));
        }
        let cell = |mut place: usize| {
            let mut values = Vec::new();
            for axis in axes.iter().rev() {
                values.push((axis, &axis.values[place % axis.values.len()]));
                place /= axis.values.len();
            }
            values.reverse();
            let mut document = base.clone();
            for (axis, value) in &values {
                put(&mut document.root, &axis.key, value)
                    .map_err(|problem| refusal(path, &axis.key, Some(axis.line), problem))?;
            }
            Ok(GridCell {
                values: values.iter().map(|(_, value)| shown(value)).collect(),
                file: ScenarioFile::from_document(document)?,
            })
        };
        Ok(Self {
            cells: (0..cells).map(cell).collect::<Result<_, IoError>>()?,
            keys: axes.into_iter().map(|axis| axis.key).collect(),
            text: text.into(),
        })
    }
}

fn refusal(path: &Path, key: &str, line: Option<usize>, problem: KeyProblem) -> IoError {
    let key = if key.is_empty() { "[grid]".into() } else { format!("[grid] {key}") };
    Box::new(KeyError { path: path.into(), line, key, problem }).into()
}

/// A value as it is written, without the quotes of a text.
fn shown(value: &Value) -> String {
    match &value.node {
        Node::Text(text) => text.clone(),
        _ => value.source.clone(),
    }
}

/// Collects the keys of `[grid]`; a table that is no range only joins its name to those in it.
fn collect(path: &Path, prefix: &str, entry: &Entry, axes: &mut Vec<Axis>) -> Result<(), IoError> {
    let wrong = |key: &str| {
        let expected = r#"a list, or a range { from = "1 deg", to = "5 deg", steps = 5 }"#;
        let got = entry.value.node.described(&entry.value.source);
        let problem = KeyProblem::WrongType { got, expected: expected.into() };
        refusal(path, key, Some(entry.line), problem)
    };
    match &entry.value.node {
        Node::Table(entries) if !entries.iter().any(|entry| entry.key == "from") => {
            for entry in entries {
                let key = if prefix.is_empty() {
                    entry.key.clone()
                } else {
                    format!("{prefix}.{}", entry.key)
                };
                collect(path, &key, entry, axes)?;
            }
            Ok(())
        }
        Node::Table(entries) => {
            let values = range(entries, entry.line).ok_or_else(|| wrong(prefix))?;
            axes.push(Axis { key: prefix.into(), line: entry.line, values });
            Ok(())
        }
        Node::List(values) if !values.is_empty() && !prefix.is_empty() => {
            axes.push(Axis { key: prefix.into(), line: entry.line, values: values.clone() });
            Ok(())
        }
        _ => Err(wrong(prefix)),
    }
}

/// The values of a range whose ends have the same unit.
fn range(entries: &[Entry], line: usize) -> Option<Vec<Value>> {
    if entries.len() != 3 {
        return None;
    }
    let get = |key: &str| entries.iter().find(|entry| entry.key == key).map(|e| &e.value.node);
    let end = |key: &str| match get(key)? {
        Node::Text(text) => {
            let text = text.trim();
            let (number, unit) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
            Some((number.parse::<f64>().ok()?, unit.trim().to_string()))
        }
        _ => None,
    };
    let ((from, unit), (to, same)) = (end("from")?, end("to")?);
    let Some(&Node::Integer(steps)) = get("steps") else { return None };
    let steps = usize::try_from(steps).ok().filter(|steps| (2..=MOST_CELLS).contains(steps))?;
    if unit != same || !from.is_finite() || !to.is_finite() {
        return None;
    }
    let value = |step: usize| {
        let part = step as f64 / (steps - 1) as f64;
        // Both ends are what is written, to the last bit.
        let number = if step + 1 == steps { to } else { from + (to - from) * part };
        let text = format!("{number} {unit}").trim_end().to_string();
        Value { line, source: format!("{text:?}"), node: Node::Text(text) }
    };
    Some((0..steps).map(value).collect())
}

/// Puts a value at a path of keys and places.
fn put(root: &mut Vec<Entry>, path: &str, value: &Value) -> Result<(), KeyProblem> {
    let missing = |part: &str| KeyProblem::Conflict {
        reason: format!("the scenario has no {part:?} to put it in"),
    };
    let (first, rest) = path.split_once('.').map_or((path, None), |(key, rest)| (key, Some(rest)));
    let place = root.iter().position(|entry| entry.key == first);
    let Some(rest) = rest else {
        match place {
            Some(place) => root[place].value = value.clone(),
            None => {
                let (key, line) = (first.to_string(), value.line);
                root.push(Entry { key, line, value: value.clone() });
            }
        }
        return Ok(());
    };
    let place = place.ok_or_else(|| missing(first))?;
    put_in(&mut root[place].value, rest, value).ok_or_else(|| missing(path))?
}

/// Puts a value at a path into a table or a list; `None` if there is no such place.
fn put_in(inside: &mut Value, path: &str, value: &Value) -> Option<Result<(), KeyProblem>> {
    match &mut inside.node {
        Node::Table(entries) => Some(put(entries, path, value)),
        Node::List(items) => {
            let (index, rest) =
                path.split_once('.').map_or((path, None), |(index, rest)| (index, Some(rest)));
            let item = items.get_mut(index.parse::<usize>().ok()?)?;
            match rest {
                Some(rest) => put_in(item, rest, value),
                None => {
                    *item = value.clone();
                    Some(Ok(()))
                }
            }
        }
        _ => None,
    }
}
