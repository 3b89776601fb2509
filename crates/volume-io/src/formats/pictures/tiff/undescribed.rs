//! TIFF files without further metadata: all pages that match the first one are slices, in file order.

use super::file::TiffFile;
use super::file::page::SampleMeaning;
use super::stack::{ChannelsAndTimes, TiffSlice, TiffStack};
use crate::reading::input::stem;
use crate::reading::placement::GridPlacement;
use chiaroscuro_volume::{LoadContext, LoadError, ValueMetadata, VolumeChoice};

/// Indices of the pages that are slices: those that match the first page that is not a thumbnail or mask. Adds
/// remarks on the pages that are left out.
pub(super) fn usable_pages(tiff: &TiffFile, remarks: &mut Vec<String>) -> Vec<usize> {
    let pages = &tiff.pages;
    let all_aside = pages.iter().all(|page| page.is_auxiliary);
    let is_meant = |page: usize| all_aside || !pages[page].is_auxiliary;
    let Some(first) = (0..pages.len()).find(|&page| is_meant(page)) else { return Vec::new() };
    let (meant, aside): (Vec<usize>, Vec<usize>) = (0..pages.len()).partition(|&page| is_meant(page));
    let (like, unlike): (Vec<usize>, Vec<usize>) =
        meant.into_iter().partition(|&page| pages[page].matches(&pages[first]));
    for (left_out, why) in [
        (aside, "are left out: they are masks or smaller versions of others"),
        (unlike, "are left out: their size or sample type differs from the first"),
    ] {
        if !left_out.is_empty() {
            remarks.push(format!("{} of {} pages {why}", left_out.len(), pages.len()));
        }
    }
    like
}

/// Builds the stack of a file without further metadata.
pub(super) fn stack_of_pages(
    attempt: LoadContext<'_>,
    tiff: &TiffFile,
    choice: &VolumeChoice,
) -> Result<TiffStack, LoadError> {
    let mut placement = GridPlacement::unknown();
    let pages = usable_pages(tiff, &mut placement.remarks);
    let Some(first) = pages.first().map(|&page| tiff.pages[page]) else {
        return Err(attempt.bad_input_error("pages", "it has no usable page", super::messages::HELP));
    };
    let is_channels = first.meaning == SampleMeaning::Channels;
    let steps = ChannelsAndTimes {
        dims: [first.width, first.height, pages.len() as u64],
        channels: if is_channels { first.samples } else { 1 },
        channel_names: Vec::new(),
        frames: 1,
    };
    let chosen = steps.choose(attempt, choice)?;
    Ok(TiffStack {
        name: stem(attempt.path),
        slices: pages.into_iter().map(|page| Some(TiffSlice { file: 0, page })).collect(),
        other_files: Vec::new(),
        sample: is_channels.then_some(chosen.channel),
        placement,
        hints: ValueMetadata::default(),
        scale: [1.0, 0.0],
    })
}
