//! Pages of a column, held against what the parser takes for granted of them.

use parquet::basic::Encoding;
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};

/// Pages of which each is what the parser relies upon.
pub(super) struct SoundPages {
    pages: Box<dyn PageReader>,
    has_dictionary: bool,
    /// The most values that all pages may hold.
    left: u64,
}

impl SoundPages {
    pub(super) fn new(pages: Box<dyn PageReader>, most: u64) -> Self {
        Self { pages, has_dictionary: false, left: most }
    }

    fn refuse_unsound(&mut self, page: &Page) -> Result<()> {
        let damaged = |message: &str| Err(ParquetError::General(message.into()));
        let by_dictionary =
            matches!(page.encoding(), Encoding::PLAIN_DICTIONARY | Encoding::RLE_DICTIONARY);
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
