//! Segmentations in a folder: a mask for each object, in a `NIfTI` file that is named after it, as `TotalSegmentator`
//! writes them. They become one label map.

mod label_overlay;
mod mask_grid;

use std::path::{Path, PathBuf};

use super::super::input::{FileChangeGuard, InputFile, name_without_extension};
use super::super::placement::VolumeParts;
use super::super::reader::{FileStart, VolumeSource};
use super::super::{LoadControl, LoadError, LoadOptions, has_extension};
use super::load_parts;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{
    Downsampling, GridExtent, LoadContext, Portion, ReadContext, ResolvedPortion, ValueMeaning,
    ValueMetadata, Volume, VolumeChoice, VoxelType,
};
use label_overlay::LabelOverlay;
use mask_grid::MaskGrid;

/// Extensions of masks, longest first; pairs of header and data are no masks of a segmentation.
const MASK_ENDINGS: [&str; 2] = [".nii.gz", ".nii"];

/// Maximum number of masks: labels have up to 16 bits.
const MAX_MASKS: usize = u16::MAX as usize;

const HELP: &str = "open a single file, or move all that are not masks of one segmentation to another folder";

/// Selects the files of a folder that may be masks, by their names.
pub(crate) fn mask_files(files: &[PathBuf]) -> Vec<&Path> {
    let is_mask = |path: &&Path| MASK_ENDINGS.iter().any(|ending| has_extension(path, ending));
    files.iter().map(PathBuf::as_path).filter(is_mask).collect()
}

/// Loads masks as one label map: each has its place among `masks` as its label, counted from 1, and its file name as
/// the name of the label. Where masks overlap, the last is shown.
///
/// # Errors
/// `BadInput` where a file is not a mask, or its grid is not that of the first; `Limit` for too many masks, or over
/// the budget.
pub(crate) fn load_masks(
    context: LoadContext<'_>,
    masks: &[&Path],
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let Some((&first, others)) = masks.split_first() else {
        return Err(context.bad_input_error("files", "it has no masks", HELP));
    };
    if masks.len() > MAX_MASKS {
        let why = format!("it has {} masks, {MAX_MASKS} are allowed", masks.len());
        return Err(context.limit_error("files", why, "open a folder with fewer"));
    }
    // All headers before any voxel: most folders that hold no segmentation are told apart by them.
    let model = MaskGrid::read(mask_context(first))?;
    for path in others {
        control.check()?;
        MaskGrid::read(mask_context(path))?.check_equals(mask_context(path), &model, first)?;
    }
    options.choice.record_format("NIfTI masks");
    let voxel_type = if masks.len() > usize::from(u8::MAX) { VoxelType::U16 } else { VoxelType::U8 };
    let extent = extent(mask_context(first), model.dims, voxel_type, options, control)?;
    let count = extent.read.count();
    let Ok(mut overlay) = LabelOverlay::new(voxel_type, count) else {
        let why = format!("there is not enough memory for {count} voxels of {}", voxel_type.name());
        return Err(context.limit_error("dim", why, "close other programs or load a part with --region"));
    };
    let mask_options = mask_options(options, count as u64 * voxel_type.bytes() as u64);
    // Each mask would begin the count of bytes again.
    let inner = LoadControl::with_token(control.token().clone());
    control.start((count as u64).saturating_mul(masks.len() as u64));
    let mut hints = ValueMetadata::default();
    hints.meaning = ValueMeaning::Labels;
    for (label, path) in (1..).zip(masks) {
        let mask = read_mask(path, &mask_options, control, &inner)?;
        let grid = MaskGrid::from_placement(mask.extent.dims, mask.placement);
        grid.check_equals(mask_context(path), &model, first)?;
        overlay.add(mask_context(path), label, &mask.voxels.samples, control)?;
        hints.labels.insert(i64::from(label), &label_name(path), None);
        control.advance(count as u64);
    }
    let mut placement = model.placement;
    placement.remarks.extend(overlay.remark());
    let folder = context.path.file_name().unwrap_or_default().to_string_lossy();
    let name = if folder.is_empty() { "segmentation".to_owned() } else { sanitised(&folder, 120) };
    VolumeParts { name, extent, placement, voxels: overlay.into_samples().into(), hints }
        .into_volume(context, control)
}

fn mask_context(path: &Path) -> LoadContext<'_> {
    LoadContext { operation: "open the NIfTI files of the folder as masks of one segmentation", path }
}

/// Name of a mask's label: `kidney_left.nii.gz` has `kidney left`.
fn label_name(path: &Path) -> String {
    name_without_extension(path, &MASK_ENDINGS).replace('_', " ")
}

/// Portion without averages, of which labels have none: blocks are reduced when all masks have been read.
fn portion_of_masks(portion: Portion) -> Portion {
    match portion.thinning {
        Downsampling::Average(_) => Portion { thinning: Downsampling::None, ..portion },
        Downsampling::None | Downsampling::Every(_) => portion,
    }
}

/// Extent of the label map, within the budget.
fn extent(
    context: LoadContext<'_>,
    dims: [u64; 3],
    voxel_type: VoxelType,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<GridExtent, LoadError> {
    let portion = options.choice.portion.map(portion_of_masks);
    let choice = VolumeChoice { portion, ..options.choice.clone() };
    let room = ReadContext { choice: &choice, ..options.limits(control) };
    let extent = GridExtent::checked(context, "dim", dims, voxel_type, room)?;
    let wanted = options.choice.portion.unwrap_or_default();
    match ResolvedPortion::resolve(&wanted, extent.dims, choice.are_labels) {
        Some(wanted) => Ok(GridExtent { wanted, ..extent }),
        None => Err(context.region_error(extent.dims)),
    }
}

/// Options for reading one mask beside a label map of `label_bytes`. They state a portion, so that the user is not
/// asked about the size of each mask.
fn mask_options(options: &LoadOptions, label_bytes: u64) -> LoadOptions {
    let portion = Some(portion_of_masks(options.choice.portion.unwrap_or_default()));
    LoadOptions {
        choice: VolumeChoice { portion, ..VolumeChoice::default() },
        memory_budget_bytes: options.memory_budget_bytes.saturating_sub(label_bytes),
        ..options.clone()
    }
}

/// Reads the voxels of one mask; `control` records the file, and `inner` counts its bytes.
fn read_mask(
    path: &Path,
    options: &LoadOptions,
    control: &LoadControl,
    inner: &LoadControl,
) -> Result<VolumeParts, LoadError> {
    let context = mask_context(path);
    let mut input = InputFile::open(context)?;
    let guard = FileChangeGuard::new(context, &input, control)?;
    let start = FileStart::read(&mut input).map_err(|error| context.io_error(error))?;
    guard.check_unchanged(context, load_parts(VolumeSource { path, input, start, options, control: inner }))
}
