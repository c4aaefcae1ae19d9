//! Pages of a column, checked for the properties which the parser assumes.

use parquet::basic::{Encoding, Type};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};
use parquet::schema::types::ColumnDescriptor;

use super::runs::{Endless, walk_differences, walk_runs};

/// An iterator over pages, each of which is checked.
pub(super) struct SoundPages {
    pages: Box<dyn PageReader>,
    has_dictionary: bool,
    /// Whether they contain texts instead of numbers.
    texts: bool,
    /// The bytes of a number, and the bits of a level, zero if values cannot be missing.
    number: usize,
    level: usize,
    /// The maximum number of values that the remaining pages may contain.
    left: u64,
}

/// The parts of a data page.
struct Parts<'p> {
    /// The definition levels, if they are encoded in runs.
    levels: Option<&'p [u8]>,
    values: &'p [u8],
}

impl SoundPages {
    pub(super) fn new(pages: Box<dyn PageReader>, column: &ColumnDescriptor, most: u64) -> Self {
        let number = match column.physical_type() {
            Type::INT32 | Type::FLOAT => 4,
            _ => 8,
        };
        let level = (16 - column.max_def_level().leading_zeros()) as usize;
        let texts = column.physical_type() == Type::BYTE_ARRAY;
        Self { pages, has_dictionary: false, texts, number, level, left: most }
    }

    /// The parts of a data page; `None` if its levels are longer than the page.
    fn parts<'p>(&self, page: &'p Page) -> Option<Parts<'p>> {
        let bytes = &page.buffer()[..];
        let (before, length, in_runs) = match page {
            Page::DataPageV2 { def_levels_byte_len, rep_levels_byte_len, .. } => (
                usize::try_from(*rep_levels_byte_len).ok()?,
                usize::try_from(*def_levels_byte_len).ok()?,
                self.level > 0,
            ),
            Page::DataPage { def_level_encoding: Encoding::RLE, .. } if self.level > 0 => {
                let said = u32::from_le_bytes(*bytes.first_chunk()?);
                (size_of_val(&said), usize::try_from(said).ok()?, true)
            }
            _ => (0, (usize::try_from(page.num_values()).ok()? * self.level).div_ceil(8), false),
        };
        let (levels, values) = bytes.get(before..)?.split_at_checked(length)?;
        Some(Parts { levels: in_runs.then_some(levels), values })
    }

    /// Checks the parts of a data page whose length follows from their own content.
    fn walk(&self, page: &Page, parts: &Parts<'_>) -> Result<(), Endless> {
        let count = usize::try_from(page.num_values()).unwrap_or(usize::MAX);
        if let Some(levels) = parts.levels {
            walk_runs(levels, self.level, count)?;
        }
        match (page.encoding(), parts.values) {
            (Encoding::DELTA_BINARY_PACKED, values) => walk_differences(values, count),
            (encoding, [bits, indices @ ..]) if is_of_dictionary(encoding) => {
                walk_runs(indices, (*bits).into(), count)
            }
            _ => Ok(()),
        }
    }

    /// Whether the `rest` of a page is long enough for the stated number of numbers.
    fn holds_its_numbers(&self, page: &Page, rest: &[u8]) -> bool {
        (rest.len() / self.number) as u64 >= u64::from(page.num_values())
    }

    fn refuse_unsound(&mut self, page: &Page) -> Result<()> {
        let damaged = |message: &str| Err(ParquetError::General(message.into()));
        let (few_texts, few_numbers) = (
            "a page with fewer strings than declared, or with an unknown encoding",
            "a page with fewer numbers than declared",
        );
        match page {
            Page::DictionaryPage { buf, .. } => {
                if self.texts && !holds_its_texts(page, buf) {
                    return damaged(few_texts);
                }
                if !self.texts && !self.holds_its_numbers(page, buf) {
                    return damaged(few_numbers);
                }
                self.has_dictionary = true;
                return Ok(());
            }
            Page::DataPage { def_level_encoding, rep_level_encoding, .. } => {
                #[expect(deprecated, reason = "old files have it")]
                let known =
                    |encoding: &Encoding| matches!(encoding, Encoding::RLE | Encoding::BIT_PACKED);
                if !(known(def_level_encoding) && known(rep_level_encoding)) {
                    return damaged("levels with an invalid encoding");
                }
            }
            Page::DataPageV2 { .. } => {}
        }
        let Some(parts) = self.parts(page) else {
            return damaged("levels that are longer than their page");
        };
        if self.walk(page, &parts).is_err() {
            return damaged("an unterminated number");
        }
        let by_dictionary = is_of_dictionary(page.encoding());
        if self.texts && !by_dictionary && !holds_its_texts(page, parts.values) {
            return damaged(few_texts);
        }
        let split = page.encoding() == Encoding::BYTE_STREAM_SPLIT;
        if split && !self.holds_its_numbers(page, parts.values) {
            return damaged(few_numbers);
        }
        if by_dictionary && !self.has_dictionary {
            return damaged("a page without its dictionary");
        }
        match self.left.checked_sub(page.num_values().into()) {
            Some(left) => self.left = left,
            None => return damaged("more values than are declared"),
        }
        Ok(())
    }
}

fn is_of_dictionary(encoding: Encoding) -> bool {
    matches!(encoding, Encoding::PLAIN_DICTIONARY | Encoding::RLE_DICTIONARY)
}

/// Whether the `rest` of a page contains the stated number of texts, each after its length.
fn holds_its_texts(page: &Page, mut rest: &[u8]) -> bool {
    matches!(page.encoding(), Encoding::PLAIN | Encoding::PLAIN_DICTIONARY)
        && (0..page.num_values()).all(|_| {
            let Some((length, after)) = rest.split_first_chunk() else { return false };
            let text = usize::try_from(u32::from_le_bytes(*length)).ok();
            let after = text.and_then(|length| after.get(length..));
            rest = after.unwrap_or_default();
            after.is_some()
        })
}

impl PageReader for SoundPages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.pages.get_next_page()?;
        if let Some(page) = &page {
            self.refuse_unsound(page)?;
        }
        Ok(page)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.pages.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.pages.skip_next_page()
    }

    fn at_record_boundary(&mut self) -> Result<bool> {
        self.pages.at_record_boundary()
    }
}

impl Iterator for SoundPages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}
