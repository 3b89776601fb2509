//! TIFF files without further metadata: all pages that match the first one are slices, in file order.

use super::file::Tiff;
use super::file::page::Meaning;
use super::stack::{Slice, Stack, Steps};
use crate::data::Hints;
use crate::data::attempt::Attempt;
use crate::data::load::reading::input::stem;
use crate::data::load::reading::placement::Placement;
use crate::data::load::{Choice, LoadError};

/// Indices of the pages that are slices: those that match the first page that is not a thumbnail or mask. Adds
/// remarks on the pages that are left out.
pub(super) fn usable(tiff: &Tiff, remarks: &mut Vec<String>) -> Vec<usize> {
    let pages = &tiff.pages;
    let all_aside = pages.iter().all(|page| page.is_aside);
    let is_meant = |page: usize| all_aside || !pages[page].is_aside;
    let Some(first) = (0..pages.len()).find(|&page| is_meant(page)) else { return Vec::new() };
    let (meant, aside): (Vec<usize>, Vec<usize>) = (0..pages.len()).partition(|&page| is_meant(page));
    let (like, unlike): (Vec<usize>, Vec<usize>) =
        meant.into_iter().partition(|&page| pages[page].is_like(&pages[first]));
    for (left_out, why) in [
        (aside, "are left out: they are masks or smaller versions of others"),
        (unlike, "are left out: their size or number type is not that of the first"),
    ] {
        if !left_out.is_empty() {
            remarks.push(format!("{} of {} pages {why}", left_out.len(), pages.len()));
        }
    }
    like
}

/// Builds the stack of a file without further metadata.
pub(super) fn stack(attempt: Attempt<'_>, tiff: &Tiff, choice: &Choice) -> Result<Stack, LoadError> {
    let mut placement = Placement::unknown();
    let pages = usable(tiff, &mut placement.remarks);
    let Some(first) = pages.first().map(|&page| tiff.pages[page]) else {
        return Err(attempt.bad_input("pages", "there is none", super::fault::HELP));
    };
    let is_channels = first.meaning == Meaning::Channels;
    let steps = Steps {
        dims: [first.width, first.height, pages.len() as u64],
        channels: if is_channels { first.samples } else { 1 },
        channel_names: Vec::new(),
        frames: 1,
    };
    let chosen = steps.chosen(attempt, choice)?;
    Ok(Stack {
        name: stem(attempt.path),
        slices: pages.into_iter().map(|page| Some(Slice { file: 0, page })).collect(),
        beside: Vec::new(),
        sample: is_channels.then_some(chosen.channel),
        placement,
        hints: Hints::default(),
        scale: [1.0, 0.0],
    })
}
