//! What a command found, and how it is delivered.

use std::fmt::Write as _;
use std::path::Path;

use rins_io::{IoError, Loaded, Overwrite, write_file, write_folder};
use serde_json::Value;

use crate::commands::repairs::repairs;
use rins_io::shown;
use rins_report::{Report, render};

/// Writes further files into the folder that it is given.
pub(crate) type Fill = Box<dyn Fn(&Path) -> Result<(), IoError>>;

/// What a command found.
#[derive(Default)]
pub(crate) struct Outcome {
    /// For a machine, in the shape of the contract.
    pub(crate) json: Value,
    /// For a person at a terminal.
    pub(crate) text: String,
    /// For a person in a browser.
    pub(crate) report: Option<Report>,
    /// Further files for the output folder.
    pub(crate) files: Vec<(String, Vec<u8>)>,
    /// What else to write into the output folder.
    pub(crate) fill: Option<Fill>,
    /// The whole result, where it is one file and not a folder.
    pub(crate) file: Option<String>,
    /// Why the exit code must say that the data are at fault, although there is a result.
    pub(crate) failure: Option<String>,
}

impl Outcome {
    /// The same with what reading the log has repaired or left out, so that no result is without.
    #[must_use]
    pub(crate) fn of_log(mut self, loaded: &Loaded) -> Self {
        let repairs = repairs(&loaded.rig, &loaded.summary);
        for repair in &repairs {
            // Writing to a string cannot fail.
            let _ = writeln!(self.text, "  ! {repair}");
        }
        if let Some(report) = &mut self.report {
            report.summary.extend(repairs.iter().cloned());
        }
        let mut all = self.json["repairs"].as_array().cloned().unwrap_or_default();
        all.extend(repairs.into_iter().map(Value::from));
        self.json["repairs"] = all.into();
        self
    }

    /// Writes `result.json`, `report.html` and the further files into a folder, all or none; or the
    /// one file that is the result.
    ///
    /// Returns a sentence that says where the result is.
    pub(crate) fn write(
        &self,
        destination: Option<&Path>,
        overwrite: Overwrite,
    ) -> anyhow::Result<Option<String>> {
        let Some(destination) = destination else {
            return Ok(None);
        };
        if let Some(content) = &self.file {
            write_file(destination, overwrite, |out| {
                out.write_all(content.as_bytes()).map_err(|source| {
                    let path = destination.to_path_buf();
                    IoError::File { action: "write", path, source }
                })
            })?;
            return Ok(Some(format!("Written: {}", shown(destination))));
        }
        let json = serde_json::to_string_pretty(&self.json)?;
        let page = self.report.as_ref().map(render);
        write_folder(destination, overwrite, |folder| {
            let write = |name: &str, content: &[u8]| {
                let path = folder.join(name);
                std::fs::write(&path, content).map_err(|source| IoError::File {
                    action: "write",
                    path,
                    source,
                })
            };
            write("result.json", json.as_bytes())?;
            if let Some(page) = &page {
                write("report.html", page.as_bytes())?;
            }
            self.files.iter().try_for_each(|(name, content)| write(name, content))?;
            self.fill.as_ref().map_or(Ok(()), |fill| fill(folder))
        })?;
        let shown = match self.report {
            Some(_) => format!("Report: {}", shown(&destination.join("report.html"))),
            None => format!("Written: {}", shown(destination)),
        };
        Ok(Some(shown))
    }
}
