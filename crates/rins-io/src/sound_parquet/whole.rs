//! A file of which nothing is read behind its end, and no page that says it is huge.

use std::io::{self, Chain, Cursor, Read};

use parquet::errors::{ParquetError, Result};
use parquet::file::FOOTER_SIZE;
use parquet::file::reader::{ChunkReader, Length};

use super::runs::number;

/// Before each of the first fields of a page's head: one more, of a whole number.
const NEXT_NUMBER: u8 = 0x15;

/// A file whose readers fail at its end, and do not begin with a page that would grow beyond `most` bytes.
///
/// The parser skips lists that are said to have billions of items, and goes on to the last of them
/// where reading ends without an error. And it makes room for all that a page says it will be
/// decompressed to.
pub(super) struct Whole<R> {
    pub(super) file: R,
    pub(super) most: u64,
}

/// How many bytes of a page's head tell its size.
const HEAD: usize = 12;

/// What the page that begins so says it is decompressed to \[bytes\].
fn grown(mut head: &[u8]) -> Result<u64> {
    let mut next = || {
        head = head.strip_prefix(&[NEXT_NUMBER])?;
        number(&mut head).ok()?
    };
    // Its kind is told first. The last bit is the sign.
    let size = next().and_then(|_kind| next()).map(|size| size >> 1);
    size.ok_or_else(|| ParquetError::General("a page without its sizes".into()))
}

/// What reads such a file: what was looked at, and then the rest.
pub(super) struct Ended<T>(Chain<Cursor<Vec<u8>>, T>);

impl<R: Length> Length for Whole<R> {
    fn len(&self) -> u64 {
        self.file.len()
    }
}

impl<R: ChunkReader> ChunkReader for Whole<R> {
    type T = Ended<R::T>;

    fn get_read(&self, start: u64) -> Result<Self::T> {
        // All else that is read in this way is the heads of pages, each followed by its page.
        let is_footer = start.saturating_add(FOOTER_SIZE as u64) >= self.len();
        let mut rest = self.file.get_read(start)?;
        let mut head = vec![0; if is_footer { 0 } else { HEAD }];
        rest.read_exact(&mut head)?;
        if !is_footer && grown(&head)? > self.most {
            return Err(ParquetError::General("a page with an implausible declared size".into()));
        }
        Ok(Ended(Cursor::new(head).chain(rest)))
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<bytes::Bytes> {
        self.file.get_bytes(start, length)
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

#[cfg(test)]
mod tests {
    use bytes::Bytes;

    use super::*;

    #[test]
    fn a_page_grows_to_what_a_file_may_have_at_most() {
        // A page of the first kind, of 3000 bytes, and of 2^31 - 1.
        let page = |size: &[u8]| [&[0x15, 0x00, 0x15], size, &[0; 20]].concat();
        let read = |head: Vec<u8>| {
            let whole = Whole { file: Bytes::from(head), most: 3000 };
            whole.get_read(0).map(|_| ()).map_err(|error| error.to_string())
        };
        assert_eq!(read(page(&[0xf0, 0x2e])), Ok(()));
        let large = "Parquet error: a page with an implausible declared size";
        assert_eq!(read(page(&[0xf2, 0x2e])), Err(large.into()));
        assert_eq!(read(page(&[0xfe, 0xff, 0xff, 0xff, 0x0f])), Err(large.into()));
        assert_eq!(read([0x19; 20].into()), Err("Parquet error: a page without its sizes".into()));
    }
}
