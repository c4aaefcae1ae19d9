//! Which runs there are, and in which portions they are made.

use std::ops::Range;

use crate::cell::Cell;

/// Runs over scenarios.
#[derive(Clone, Debug, PartialEq)]
pub struct Campaign {
    /// The scenarios, each with what the filter is told of it.
    pub cells: Vec<Cell>,
    /// How many runs of each.
    pub runs: u64,
}

/// A portion of a campaign: runs of one cell, made by one thread.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Its place in the campaign, from 0.
    pub index: u64,
    /// The cell's.
    pub cell: usize,
    /// The numbers of its runs.
    pub runs: Range<u64>,
}

/// The most runs of a chunk: whole vectors of any machine, and some tenths of a second.
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

    /// How many chunks there are.
    pub fn chunk_count(&self) -> u64 {
        self.cells.len() as u64 * self.chunks_per_cell()
    }

    fn chunks_per_cell(&self) -> u64 {
        self.runs.div_ceil(CHUNK)
    }
}
