//! The elements of a MATLAB level 5 file: a tag with kind and length, then bytes.

use std::io::{self, Read};

use crate::log::table::typed::Numbers;

/// The maximum number of bytes of a name, a list of dimensions or a list of names.
const LONGEST: u64 = 1 << 16;

/// The number of bytes of numbers that are read at once.
const BATCH: u64 = 1 << 16;

/// The tag before an element's bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tag {
    pub(super) kind: u32,
    /// The number of bytes that follow.
    pub(super) length: u64,
    /// The bytes of a short element, which are part of the tag and must not be read again.
    short: Option<[u8; 4]>,
}

/// Consecutive elements.
pub(super) struct Elements<'r> {
    reader: &'r mut dyn Read,
    big: bool,
    position: u64,
}

impl<'r> Elements<'r> {
    pub(super) fn new(reader: &'r mut dyn Read, big: bool) -> Self {
        Self { reader, big, position: 0 }
    }

    /// The number of bytes read so far.
    pub(super) fn position(&self) -> u64 {
        self.position
    }

    /// The next tag; `None` at the end.
    pub(super) fn tag(&mut self) -> io::Result<Option<Tag>> {
        let mut bytes = [0; 8];
        let mut filled = 0;
        while filled < 8 {
            match self.reader.read(&mut bytes[filled..]) {
                Ok(0) if filled == 0 => return Ok(None),
                Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
                Ok(read) => filled += read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        self.position += 8;
        let [a, b, c, d, rest @ ..] = bytes;
        let first = self.whole([a, b, c, d]);
        // A short element has its length in the upper half of the first word.
        Ok(Some(match first >> 16 {
            0 => Tag { kind: first, length: self.whole(rest).into(), short: None },
            length => {
                let length = u64::from(length).min(4);
                Tag { kind: first & 0xffff, length, short: Some(rest) }
            }
        }))
    }

    fn whole(&self, bytes: [u8; 4]) -> u32 {
        if self.big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }

    pub(super) fn skip(&mut self, length: u64) -> io::Result<()> {
        let skipped = io::copy(&mut (&mut *self.reader).take(length), &mut io::sink())?;
        self.position += skipped;
        if skipped == length { Ok(()) } else { Err(io::ErrorKind::UnexpectedEof.into()) }
    }

    /// A reader of the next `length` bytes.
    pub(super) fn limited(&mut self, length: u64) -> io::Take<&mut (dyn Read + 'r)> {
        self.position += length;
        (&mut *self.reader).take(length)
    }

    /// The bytes of the next element, of at most [`LONGEST`].
    fn bytes(&mut self) -> io::Result<Vec<u8>> {
        let tag = self.tag()?.ok_or(io::ErrorKind::UnexpectedEof)?;
        if let Some(short) = tag.short {
            return Ok(short[..usize::try_from(tag.length).unwrap_or(4)].to_vec());
        }
        if tag.length > LONGEST {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a name is too long"));
        }
        let mut bytes = Vec::new();
        self.position += tag.length;
        (&mut *self.reader).take(tag.length).read_to_end(&mut bytes)?;
        if (bytes.len() as u64) < tag.length {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        self.skip((8 - tag.length % 8) % 8)?;
        Ok(bytes)
    }

    fn words(&mut self) -> io::Result<Vec<u32>> {
        let bytes = self.bytes()?;
        let word = |bytes: &[u8]| self.whole([bytes[0], bytes[1], bytes[2], bytes[3]]);
        Ok(bytes.chunks_exact(4).map(word).collect())
    }

    fn text(&mut self) -> io::Result<String> {
        let bytes = self.bytes()?;
        Ok(String::from_utf8_lossy(&bytes).trim_end_matches('\0').to_string())
    }

    /// The kind of the numbers of a matrix of this size; `None` if their count differs.
    pub(super) fn data(&mut self, rows: u64, columns: u64) -> io::Result<Option<Data>> {
        let tag = self.tag()?.ok_or(io::ErrorKind::UnexpectedEof)?;
        let (size, whole) = match tag.kind {
            1 | 2 => (1, false),
            3 | 4 => (2, false),
            5..=7 => (4, false),
            9 => (8, false),
            12 | 13 => (8, true),
            _ => return Ok(None),
        };
        let count = rows.checked_mul(columns).and_then(|count| count.checked_mul(size));
        let fits = count == Some(tag.length);
        // A short element has at most two numbers, which is not a log.
        Ok((fits && tag.short.is_none()).then_some(Data { kind: tag.kind, size, whole }))
    }

    /// The next `rows` numbers.
    pub(super) fn column(&mut self, data: &Data, rows: u64) -> io::Result<Numbers> {
        let mut real = Vec::new();
        let mut whole = Vec::new();
        let mut left = rows * data.size;
        let mut buffer = Vec::new();
        while left > 0 {
            buffer.clear();
            let wanted = left.min(BATCH);
            let read = (&mut *self.reader).take(wanted).read_to_end(&mut buffer)? as u64;
            self.position += read;
            if read < wanted {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            left -= wanted;
            for bytes in buffer.chunks_exact(usize::try_from(data.size).unwrap_or(8)) {
                let mut eight = [0; 8];
                if self.big {
                    eight[8 - bytes.len()..].copy_from_slice(bytes);
                } else {
                    eight[..bytes.len()].copy_from_slice(bytes);
                }
                let bits =
                    if self.big { u64::from_be_bytes(eight) } else { u64::from_le_bytes(eight) };
                if data.whole {
                    let number = match data.kind {
                        12 => Some(bits.cast_signed()),
                        _ => i64::try_from(bits).ok(),
                    };
                    let too_large =
                        || io::Error::new(io::ErrorKind::InvalidData, "a number is too large");
                    whole.push(number.ok_or_else(too_large)?);
                } else {
                    real.push(number(data.kind, bits));
                }
            }
        }
        Ok(if data.whole { Numbers::Whole(whole) } else { Numbers::Real(real) })
    }
}

/// The number in the lowest of these bits.
#[expect(clippy::cast_possible_truncation, reason = "the upper bits are not the number's")]
fn number(kind: u32, bits: u64) -> f64 {
    match kind {
        1 => f64::from((bits as u8).cast_signed()),
        2 => f64::from(bits as u8),
        3 => f64::from((bits as u16).cast_signed()),
        4 => f64::from(bits as u16),
        5 => f64::from((bits as u32).cast_signed()),
        6 => f64::from(bits as u32),
        7 => f64::from(f32::from_bits(bits as u32)),
        _ => f64::from_bits(bits),
    }
}

/// The representation of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Data {
    kind: u32,
    /// Bytes per number.
    pub(super) size: u64,
    /// Whether they are 64-bit integers, which a double may not represent.
    whole: bool,
}

/// The header of a matrix.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Matrix {
    class: u32,
    pub(super) is_complex: bool,
    pub(super) dimensions: Vec<u64>,
    pub(super) name: String,
}

impl Matrix {
    pub(super) fn read(elements: &mut Elements<'_>) -> io::Result<Self> {
        let flags = elements.words()?.first().copied().unwrap_or_default();
        let dimensions = elements.words()?.into_iter().map(u64::from).collect();
        let name = elements.text()?;
        Ok(Self { class: flags & 0xff, is_complex: flags & 0x0800 != 0, dimensions, name })
    }

    pub(super) fn is_numeric(&self) -> bool {
        (6..=15).contains(&self.class)
    }

    pub(super) fn is_one_structure(&self) -> bool {
        self.class == 2 && self.dimensions.iter().all(|&length| length == 1)
    }

    /// The names of a structure's fields.
    pub(super) fn fields(elements: &mut Elements<'_>) -> io::Result<Vec<String>> {
        let length = elements.words()?.first().copied().unwrap_or_default();
        let length = usize::try_from(length).unwrap_or_default().max(1);
        let bytes = elements.bytes()?;
        let name = |bytes: &[u8]| {
            let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
            String::from_utf8_lossy(&bytes[..end]).into_owned()
        };
        Ok(bytes.chunks_exact(length).map(name).collect())
    }
}
