//! TIFF file with a single slice, which is part of a numbered stack of files.

use super::file::TiffFile;
use super::file::page::{TiffPage, tag};
use super::metadata::ome;
use super::stack::{check_page_bytes, page_encoding};
use super::undescribed::UsablePages;
use crate::LoadOptions;
use crate::reading::input::InputFile;
use crate::reading::number::VoxelEncoding;
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError};

/// Single page of a file, with the file.
pub(crate) struct SingleSlice {
    tiff: TiffFile,
    page: TiffPage,
    number: usize,
    /// Number of pages that could be slices.
    pub(crate) pages: usize,
}

impl SingleSlice {
    /// Reads the directories of a file.
    ///
    /// # Errors
    /// As the reader of whole volumes.
    pub(crate) fn open(context: LoadContext<'_>, control: &LoadControl) -> Result<Self, LoadError> {
        let tiff = TiffFile::open(context, InputFile::open(context)?, control)?;
        let UsablePages { pages, .. } = UsablePages::new(&tiff);
        let Some(&number) = pages.first() else {
            return Err(context.bad_input_error("pages", "it has no usable page", super::messages::HELP));
        };
        let page = tiff.pages[number];
        Ok(Self { tiff, page, number, pages: pages.len() })
    }

    /// True if its OME-XML describes how several files belong together, and names `file` or refers to the file that
    /// lists them.
    pub(crate) fn describes_set_with(&mut self, file: &str) -> bool {
        let description = self.tiff.text_entry(tag::DESCRIPTION, ome::MAX_XML_BYTES).unwrap_or_default();
        ome::is_ome(&description) && (description.contains(file) || description.contains("<BinaryOnly"))
    }

    /// Width and height, in pixels.
    pub(crate) fn size(&self) -> [u64; 2] {
        [self.page.width, self.page.height]
    }

    /// Storage of the samples after decoding.
    ///
    /// # Errors
    /// `BadInput` for unsupported encodings, `Limit` for a page over the budget.
    pub(crate) fn stored(
        &self,
        context: LoadContext<'_>,
        options: &LoadOptions,
    ) -> Result<VoxelEncoding, LoadError> {
        check_page_bytes(context, &self.page, options)?;
        page_encoding(context, &self.page, None, options)
    }

    /// Decodes the samples of the page.
    ///
    /// # Errors
    /// `BadInput` where the file is broken.
    pub(crate) fn decode(
        mut self,
        context: LoadContext<'_>,
        control: &LoadControl,
    ) -> Result<Vec<u8>, LoadError> {
        control.record_read(context.path);
        let packed = self.tiff.fetch(context, self.number, None, control)?;
        packed.unpack(context, self.number, control)
    }
}
