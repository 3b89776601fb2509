//! Slices of a TIFF volume, as pages of one or several files, and reading of their voxels.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::file::page::{SampleMeaning, TiffPage};
use super::file::{TiffFile, alloc_zeroed_bytes};
use super::messages::HELP;
use crate::formats::pictures::slice_reader::read_slices;
use crate::reading::input::{FileChangeGuard, InputFile};
use crate::reading::number::{ScalarReduction, VoxelEncoding};
use crate::reading::placement::{GridPlacement, VolumeParts};
use crate::reading::rescale::rescale;
use crate::reading::voxels::ValueMapping;
use crate::{Endian, LoadOptions};
use chiaroscuro_volume::{GridExtent, LoadContext, LoadControl, LoadError, ValueMetadata, Volume};

/// Bytes of compressed pages that are read before they are decoded. Compressed pages are longer than their pixels
/// only by mistake, or where many pages share the same bytes.
const PACKED_BYTES: u64 = 32 << 20;

/// Page of one of several files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TiffSlice {
    /// Index of the file: 0 is the opened one, others are those of [`TiffStack::other_files`] plus 1.
    pub(super) file: usize,
    pub(super) page: usize,
}

/// Volume before its voxels are read.
pub(super) struct TiffStack {
    pub(super) name: String,
    /// Slices in order; those without a page are empty.
    pub(super) slices: Vec<Option<TiffSlice>>,
    /// Files besides the opened one.
    pub(super) other_files: Vec<PathBuf>,
    /// Index of the chosen sample, where the samples of a page are channels.
    pub(super) sample: Option<usize>,
    pub(super) placement: GridPlacement,
    pub(super) hints: ValueMetadata,
    /// Slope and intercept of the values.
    pub(super) scale: [f64; 2],
}

/// Files of a stack: the first, and one of the others open at a time.
struct TiffStackFiles<'a> {
    context: LoadContext<'a>,
    first: TiffFile,
    beside: &'a [PathBuf],
    open: Option<(usize, TiffFile, FileChangeGuard)>,
    control: &'a LoadControl,
}

impl TiffStackFiles<'_> {
    /// Opens the file of this number, unless it is open, and calls a function with it; fails if the file changes
    /// meanwhile.
    fn with<T>(
        &mut self,
        number: usize,
        what: impl FnOnce(LoadContext<'_>, &mut TiffFile) -> Result<T, LoadError>,
    ) -> Result<T, LoadError> {
        let Some(at) = number.checked_sub(1) else { return what(self.context, &mut self.first) };
        let path: &Path = self.beside.get(at).map_or(self.context.path, PathBuf::as_path);
        let context = LoadContext { operation: self.context.operation, path };
        let (tiff, guard) = match self.open.take() {
            Some((open, tiff, guard)) if open == number => (tiff, guard),
            _ => {
                let input = InputFile::open(context)?;
                let guard = FileChangeGuard::new(context, &input, self.control)?;
                (TiffFile::open(context, input, self.control)?, guard)
            }
        };
        let (_, tiff, guard) = self.open.insert((number, tiff, guard));
        let done = what(context, tiff);
        guard.check_unchanged(context, done)
    }
}

