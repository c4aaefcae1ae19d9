//! A file of which nothing is read behind its end.

use std::io::{self, Read};

use parquet::errors::Result;
use parquet::file::reader::{ChunkReader, Length};

/// A file whose readers fail at its end.
///
/// The parser skips lists that are said to have billions of items, and goes on to the last of them
/// where reading ends without an error.
pub(super) struct Whole<R>(pub(super) R);

/// What reads such a file.
pub(super) struct Ended<T>(T);

impl<R: Length> Length for Whole<R> {
    fn len(&self) -> u64 {
        self.0.len()
    }
}

impl<R: ChunkReader> ChunkReader for Whole<R> {
    type T = Ended<R::T>;

    fn get_read(&self, start: u64) -> Result<Self::T> {
        self.0.get_read(start).map(Ended)
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<bytes::Bytes> {
        self.0.get_bytes(start, length)
    }
}

impl<T: Read> Read for Ended<T> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.0.read(buffer)? {
            0 if !buffer.is_empty() => Err(io::ErrorKind::UnexpectedEof.into()),
            read => Ok(read),
        }
    }
}
