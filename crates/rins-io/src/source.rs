//! Where a log's bytes come from: the disk or, in a build for fuzzing, memory.

#[cfg(not(fuzzing))]
pub(crate) use disk::{Chunks, Source, chunks, length, open};
#[cfg(fuzzing)]
pub(crate) use memory::{Chunks, Source, chunks, length, open};

#[cfg(fuzzing)]
pub(crate) mod memory;

#[cfg(not(fuzzing))]
mod disk {
    use std::fs::{self, File};
    use std::io;
    use std::path::Path;

    use crate::inputs;

    /// What is read from the first byte on.
    pub(crate) type Source = File;

    /// The bytes from the first on.
    pub(crate) fn open(path: &Path) -> io::Result<Source> {
        inputs::open(path)
    }

    /// What is read in any order.
    pub(crate) type Chunks = File;

    /// The bytes in any order.
    pub(crate) fn chunks(path: &Path) -> io::Result<Chunks> {
        inputs::open(path)
    }

    /// How many there are.
    pub(crate) fn length(path: &Path) -> io::Result<u64> {
        fs::metadata(path).map(|data| data.len())
    }
}
