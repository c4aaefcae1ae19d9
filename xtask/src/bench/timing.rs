//! The results of criterion.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::Result;

/// The folder of criterion's results.
pub(super) struct Timings {
    folder: PathBuf,
}

impl Timings {
    pub(super) fn read(folder: &Path) -> Result<Self> {
        if folder.is_dir() {
            Ok(Self { folder: folder.into() })
        } else {
            Err(format!("{}: no results of any bench", folder.display()).into())
        }
    }

    /// The median time per element of a bench \[ns\].
    pub(super) fn of(&self, bench: &str) -> Result<f64> {
        let folder = self.folder.join(bench).join("new");
        let number = |name: &str, pointer: &str| -> Result<f64> {
            let path = folder.join(name);
            let text = fs::read_to_string(&path)
                .map_err(|error| format!("{}: {error}", path.display()))?;
            let value: Value = serde_json::from_str(&text)?;
            let found = value.pointer(pointer).and_then(Value::as_f64);
            found.ok_or_else(|| format!("{}: no number at {pointer}", path.display()).into())
        };
        let median = number("estimates.json", "/median/point_estimate")?;
        Ok(median / number("benchmark.json", "/throughput/Elements")?)
    }
}

/// A number with this number of decimals, or a dash.
pub(super) fn per(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "-".into(), |value| format!("{value:.decimals$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_median_is_read_for_one_element() {
        let folder = tempfile::tempdir().unwrap();
        let new = folder.path().join("filter/one/new");
        fs::create_dir_all(&new).unwrap();
        fs::write(new.join("estimates.json"), r#"{"median": {"point_estimate": 500.0}}"#).unwrap();
        fs::write(new.join("benchmark.json"), r#"{"throughput": {"Elements": 200}}"#).unwrap();
        let timings = Timings::read(folder.path()).unwrap();
        assert!((timings.of("filter/one").unwrap() - 2.5).abs() < 1e-12);
        let missing = timings.of("filter/two").unwrap_err().to_string();
        assert!(missing.contains("two"), "{missing}");
    }
}
