//! The state of a live calibration in a file.

use std::path::Path;

use anyhow::Context;
use rins_estimation::{OnlineCheckpoint, OnlineFilter};
use rins_io::{IoError, Overwrite, shown, write_file};
use serde::{Deserialize, Serialize};

use super::{LiveCalibration, LiveOptions};
use crate::error::Result;

/// The content of the file.
#[derive(Debug, Serialize, Deserialize)]
struct Content {
    /// The digest of the rig file.
    rig_sha256: String,
    /// The name of the model.
    model: String,
    notes: Vec<String>,
    assumptions: Vec<String>,
    filter: OnlineCheckpoint,
}

impl LiveCalibration {
    /// Writes the state to a file, atomically. Returns whether there is a state yet: before the samples at the start are complete,
    /// there is none, and nothing is written.
    ///
    /// # Errors
    /// If the file cannot be written; it is then as it was.
    pub fn write_checkpoint(&self, path: &Path) -> Result<bool> {
        let Some(filter) = &self.filter else { return Ok(false) };
        let content = Content {
            rig_sha256: self.digest(),
            model: self.model.clone(),
            notes: self.notes.clone(),
            assumptions: self.basis.assumptions.clone(),
            filter: filter.checkpoint(),
        };
        let text = serde_json::to_string(&content).map_err(anyhow::Error::from)?;
        write_file(path, Overwrite::Force, |out| {
            let written = out.write_all(text.as_bytes());
            written.map_err(|source| IoError::File { action: "write", path: path.into(), source })
        })?;
        Ok(true)
    }

    fn digest(&self) -> String {
        let inputs = &self.basis.provenance.inputs;
        inputs.first().map(|input| input.sha256.clone()).unwrap_or_default()
    }

    /// A calibration that continues from a checkpoint. The log is given from its beginning, or from a later row: rows up to the time of the
    /// checkpoint are passed over.
    ///
    /// # Errors
    /// As [`LiveCalibration::new`], and if the checkpoint cannot be read, is damaged, or belongs to another rig file or model.
    pub fn resume(
        rig: &Path,
        source: Option<&Path>,
        options: LiveOptions,
        checkpoint: &Path,
    ) -> Result<Self> {
        Ok(Self::resumed(rig, source, options, checkpoint)?)
    }

    fn resumed(
        rig: &Path,
        source: Option<&Path>,
        options: LiveOptions,
        checkpoint: &Path,
    ) -> anyhow::Result<Self> {
        let mut live = Self::opened(rig, source, options)?;
        let named = || shown(checkpoint);
        let text = std::fs::read_to_string(checkpoint)
            .with_context(|| format!("cannot read {}", named()))?;
        let content: Content = serde_json::from_str(&text)
            .with_context(|| format!("{}: not a checkpoint of a live calibration", named()))?;
        anyhow::ensure!(
            content.rig_sha256 == live.digest(),
            "{}: the checkpoint was made with another rig file than {}, or {} has been changed since",
            named(),
            live.name,
            live.name
        );
        anyhow::ensure!(
            content.model == live.model,
            "{}: the checkpoint was made with the model {}, not {}",
            named(),
            content.model,
            live.model
        );
        let filter = OnlineFilter::resume(&content.filter).with_context(named)?;
        live.resumed = filter.time();
        live.notes = content.notes;
        live.basis = live.basis.assuming(content.assumptions);
        live.filter = Some(filter);
        Ok(live)
    }
}
