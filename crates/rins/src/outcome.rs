//! The outcome of a job, which every function of the library returns.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use rins_io::{IoError, Overwrite, write_folder};
use rins_report::{Report, render};
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::basis::BasisResult;
use crate::error::Result;

/// The file name of the report page in a folder of results.
const PAGE: &str = "report.html";

/// The outcome of a job: its text is what the command prints, its result is what `--json` prints, and its page and files are
/// what `-o` writes.
pub trait Outcome: Display {
    /// The machine-readable result: a documented struct, whose JSON schema is in `docs/schema`.
    type Result: Serialize + DeserializeOwned + JsonSchema;

    /// The machine-readable result.
    fn result(&self) -> Self::Result;

    /// The result as one line of JSON without its line feed, which `--json` prints.
    ///
    /// # Errors
    /// If a map of the result has a key that is not text.
    fn json(&self) -> Result<String> {
        Ok(serde_json::to_string(&self.result()).map_err(anyhow::Error::from)?)
    }

    /// The basis of the result: its inputs, what was repaired in them, and what was assumed.
    fn basis(&self) -> BasisResult;

    /// The report page, if there is one; the folder of results has it with the basis.
    fn report(&self) -> Option<Report> {
        None
    }

    /// The report as one HTML page that works offline, if there is one.
    fn page(&self) -> Option<String> {
        let mut report = self.report()?;
        report.sections.push(self.basis().section());
        Some(render(&report))
    }

    /// Further files for the folder of results: their names and contents.
    fn files(&self) -> Vec<(String, Vec<u8>)> {
        Vec::new()
    }

    /// Writes the further files into a folder that is being created.
    ///
    /// # Errors
    /// [`IoError`] if a file cannot be written.
    fn fill(&self, folder: &Path) -> Result<(), IoError> {
        self.files().iter().try_for_each(|(name, content)| put(folder, name, content))
    }

    /// The defect of the data, if there is one in spite of the result.
    fn failure(&self) -> Option<String> {
        None
    }

    /// Writes `result.json`, `report.html` and the further files into a folder, all or none.
    ///
    /// Returns the path of the page, if there is one.
    ///
    /// # Errors
    /// If the folder exists and must not be overwritten, or cannot be written.
    fn write(&self, folder: &Path, overwrite: Overwrite) -> Result<Option<PathBuf>> {
        let json = serde_json::to_string_pretty(&self.result()).map_err(anyhow::Error::from)?;
        let page = self.page();
        write_folder(folder, overwrite, |folder| {
            put(folder, "result.json", json.as_bytes())?;
            if let Some(page) = &page {
                put(folder, PAGE, page.as_bytes())?;
            }
            self.fill(folder)
        })?;
        Ok(page.map(|_| folder.join(PAGE)))
    }
}

fn put(folder: &Path, name: &str, content: &[u8]) -> Result<(), IoError> {
    let path = folder.join(name);
    std::fs::write(&path, content).map_err(|source| IoError::File { action: "write", path, source })
}
