//! The files of a campaign: the scenarios of a grid, the results, and the journal of finished chunks.

mod grid;
mod journal;
mod read;
mod table;

pub use grid::{GridCell, ScenarioGrid};
pub use journal::{Journal, JournalRun};
pub use read::PartRuns;
pub use table::{CampaignModel, Heading, Identity, ModelRecord, Record, Row, RunRows, write_part};
