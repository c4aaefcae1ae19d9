//! Files of a campaign: the scenarios of a grid, the results, and what is done of them so far.

mod grid;
mod journal;
mod table;

pub use grid::{GridCell, ScenarioGrid};
pub use journal::Journal;
pub use table::{Identity, Part, Record, Row, read_part, write_part};
