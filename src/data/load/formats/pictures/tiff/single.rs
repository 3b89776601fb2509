//! TIFF file with a single slice, which is part of a numbered stack of files.

use super::file::Tiff;
use super::file::page::{Page, tag};
use super::plain::usable;
use super::said::ome;
use super::stack::{check_page_bytes, stored};
use crate::data::attempt::Attempt;
use crate::data::load::reading::input::Input;
use crate::data::load::reading::number::Stored;
use crate::data::load::reading::read_files::note;
use crate::data::load::{LoadControl, LoadError, LoadOptions};

/// Single page of a file, with the file.
pub(in crate::data::load) struct Picture {
    tiff: Tiff,
    page: Page,
    number: usize,
    /// Number of pages that could be slices.
    pub(in crate::data::load) pages: usize,
}

impl Picture {
    /// Reads the directories of a file.
    ///
    /// # Errors
    /// As the reader of whole volumes.
    pub(in crate::data::load) fn open(
        attempt: Attempt<'_>,
        control: &LoadControl,
    ) -> Result<Self, LoadError> {
        let tiff = Tiff::open(attempt, Input::open(attempt)?, control)?;
        let pages = usable(&tiff, &mut Vec::new());
        let Some(&number) = pages.first() else {
            return Err(attempt.bad_input("pages", "there is none", super::fault::HELP));
        };
        let page = tiff.pages[number];
        Ok(Self { tiff, page, number, pages: pages.len() })
    }

    /// True if its OME-XML describes how several files belong together, and names `file` or refers to the file that
    /// lists them.
    pub(in crate::data::load) fn names(&mut self, file: &str) -> bool {
        let description = self.tiff.text(tag::DESCRIPTION, ome::MOST_XML_BYTES).unwrap_or_default();
        ome::is_ome(&description) && (description.contains(file) || description.contains("<BinaryOnly"))
    }

    /// Width and height, in pixels.
    pub(in crate::data::load) fn size(&self) -> [u64; 2] {
        [self.page.width, self.page.height]
    }

    /// Storage of the samples after decoding.
    ///
    /// # Errors
    /// `BadInput` for unsupported encodings, `Limit` for a page over the budget.
    pub(in crate::data::load) fn stored(
        &self,
        attempt: Attempt<'_>,
        options: &LoadOptions,
    ) -> Result<Stored, LoadError> {
        check_page_bytes(attempt, &self.page, options)?;
        stored(attempt, &self.page, None, options)
    }

    /// Decodes the samples of the page.
    ///
    /// # Errors
    /// `BadInput` where the file is broken.
    pub(in crate::data::load) fn decode(
        mut self,
        attempt: Attempt<'_>,
        control: &LoadControl,
    ) -> Result<Vec<u8>, LoadError> {
        note(attempt.path);
        let packed = self.tiff.fetch(attempt, self.number, None, control)?;
        packed.unpack(attempt, self.number, control)
    }
}
