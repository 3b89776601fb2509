//! Metadata that tifffile and programs based on it (napari, scikit-image) write: the shape of an array, possibly with
//! a letter for each axis. A file may hold several arrays, each with the shape on its first page.
//!
//! After tifffile's own reader (`TiffFile._series_shaped`, <https://github.com/cgohlke/tifffile>).

mod axes;
mod json;

use super::super::file::TiffFile;
use super::super::file::page::{SampleMeaning, TiffPage};
use super::super::messages::HELP;
use super::super::stack::{TiffSlice, TiffStack};
use super::contiguous::contiguous_pages;
use super::spacing::placement_from_resolution;
use crate::formats::pictures::channels_and_times::ChannelsAndTimes;
use crate::formats::pictures::gaps::{ANNOUNCED_PAGES, SliceRun};
use crate::reading::input::stem;
use axes::{PageAxes, PageStride};
use chiaroscuro_volume::{FileDimension, LoadContext, LoadError, ValueMetadata, VolumeChoice, VolumeOffer};
use json::{MAX_BYTES, ShapeDescription};

/// Maximum number of series that a file may offer: more than can be chosen from a list.
const MAX_SERIES: usize = 1 << 16;

/// Array of pages in a file.
struct ShapedArray {
    description: ShapeDescription,
    axes: PageAxes,
    /// Index of its first page.
    first: usize,
    /// Number of its pages that exist.
    pages: usize,
}

/// Arrays of a file; empty where pages have no such description, or where it adds nothing because each page is an
/// array.
fn arrays(tiff: &mut TiffFile, remarks: &mut Vec<String>) -> Vec<ShapedArray> {
    let mut arrays: Vec<ShapedArray> = Vec::new();
    let mut first = 0;
    while first < tiff.pages.len() {
        let page = tiff.pages[first];
        let texts = page.descriptions.into_iter().flatten();
        let words =
            texts.into_iter().find_map(|entry| ShapeDescription::parse(&tiff.text_of(entry, MAX_BYTES)?));
        let found = words.and_then(|words| {
            let axes = PageAxes::new(&words.shape, words.axes.as_deref().unwrap_or_default(), &page)?;
            Some((words, axes))
        });
        let Some((words, axes)) = found else {
            if !arrays.is_empty() {
                let count = tiff.pages.len() - first;
                remarks.push(format!(
                    "the last {count} pages are left out: they belong to no array that is described"
                ));
            }
            break;
        };
        let is_like = |other: &TiffPage| other.matches(&page) && other.descriptions == [None; 2];
        // A page that begins an array of its own ends this one, whatever its shape announces.
        let others = tiff.pages[first + 1..].iter().take(axes.pages - 1);
        let pages = if words.truncated { 1 } else { 1 + others.take_while(|other| is_like(other)).count() };
        arrays.push(ShapedArray { description: words, axes, first, pages });
        first += pages;
    }
    // Pages that were written one by one are slices, as pages without descriptions are.
    if arrays.iter().all(|array| array.axes.pages == 1) { Vec::new() } else { arrays }
}

