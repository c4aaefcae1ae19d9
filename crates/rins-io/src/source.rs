//! The source of a log's bytes: the disk or, in a build for fuzzing, memory.

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

    /// A source that is read sequentially.
    pub(crate) type Source = File;

    /// Opens a file for sequential reading.
    pub(crate) fn open(path: &Path) -> io::Result<Source> {
        inputs::open(path)
    }

    /// A source with random access.
    pub(crate) type Chunks = File;

    /// Opens a file for random access.
    pub(crate) fn chunks(path: &Path) -> io::Result<Chunks> {
        inputs::open(path)
    }

    /// The length of the file \[bytes\].
    pub(crate) fn length(path: &Path) -> io::Result<u64> {
        fs::metadata(path).map(|data| data.len())
    }
}
