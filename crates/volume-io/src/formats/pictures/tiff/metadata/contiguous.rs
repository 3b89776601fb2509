//! Contiguous slices of which only the first has a page: `ImageJ` writes stacks over 4 GiB like this, and tifffile
//! when asked to truncate.

use super::super::file::TiffFile;
use super::super::file::directory::MAX_PAGES;
use super::super::file::page::{PartOffsets, TiffPage};
use super::super::messages::{HELP, unreadable_error};
use chiaroscuro_volume::{LoadContext, LoadError};

/// Creates the pages of `images` slices, the first of which is `page`.
///
/// # Errors
/// `BadInput` naming `field` where the file is too short for them.
pub(super) fn contiguous_pages(
    context: LoadContext<'_>,
    tiff: &mut TiffFile,
    page: &TiffPage,
    images: usize,
    field: &str,
) -> Result<Vec<TiffPage>, LoadError> {
    let broken = |why: String| context.bad_input_error(field, why, HELP);
    let offset = match page.offsets {
        PartOffsets::At(at) => at,
        PartOffsets::Listed(entry) => entry
            .first_integer(&mut tiff.bytes)
            .map_err(|error| unreadable_error(context, "first page", error))?,
    };
    let slice = page.bytes().ok_or_else(|| broken("the size of its slices is implausible".to_owned()))?;
    let end = slice.checked_mul(images as u64).and_then(|bytes| bytes.checked_add(offset));
    if images > MAX_PAGES || end.is_none_or(|end| end > tiff.bytes.len()) {
        return Err(broken(format!(
            "the data are truncated: {images} slices of {slice} bytes expected, {} bytes found",
            tiff.bytes.len().saturating_sub(offset)
        )));
    }
    let at = |image: usize| TiffPage {
        part_size: [page.width, page.height],
        offsets: PartOffsets::At(offset + image as u64 * slice),
        counts: None,
        ..*page
    };
    Ok((0..images).map(at).collect())
}
