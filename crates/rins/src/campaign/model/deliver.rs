//! The results of a campaign of a model, written with their report.

use std::cell::RefCell;
use std::path::Path;

use rins_io::{Heading, IoError, Overwrite};

use super::page::report;
use super::run::ModelRun;
use super::scored::Scored;
use super::text::text;
use crate::campaign::execution::Rows;
use crate::campaign::outcome::{CampaignOutcome, Files, Source};

/// Writes the results and their report, and returns the outcome.
///
/// The runs come in the order of scenarios and runs and are written one by one; only the data that the report needs are kept.
pub(in crate::campaign) fn deliver_model(
    heading: &Heading,
    runs: impl Iterator<Item = Result<ModelRun, IoError>>,
    output: &Path,
    source: Source<'_>,
    overwrite: Overwrite,
) -> anyhow::Result<CampaignOutcome> {
    let title = format!("Campaign of {}", source.0);
    let files = Files::of(output)?;
    let drawn = heading.identity.model.as_ref().is_some_and(|model| model.truth == "prior");
    let scored = RefCell::new(Vec::new());
    let rows = runs.map(|run| {
        run.map(|run| {
            Scored::add(&mut scored.borrow_mut(), heading, &run);
            run.rows()
        })
    });
    files.write(overwrite, heading, rows, || {
        let mut scored = scored.borrow_mut();
        for cell in scored.iter_mut() {
            cell.judge(drawn);
        }
        report(heading, &scored, &title)
    })?;
    let scored = scored.into_inner();
    let cells = scored.iter().map(|cell| cell.result(&heading.keys)).collect();
    Ok(files.outcome(heading, source, cells, text(heading, &scored, &title)))
}