impl TiffStack {
    /// Reads the voxels and assembles the volume.
    ///
    /// # Errors
    /// `BadInput` where pages are broken, missing, or differ; `Limit` over the budget.
    pub(super) fn into_volume(
        self,
        context: LoadContext<'_>,
        tiff: TiffFile,
        options: &LoadOptions,
        control: &LoadControl,
    ) -> Result<Volume, LoadError> {
        let Self {
            name,
            slices,
            other_files: beside,
            sample,
            mut placement,
            mut hints,
            scale: [slope, intercept],
        } = self;
        let mut files = TiffStackFiles { context, first: tiff, beside: &beside, open: None, control };
        let Some(&first) = slices.iter().flatten().next() else {
            return Err(context.bad_input_error("pages", "it has no pages", HELP));
        };
        let model = files.with(first.file, |context, tiff| page_of(context, tiff, first.page))?;
        let sample = sample.or_else(|| chosen_sample(&model, options));
        let stored = page_encoding(context, &model, sample, options)?;
        let dims = [model.width, model.height, slices.len() as u64];
        let extent =
            GridExtent::checked(context, "pages", dims, stored.voxel_type(), options.limits(control))?;
        check_page_bytes(context, &model, options)?;
        placement.remarks.extend(stored.reduction.remark().map(str::to_owned));
        // Inversion is a property of display: the stored values are the measurements, or those of the mask.
        if model.is_inverted {
            let remark = "0 stands for white (WhiteIsZero): values are shown as stored";
            placement.remarks.push(remark.to_owned());
        }
        // The first page is checked before memory is allocated for all, in case that it lacks the announced data.
        files.with(first.file, |context, tiff| {
            tiff.check_parts(context, first.page, sample.filter(|_| model.is_planar), control)
        })?;
        let values = |samples| rescale(context, samples, [slope, intercept], options.memory_budget_bytes);
        let empty_bytes = model.width.saturating_mul(model.height).saturating_mul(stored.voxel_bytes());
        let meant = ValueMapping { padding: hints.padding, map: &values };
        let voxels = read_slices(context, &stored, extent, &meant, control, |some| {
            let mut unpacked = Vec::new();
            let mut slices = some.iter().map(|&slice| &slices[slice]).peekable();
            while slices.peek().is_some() {
                let (mut packed, mut bytes) = (Vec::new(), 0);
                while let Some(&slice) = slices.next_if(|_| bytes < PACKED_BYTES) {
                    let Some(TiffSlice { file, page }) = slice else {
                        packed.push(None);
                        continue;
                    };
                    let of_page = files.with(file, |context, tiff| {
                        let found = page_of(context, tiff, page)?;
                        if !found.matches(&model) {
                            return Err(mismatch_error(context, page, &found, &model));
                        }
                        // Interleaved samples are all read, and one is selected later.
                        tiff.fetch(context, page, sample.filter(|_| found.is_planar), control)
                    })?;
                    bytes += of_page.len();
                    packed.push(Some((page, of_page)));
                }
                let of_slices = packed.par_iter().map(|packed| match packed {
                    Some((page, packed)) => packed.unpack(context, *page, control),
                    None => alloc_zeroed_bytes(context, "pages", empty_bytes),
                });
                unpacked.extend(of_slices.collect::<Result<Vec<_>, _>>()?);
            }
            Ok(unpacked)
        })?;
        if let Some([low, high]) = hints.window.take() {
            hints.set_window(low.mul_add(slope, intercept), high.mul_add(slope, intercept));
        }
        VolumeParts { name, extent, placement, voxels, hints }.into_volume(context, control)
    }
}

fn page_of(context: LoadContext<'_>, tiff: &TiffFile, number: usize) -> Result<TiffPage, LoadError> {
    let count = tiff.pages.len();
    tiff.pages.get(number).copied().ok_or_else(|| {
        let field = format!("page {number}");
        context.bad_input_error(&field, format!("the file has only {count} pages"), HELP)
    })
}

/// Component that the user has chosen; channels are chosen as layers.
fn chosen_component(page: &TiffPage, options: &LoadOptions) -> Option<usize> {
    match page.meaning {
        SampleMeaning::Channels => options.choice.resolve_layer(page.samples),
        _ => options.choice.resolve_component(page.samples, true),
    }
}

/// Sample that is read alone, where the user has chosen a component.
fn chosen_sample(page: &TiffPage, options: &LoadOptions) -> Option<usize> {
    chosen_component(page, options).filter(|_| page.meaning != SampleMeaning::Channels)
}

/// Storage of the samples of decoded pages.
///
/// # Errors
/// `BadInput` for unsupported encodings, and for a component that does not exist.
pub(super) fn page_encoding(
    context: LoadContext<'_>,
    page: &TiffPage,
    sample: Option<usize>,
    options: &LoadOptions,
) -> Result<VoxelEncoding, LoadError> {
    page.check_supported(context, "first page")?;
    let Some(number) = page.number() else {
        return Err(context.bad_input_error("first page", "its sample type is not supported", HELP));
    };
    let component = sample.or(chosen_component(page, options)).or(match page.meaning {
        SampleMeaning::Channels => Some(0),
        _ => None,
    });
    let is_color = page.meaning != SampleMeaning::Channels;
    let part = ScalarReduction::require(context, component, page.samples, is_color)?;
    // A sample in strips of its own is read alone.
    let is_alone = page.is_planar && sample.is_some();
    let (components, part) = if is_alone { (1, ScalarReduction::Component(0)) } else { (page.samples, part) };
    Ok(VoxelEncoding { number, endian: Endian::Little, components, reduction: part })
}

/// Checks that a decoded page fits into the budget, since pages are decoded as a whole.
pub(super) fn check_page_bytes(
    context: LoadContext<'_>,
    page: &TiffPage,
    options: &LoadOptions,
) -> Result<(), LoadError> {
    if page.bytes().is_some_and(|bytes| bytes <= options.memory_budget_bytes) {
        return Ok(());
    }
    Err(context.limit_error(
        "first page",
        format!("a page of {} x {} pixels of {} samples is too large", page.width, page.height, page.samples),
        "close other programs, or load a smaller or cropped picture",
    ))
}

/// Error for two pages that cannot be slices of one volume.
fn mismatch_error(context: LoadContext<'_>, number: usize, page: &TiffPage, model: &TiffPage) -> LoadError {
    let say = |page: &TiffPage| {
        let TiffPage { width, height, bits, samples, .. } = page;
        format!("{width} x {height} pixels of {samples} x {bits} bits")
    };
    context.bad_input_error(
        &format!("page {number}"),
        format!("it has {}, the first page has {}", say(page), say(model)),
        "save the pages of one size in a file of their own",
    )
}
