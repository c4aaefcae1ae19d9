//! A file that is not read beyond its end, and without pages of excessive stated size.

use std::io::{self, Chain, Cursor, Read};

use parquet::errors::{ParquetError, Result};
use parquet::file::FOOTER_SIZE;
use parquet::file::reader::{ChunkReader, Length};

use super::runs::number;

/// The byte before each of the first fields of a page header: the next field, an integer.
const NEXT_NUMBER: u8 = 0x15;

/// A file whose readers fail at its end, and refuse a first page that would be decompressed to more than `most` bytes.
///
/// The parser skips lists with a stated length of billions of items, and continues to the last of them
/// if reading at the end returns no error. It also allocates the full size to which a page is said
/// to be decompressed.
pub(super) struct Whole<R> {
    pub(super) file: R,
    pub(super) most: u64,
}

/// The number of bytes of a page header that contain its size.
const HEAD: usize = 12;

/// The decompressed size that the page with this header states \[bytes\].
fn grown(mut head: &[u8]) -> Result<u64> {
    let mut next = || {
        head = head.strip_prefix(&[NEXT_NUMBER])?;
        number(&mut head).ok()?
    };
    // The kind comes first. The last bit is the sign.
    let size = next().and_then(|_kind| next()).map(|size| size >> 1);
    size.ok_or_else(|| ParquetError::General("a page without its sizes".into()))
}

/// A reader of such a file: the bytes that were examined, then the rest.
pub(super) struct Ended<T>(Chain<Cursor<Vec<u8>>, T>);

impl<R: Length> Length for Whole<R> {
    fn len(&self) -> u64 {
        self.file.len()
    }
}

impl<R: ChunkReader> ChunkReader for Whole<R> {
    type T = Ended<R::T>;

    fn get_read(&self, start: u64) -> Result<Self::T> {
        // All other reads of this kind are page headers, each followed by its page.
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
        // A page of the first kind, with 3000 bytes and with 2^31 - 1 bytes.
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
