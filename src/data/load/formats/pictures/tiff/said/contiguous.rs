//! Contiguous slices of which only the first has a page: `ImageJ` writes stacks over 4 GiB like this, and tifffile
//! when asked to truncate.

use super::super::fault::{HELP, unreadable};
use super::super::file::Tiff;
use super::super::file::directory::MOST_PAGES;
use super::super::file::page::{Offsets, Page};
use crate::data::attempt::Attempt;
use crate::data::load::LoadError;

/// Creates the pages of `images` slices, the first of which is `page`.
///
/// # Errors
/// `BadInput` naming `field` where the file is too short for them.
pub(super) fn contiguous(
    attempt: Attempt<'_>,
    tiff: &mut Tiff,
    page: &Page,
    images: usize,
    field: &str,
) -> Result<Vec<Page>, LoadError> {
    let broken = |why: String| attempt.bad_input(field, why, HELP);
    let offset = match page.offsets {
        Offsets::At(at) => at,
        Offsets::Listed(entry) => {
            entry.whole(&mut tiff.bytes).map_err(|error| unreadable(attempt, "first page", error))?
        }
    };
    let slice = page.bytes().ok_or_else(|| broken("its slices cannot be so large".to_owned()))?;
    let end = slice.checked_mul(images as u64).and_then(|bytes| bytes.checked_add(offset));
    if images > MOST_PAGES || end.is_none_or(|end| end > tiff.bytes.len()) {
        return Err(broken(format!(
            "the data are truncated: {images} slices of {slice} bytes expected, {} bytes found",
            tiff.bytes.len().saturating_sub(offset)
        )));
    }
    let at = |image: usize| Page {
        part: [page.width, page.height],
        offsets: Offsets::At(offset + image as u64 * slice),
        counts: None,
        ..*page
    };
    Ok((0..images).map(at).collect())
}