/// Stack of a file with array shapes; `None` where they add nothing to plain pages.
pub(crate) fn stack_of_shapes(
    context: LoadContext<'_>,
    tiff: &mut TiffFile,
    choice: &VolumeChoice,
) -> Result<Option<TiffStack>, LoadError> {
    let mut remarks = Vec::new();
    let mut arrays = arrays(tiff, &mut remarks);
    if arrays.is_empty() {
        return Ok(None);
    }
    let [at, series] = chosen_array(context, tiff, &arrays, choice)?;
    let ShapedArray { description: words, axes, first, pages } = arrays.swap_remove(at);
    let page = tiff.pages[first];
    // One page stands for all, whose data are contiguous.
    let follow = (pages == 1 && axes.pages > 1 && page.is_plain_rows())
        .then(|| contiguous_pages(context, tiff, &page, axes.pages, "shape"));
    let (first, pages) = match follow {
        Some(Ok(all)) => {
            let first = tiff.pages.len();
            tiff.pages.extend(all);
            (first, axes.pages)
        }
        Some(Err(error)) if words.truncated => return Err(error),
        // A recording that was stopped has only one page.
        _ => (first, pages),
    };
    let inside = if page.meaning == SampleMeaning::Channels { page.samples } else { 1 };
    let of_series = axes.series_page(series);
    let size = |stride: Option<PageStride>| stride.map_or(1, |stride| stride.size);
    // Of an interrupted recording only the steps that have at least one page.
    let begun = |stride: Option<PageStride>, what: &str, remarks: &mut Vec<String>| {
        let Some(stride) = stride else { return 1 };
        let begun = stride.size.min(pages.saturating_sub(of_series + 1) / stride.pages + 1);
        if begun < stride.size {
            remarks.push(format!(
                "{} {what} are announced, and there are pages for the first {begun}",
                stride.size
            ));
        }
        begun
    };
    let slices = size(axes.slices);
    let channels = begun(axes.channels, "channels", &mut remarks);
    let frames = begun(axes.frames, "time steps", &mut remarks);
    let steps = ChannelsAndTimes {
        dims: [page.width, page.height, slices as u64],
        channels: channels.saturating_mul(inside),
        channel_names: words.channel_names(size(axes.channels).saturating_mul(inside)),
        channel_colors: Vec::new(),
        frames,
        frame_names: Vec::new(),
    };
    let chosen = steps.choose(context, choice)?;
    let step = |stride: Option<PageStride>, at: usize| stride.map_or(0, |stride| stride.pages * at);
    let wanted = chosen.slices(slices, frames).into_iter().map(|[frame, slice]| {
        let channel = step(axes.channels, chosen.channel / inside);
        let page = of_series + channel + step(axes.frames, frame) + step(axes.slices, slice);
        (page < pages).then_some(TiffSlice { file: 0, page: first + page })
    });
    let Some(SliceRun { slices, remark }) = SliceRun::new(&wanted.collect::<Vec<_>>(), ANNOUNCED_PAGES)
    else {
        let why = format!(
            "{} pages are announced, and {pages} exist: none for the chosen channel and time step",
            axes.pages
        );
        return Err(context.bad_input_error("shape", why, HELP));
    };
    let mut placement = placement_from_resolution(tiff, words.unit.as_deref(), words.spacing);
    if axes.is_assumed {
        remarks
            .push("the axes of its pages are not stated: they are taken as time, channel and z".to_owned());
    }
    remarks.extend(remark);
    placement.remarks.splice(0..0, remarks);
    chosen.add_time_remark(&mut placement);
    Ok(Some(TiffStack {
        name: stem(context.path),
        slices,
        other_files: Vec::new(),
        sample: (inside > 1).then_some(chosen.channel % inside),
        placement,
        hints: ValueMetadata::default(),
        scale: [1.0, 0.0],
    }))
}

/// Index of the chosen array, and index of the series in it.
fn chosen_array(
    context: LoadContext<'_>,
    tiff: &TiffFile,
    arrays: &[ShapedArray],
    choice: &VolumeChoice,
) -> Result<[usize; 2], LoadError> {
    let counts: Vec<usize> = arrays.iter().map(|array| array.axes.series_count()).collect();
    let all = counts.iter().fold(0usize, |all, &count| all.saturating_add(count));
    if all > MAX_SERIES {
        let why = format!("it holds {all} series, {MAX_SERIES} are allowed");
        return Err(context.limit_error("shape", why, "write fewer into one file"));
    }
    let mut offers = Vec::new();
    for (array, &count) in arrays.iter().zip(&counts) {
        let page = tiff.pages[array.first];
        let slices = array.axes.slices.map_or(1, |stride| stride.size as u64);
        let dims = [page.width, page.height, slices];
        let name = array.description.name.as_deref().unwrap_or_default();
        for _ in 0..count {
            offers.push(VolumeOffer::with_number(offers.len(), name, dims));
        }
    }
    let mut series = context.resolve_choice(choice, FileDimension::Series, offers)?;
    for (at, &count) in counts.iter().enumerate() {
        if series < count {
            return Ok([at, series]);
        }
        series -= count;
    }
    Ok([0, 0])
}
