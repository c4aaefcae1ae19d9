//! A campaign whose results have been written.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use rins_io::{Heading, IoError, Overwrite, RunRows, shown, write_files, write_part};
use rins_report::{Report, render};

use super::result::{CampaignResult, CellResult};
use crate::basis::BasisResult;
use crate::outcome::Outcome;

/// A campaign whose results have been written.
#[derive(Debug)]
pub struct CampaignOutcome {
    text: String,
    result: CampaignResult,
}

impl fmt::Display for CampaignOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Outcome for CampaignOutcome {
    type Result = CampaignResult;

    fn result(&self) -> CampaignResult {
        self.result.clone()
    }

    fn basis(&self) -> BasisResult {
        self.result.basis.clone()
    }
}

/// The source of a campaign: the scenario or the shards, the command, and the files.
pub(super) type Source<'s> = (&'s str, &'static str, BasisResult);

/// The files of a campaign that are written together.
pub(super) struct Files<'p> {
    results: &'p Path,
    page: PathBuf,
}

impl<'p> Files<'p> {
    /// The files of these results.
    pub(super) fn of(results: &'p Path) -> anyhow::Result<Self> {
        let page = results.with_extension("html");
        anyhow::ensure!(page != results, "{}: the report would go here", shown(results));
        Ok(Self { results, page })
    }

    /// Writes the results run by run, and then their report.
    pub(super) fn write(
        &self,
        overwrite: Overwrite,
        heading: &Heading,
        runs: impl Iterator<Item = Result<RunRows, IoError>>,
        report: impl FnOnce() -> Report,
    ) -> Result<(), IoError> {
        write_files(&[self.results, &self.page], overwrite, |folder| {
            let in_folder = |path: &Path| folder.join(path.file_name().unwrap_or_default());
            write_part(&in_folder(self.results), Overwrite::Refuse, heading, runs)?;
            let path = in_folder(&self.page);
            fs::write(&path, render(&report())).map_err(|source| IoError::File {
                action: "write",
                path,
                source,
            })
        })
    }

    /// The outcome, once they are written.
    pub(super) fn outcome(
        &self,
        heading: &Heading,
        (source, command, basis): Source<'_>,
        cells: Vec<CellResult>,
        text: String,
    ) -> CampaignOutcome {
        let model = heading.identity.model.as_ref();
        let result = CampaignResult {
            schema: crate::SCHEMA,
            command: command.into(),
            scenario: source.into(),
            runs: heading.identity.runs,
            seed: heading.identity.seed,
            shard: [heading.identity.shard.0, heading.identity.shard.1],
            results: self.results.display().to_string(),
            report: self.page.display().to_string(),
            cells,
            model: model.map(|model| model.name.clone()),
            noise: model.map(|model| model.noise.clone()),
            truth: model.map(|model| model.truth.clone()),
            basis,
        };
        let text =
            text + &format!("\nResults: {}\nReport: {}\n", shown(self.results), shown(&self.page));
        CampaignOutcome { text, result }
    }
}

/// The label of a scenario of the grid: its values of the keys that vary.
pub(super) fn label(keys: &[String], values: &[String]) -> String {
    let pairs = keys.iter().zip(values).map(|(key, value)| format!("{key} = {value}"));
    let label = pairs.collect::<Vec<_>>().join(", ");
    if label.is_empty() { "the scenario".into() } else { label }
}
