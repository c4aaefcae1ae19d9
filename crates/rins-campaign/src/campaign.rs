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

/// The chunks of a campaign of `runs` runs of each of `cells` cells, in the order of cells and runs, with at most `size` runs each.
///
/// # Panics
/// If `size` is zero.
///
/// ```
/// let chunks: Vec<_> = rins_campaign::chunks(2, 5, 4).collect();
/// assert_eq!(chunks.len(), 4);
/// assert_eq!((chunks[3].index, chunks[3].cell, chunks[3].runs.clone()), (3, 1, 4..5));
/// ```
pub fn chunks(cells: usize, runs: u64, size: u64) -> impl Iterator<Item = Chunk> + use<> {
    let per_cell = runs.div_ceil(size);
    (0..cells).flat_map(move |cell| {
        (0..per_cell).map(move |part| {
            let first = part * size;
            let runs = first..(first + size).min(runs);
            Chunk { index: cell as u64 * per_cell + part, cell, runs }
        })
    })
}

impl Campaign {
    /// The maximum number of runs of a chunk: a multiple of the vector width of any machine, which takes some tenths of a second.
    pub const CHUNK: u64 = 64;

    /// All chunks, in the order of cells and runs.
    pub fn chunks(&self) -> impl Iterator<Item = Chunk> + use<> {
        chunks(self.cells.len(), self.runs, Self::CHUNK)
    }

    /// The number of chunks.
    pub fn chunk_count(&self) -> u64 {
        self.cells.len() as u64 * self.chunks_per_cell()
    }

    fn chunks_per_cell(&self) -> u64 {
        self.runs.div_ceil(Self::CHUNK)
    }
}
