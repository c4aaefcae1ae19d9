//! Pages of a column, held against what the parser takes for granted of them.

use parquet::basic::{Encoding, Type};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};
use parquet::schema::types::ColumnDescriptor;

/// Pages of which each is what the parser relies upon.
pub(super) struct SoundPages {
    pages: Box<dyn PageReader>,
    has_dictionary: bool,
    /// Whether they hold texts and no numbers.
    texts: bool,
    /// The bytes of a number, and the bits of a level, none where nothing may be missing.
    number: usize,
    level: usize,
    /// The most values that all pages may hold.
    left: u64,
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

    /// How many bytes of a page its values take; `None` if its levels are longer than it is.
    fn of_values(&self, page: &Page) -> Option<usize> {
        let length = page.buffer().len();
        let levels = match page {
            Page::DataPageV2 { def_levels_byte_len, rep_levels_byte_len, .. } => {
                usize::try_from(u64::from(*def_levels_byte_len) + u64::from(*rep_levels_byte_len))
                    .ok()?
            }
            Page::DataPage { buf, def_level_encoding: Encoding::RLE, .. } if self.level > 0 => {
                let said = buf.get(..4)?.try_into().ok()?;
                usize::try_from(u32::from_le_bytes(said)).ok()?.checked_add(4)?
            }
            Page::DataPage { num_values, .. } => {
                (usize::try_from(*num_values).ok()? * self.level).div_ceil(8)
            }
            Page::DictionaryPage { .. } => 0,
        };
        length.checked_sub(levels)
    }

    /// Whether a page holds as many texts as it says, each behind its length.
    fn holds_its_texts(&self, page: &Page) -> bool {
        let Some(length) = self.of_values(page) else { return false };
        let mut rest = &page.buffer()[page.buffer().len() - length..];
        matches!(page.encoding(), Encoding::PLAIN | Encoding::PLAIN_DICTIONARY)
            && (0..page.num_values()).all(|_| {
                let Some((length, after)) = rest.split_first_chunk() else { return false };
                let text = usize::try_from(u32::from_le_bytes(*length)).ok();
                let after = text.and_then(|length| after.get(length..));
                rest = after.unwrap_or_default();
                after.is_some()
            })
    }

    fn refuse_unsound(&mut self, page: &Page) -> Result<()> {
        let damaged = |message: &str| Err(ParquetError::General(message.into()));
        let by_dictionary =
            matches!(page.encoding(), Encoding::PLAIN_DICTIONARY | Encoding::RLE_DICTIONARY);
        let is_dictionary = matches!(page, Page::DictionaryPage { .. });
        if self.texts && (is_dictionary || !by_dictionary) && !self.holds_its_texts(page) {
            return damaged("a page of fewer texts than it says, or of an unknown encoding");
        }
        match page {
            Page::DictionaryPage { .. } => {
                self.has_dictionary = true;
                return Ok(());
            }
            Page::DataPage { def_level_encoding, rep_level_encoding, .. } => {
                #[expect(deprecated, reason = "old files have it")]
                let known =
                    |encoding: &Encoding| matches!(encoding, Encoding::RLE | Encoding::BIT_PACKED);
                if !(known(def_level_encoding) && known(rep_level_encoding)) {
                    return damaged("levels of an encoding that levels do not have");
                }
            }
            Page::DataPageV2 { buf, def_levels_byte_len, rep_levels_byte_len, .. } => {
                let levels = u64::from(*def_levels_byte_len) + u64::from(*rep_levels_byte_len);
                if levels > buf.len() as u64 {
                    return damaged("levels that are longer than their page");
                }
            }
        }
        if page.encoding() == Encoding::BYTE_STREAM_SPLIT {
            let room = self.of_values(page).map_or(0, |length| length / self.number);
            if (room as u64) < u64::from(page.num_values()) {
                return damaged("a page of fewer numbers than it says");
            }
        }
        if by_dictionary && !self.has_dictionary {
            return damaged("a page of a dictionary that is not there");
        }
        match self.left.checked_sub(page.num_values().into()) {
            Some(left) => self.left = left,
            None => return damaged("more values than are declared"),
        }
        Ok(())
    }
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
