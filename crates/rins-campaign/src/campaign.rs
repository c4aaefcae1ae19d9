//! The runs of a campaign, and their division into chunks.

use std::ops::Range;

use crate::cell::Cell;

/// A campaign: runs of several scenarios.
#[derive(Clone, Debug, PartialEq)]
pub struct Campaign {
    /// The scenarios, each with the setup of the filter.
    pub cells: Vec<Cell>,
    /// The number of runs of each.
    pub runs: u64,
}

/// A chunk of a campaign: runs of one cell, computed by one thread.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Its index in the campaign, from 0.
    pub index: u64,
    /// The index of the cell.
    pub cell: usize,
    /// The indices of its runs.
    pub runs: Range<u64>,
}

/// The maximum number of runs of a chunk: a multiple of the vector width of any machine, which takes some tenths of a second.
const CHUNK: u64 = 64;

impl Campaign {
    /// All chunks, in the order of cells and runs.
    pub fn chunks(&self) -> impl Iterator<Item = Chunk> + '_ {
        let per_cell = self.chunks_per_cell();
        (0..self.cells.len()).flat_map(move |cell| {
            (0..per_cell).map(move |part| {
                let first = part * CHUNK;
                let runs = first..(first + CHUNK).min(self.runs);
                Chunk { index: cell as u64 * per_cell + part, cell, runs }
            })
        })
    }

    /// The number of chunks.
    pub fn chunk_count(&self) -> u64 {
        self.cells.len() as u64 * self.chunks_per_cell()
    }

    fn chunks_per_cell(&self) -> u64 {
        self.runs.div_ceil(CHUNK)
    }
}
