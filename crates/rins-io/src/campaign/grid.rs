//! The scenarios of a grid: one for each combination of the values in `[grid]`.

use std::path::Path;

use crate::document::{Document, Entry, Node, Value};
use crate::error::{IoError, KeyError, KeyProblem};
use crate::scenario::ScenarioFile;

/// The maximum number of scenarios of a grid.
pub(super) const MOST_CELLS: usize = 100_000;

/// The maximum text of all scenarios of a grid, which occupies about ten times as much memory \[bytes\].
const MOST_TEXT: usize = 1 << 27;

/// A scenario file, and the scenarios that its `[grid]` defines.
///
/// Each key of `[grid]` is a key of the file, with its sections and list indices joined by points. Its value is the list of
/// values to be used, or a range:
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
    /// The scenarios; one if there is no grid.
    pub cells: Vec<GridCell>,
    /// The file's text.
    pub text: String,
}

/// One scenario of a grid.
#[derive(Clone, Debug)]
pub struct GridCell {
    /// The value of each key of the grid, as written in the file.
    pub values: Vec<String>,
    /// The scenario.
    pub file: ScenarioFile,
}

/// A key of the grid and the list of its values.
struct Axis {
    key: String,
    line: usize,
    values: Vec<Value>,
}

impl ScenarioGrid {
    /// Reads the scenario file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read; otherwise as for [`ScenarioGrid::parse`].
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::parse(&Document::text(path)?, path)
    }

    /// The scenarios in `text`, parsed as the content of the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`] if `[grid]` is invalid, or any of its scenarios is.
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
            let file = ScenarioFile::from_document(document)?;
            file.require_spin_about_z("a campaign simulates runs about z; leave this out")?;
            Ok(GridCell { values: values.iter().map(|(_, value)| shown(value)).collect(), file })
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

/// A value as written in the file, without the quotes of a string.
fn shown(value: &Value) -> String {
    match &value.node {
        Node::Text(text) => text.clone(),
        _ => value.source.clone(),
    }
}

/// Collects the keys of `[grid]`; a table that is not a range only prefixes its name to the keys in it.
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

/// The values of a range whose limits have the same unit.
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
        // Both limits are reproduced exactly.
        let number = if step + 1 == steps { to } else { from + (to - from) * part };
        let text = format!("{number} {unit}").trim_end().to_string();
        Value { line, source: format!("{text:?}"), node: Node::Text(text) }
    };
    Some((0..steps).map(value).collect())
}

/// Sets the value at a path of keys and indices.
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

/// Sets the value at a path in a table or a list; `None` if the path does not exist.
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
