//! Image stacks: volumes whose slices are files of their own, numbered pictures, and single pictures.
//!
//! PNG (<https://www.w3.org/TR/png-3/>), JPEG (ITU-R T.81), BMP and TIFF. The distance of the slices is unknown.

mod counters;
mod groups;
mod picture;
mod recordings;
#[cfg(test)]
mod tests;

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::slice_reader::read_slices;
use super::tiff;
use crate::LoadOptions;
use crate::reading::input::{InputFile, stem};
use crate::reading::placement::{GridPlacement, VolumeParts};
use crate::reading::reader::{FileStart, FormatReader, VolumeSource};
use crate::reading::samples::alloc_zeroed;
use crate::reading::voxels::ValueMapping;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{
    FileDimension, GridExtent, LoadContext, LoadControl, LoadError, ValueMetadata, Volume, VolumeChoice,
    VolumeOffer, quoted,
};
use groups::{SliceGroup, group_slices, name_pattern};
use picture::{PictureHeader, SliceFormat, read_picture};
use recordings::{SliceSeries, join_recordings};

/// Maximum number of series whose sizes are looked up for the list: as many as a screen has lines for.
const MAX_LOOKED_UP: usize = 24;

/// Reader of a single picture, as a volume of one slice.
pub(crate) const READER: FormatReader = FormatReader {
    name: "PNG, JPEG, BMP",
    extensions: &[".png", ".jpg", ".jpeg", ".bmp"],
    recognises: |start| SliceFormat::detect(start.stored()).is_some_and(|kind| kind != SliceFormat::Tiff),
    load: load_single_picture,
};

fn load_single_picture(source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let VolumeSource { path, start, options, control, .. } = source;
    let context = LoadContext { operation: "read the picture", path };
    let Some(kind) = SliceFormat::detect(start.stored()) else {
        return Err(context.bad_input_error(
            "header",
            "its first bytes are not those of a picture",
            "copy the file again",
        ));
    };
    options.choice.record_format(kind.name(false));
    let stack = PictureStack {
        kind,
        files: vec![Some(path.to_owned())],
        name: stem(path),
        placement: GridPlacement::unknown(),
    };
    stack.read(context, options, control)
}

/// Loads the volume whose slices are among the files of a folder, in natural order; `None` where none is a picture.
///
/// # Errors
/// [`LoadError::Several`] where there are several volumes, `BadInput` for slices that do not match each
/// other or are broken.
pub(crate) fn load(
    context: LoadContext<'_>,
    files: &[PathBuf],
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Option<Volume>, LoadError> {
    let (mut pictures, mut others) = (Vec::new(), Vec::new());
    for path in files {
        control.check()?;
        match SliceFormat::detect_file(slice_context(path))? {
            Some(kind) => pictures.push((path.as_path(), kind)),
            None => others.push(path.as_path()),
        }
    }
    if pictures.iter().all(|&(_, kind)| kind == SliceFormat::Tiff)
        && let Some(set) = tiff_set_file(&pictures, control)?
    {
        return load_tiff(set, options, control).map(Some);
    }
    // Without the recorder: what is looked at here is not what is opened.
    let for_sizes = LoadOptions { choice: VolumeChoice::default(), ..options.clone() };
    let size_of = |file: usize| {
        let (path, kind) = pictures[file];
        let header = read_picture(slice_context(path), kind, &for_sizes, control, false);
        header.ok().map(|(header, _)| header.size)
    };
    let mut series = join_recordings(group_slices(pictures.iter().copied()), size_of);
    control.check()?;
    let mut remarks = Vec::new();
    if options.choice.series.is_none() {
        drop_stray_pictures(&mut series, &mut remarks);
    }
    if series.is_empty() {
        return Ok(None);
    }
    let is_one = series.len() == 1;
    let offers = offers(&series, size_of);
    let chosen = context.resolve_choice(&options.choice, FileDimension::Series, offers)?;
    let SliceSeries { group, recording } = series.swap_remove(chosen);
    remarks.extend(damaged_slices_remark(&others, &group, &pictures));
    if group.kind == SliceFormat::Tiff
        && let [one] = group.files.as_slice()
    {
        let volume = load_tiff(pictures[*one].0, options, control)?;
        let remarks = volume.remarks().iter().cloned().chain(remarks).collect();
        return Ok(Some(volume.with_remarks(remarks)));
    }
    options.choice.record_format(group.kind.name(true));
    remarks.extend(group.gap);
    let mut placement = GridPlacement::unknown();
    let files = match recording {
        Some(recording) => {
            let stack = recording.choose(context, &options.choice)?;
            remarks.extend(stack.remarks);
            stack.choice.add_time_remark(&mut placement);
            stack.files
        }
        None => group.files.into_iter().map(Some).collect(),
    };
    placement.remarks.splice(0..0, remarks);
    let folder = context.path.file_name().unwrap_or_default().to_string_lossy();
    let name =
        if is_one && !folder.is_empty() { sanitised(&folder, 120) } else { sanitised(&group.name, 120) };
    let path_of = |file: Option<usize>| file.map(|file| pictures[file].0.to_owned());
    let files = files.into_iter().map(path_of).collect();
    PictureStack { kind: group.kind, files, name, placement }.read(context, options, control).map(Some)
}

fn slice_context(path: &Path) -> LoadContext<'_> {
    LoadContext { operation: "read the slice", path }
}

/// Remark about files that are named like slices of a group, or at least like pictures, but are none: truncated or
/// damaged copies.
fn damaged_slices_remark(
    others: &[&Path],
    group: &SliceGroup,
    pictures: &[(&Path, SliceFormat)],
) -> Option<String> {
    // As many as fit into a line.
    const MAX_NAMED: usize = 3;
    let own = group.files.first().map(|&file| name_pattern(pictures[file].0));
    let known: HashSet<String> = pictures.iter().map(|(path, _)| name_pattern(path)).collect();
    let is_meant = |path: &&&Path| {
        let name = name_pattern(path);
        Some(&name) == own.as_ref() || (has_picture_extension(path) && !known.contains(&name))
    };
    let mut names: Vec<String> = others
        .iter()
        .filter(is_meant)
        .map(|path| quoted(&path.file_name().unwrap_or_default().to_string_lossy()))
        .collect();
    let count = names.len();
    if count > MAX_NAMED {
        names.truncate(MAX_NAMED);
        names.push(format!("and {} more", count - MAX_NAMED));
    }
    (count > 0).then(|| {
        let (is, they) =
            if count == 1 { ("is", "it is not a picture") } else { ("are", "they are not pictures") };
        format!("{} {is} left out: {they}; copy the file again if a slice is missing", names.join(", "))
    })
}

fn has_picture_extension(path: &Path) -> bool {
    let endings = READER.extensions.iter().chain(&[".tif", ".tiff"]);
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    endings.into_iter().any(|ending| name.ends_with(ending))
}

/// Leaves out single pictures beside the slices of one volume: previews and the like.
fn drop_stray_pictures(series: &mut Vec<SliceSeries>, remarks: &mut Vec<String>) {
    // With fewer slices, strays cannot be distinguished from them.
    const MIN_SLICES: usize = 3;
    let is_stray = |series: &SliceSeries| series.group.files.len() == 1;
    let stacks = series.iter().filter(|series| !is_stray(series)).count();
    let is_clear = stacks == 1 && series.iter().any(|series| series.group.files.len() >= MIN_SLICES);
    if is_clear && series.len() > 1 {
        remarks.push(format!("{} single pictures beside the slices are left out", series.len() - 1));
        series.retain(|series| !is_stray(series));
    }
}

/// List of the volumes to choose from, where there are several.
fn offers(series: &[SliceSeries], size_of: impl Fn(usize) -> Option<[u64; 2]>) -> Vec<VolumeOffer> {
    let dims = |SliceSeries { group, recording }: &SliceSeries| {
        if let Some(recording) = recording {
            return Some(recording.dims());
        }
        let [width, height] = size_of(*group.files.first()?)?;
        Some([width, height, group.files.len() as u64])
    };
    let is_long = series.len() > MAX_LOOKED_UP || series.len() == 1;
    let offer = |(at, series): (usize, &SliceSeries)| VolumeOffer {
        key: at.to_string(),
        name: sanitised(&series.group.name, 80),
        dims: if is_long { None } else { dims(series) },
        color: None,
    };
    series.iter().enumerate().map(offer).collect()
}

/// Returns the first file if its metadata describe the whole set of files: it is read in place of all.
fn tiff_set_file<'a>(
    pictures: &[(&'a Path, SliceFormat)],
    control: &LoadControl,
) -> Result<Option<&'a Path>, LoadError> {
    let [(first, _), (second, _), ..] = *pictures else { return Ok(None) };
    let name = second.file_name().unwrap_or_default().to_string_lossy();
    let is_set = tiff::SingleSlice::open(slice_context(first), control)?.describes_set_with(&name);
    Ok(is_set.then_some(first))
}

fn load_tiff(path: &Path, options: &LoadOptions, control: &LoadControl) -> Result<Volume, LoadError> {
    let context = slice_context(path);
    options.choice.record_format(tiff::READER.name);
    let mut input = InputFile::open(context)?;
    let start = FileStart::read(&mut input).map_err(|error| context.io_error(error))?;
    (tiff::READER.load)(VolumeSource { path, input, start, options, control })
}

/// Stack of slices of one format, each in a file of its own.
struct PictureStack {
    kind: SliceFormat,
    /// Files in the order of slices, at least one; a slice without a file is empty.
    files: Vec<Option<PathBuf>>,
    name: String,
    placement: GridPlacement,
}

impl PictureStack {
    /// Reads the volume.
    ///
    /// # Errors
    /// `BadInput` where slices differ or are broken; `Limit` over the budget.
    fn read(
        self,
        context: LoadContext<'_>,
        options: &LoadOptions,
        control: &LoadControl,
    ) -> Result<Volume, LoadError> {
        let Self { kind, files, name, mut placement } = self;
        let look_at = |path: &PathBuf, is_decoded| {
            read_picture(slice_context(path), kind, options, control, is_decoded)
        };
        let paths: Vec<&PathBuf> = files.iter().flatten().collect();
        let headers: Vec<PictureHeader> = paths
            .par_iter()
            .map(|path| look_at(path, false).map(|(header, _)| header))
            .collect::<Result<_, _>>()?;
        let (Some(&model), Some(&first)) = (headers.first(), paths.first()) else {
            return Err(context.bad_input_error("files", "there is no slice", "open a single file"));
        };
        for (header, path) in headers.iter().zip(&paths) {
            check_slices_match(context, [(&model, first), (header, path)])?;
        }
        let stored = model.stored;
        let dims = [model.size[0], model.size[1], files.len() as u64];
        let extent =
            GridExtent::checked(context, "files", dims, stored.voxel_type(), options.limits(control))?;
        let empty = || {
            let bytes = model.size[0].saturating_mul(model.size[1]).saturating_mul(stored.voxel_bytes());
            alloc_zeroed(usize::try_from(bytes).unwrap_or(usize::MAX)).map_err(|_no_memory| {
                let why = format!("there is not enough memory for {bytes} bytes");
                context.limit_error("files", why, "close other programs or load a smaller volume")
            })
        };
        let meant = ValueMapping::identity(None);
        let voxels = read_slices(context, &stored, extent, &meant, control, |some| {
            let decode = |&slice: &usize| {
                let Some(path) = &files[slice] else { return empty() };
                let (header, bytes) = look_at(path, true)?;
                check_slices_match(context, [(&model, first), (&header, path)])?;
                Ok(bytes)
            };
            some.par_iter().map(decode).collect()
        })?;
        placement.remarks.extend(stored.reduction.remark().map(str::to_owned));
        VolumeParts { name, extent, placement, voxels, hints: ValueMetadata::default() }
            .into_volume(context, control)
    }
}

/// Checks that two slices have equal size and type, and that each file holds only one.
fn check_slices_match(
    context: LoadContext<'_>,
    slices: [(&PictureHeader, &PathBuf); 2],
) -> Result<(), LoadError> {
    let [(model, _), (header, _)] = slices;
    let [first, path] =
        slices.map(|(_, path)| quoted(&path.file_name().unwrap_or_default().to_string_lossy()));
    if header.pages > 1 {
        return Err(context.bad_input_error(
            "files",
            format!("{path} alone holds {} slices", header.pages),
            "open that file, or choose another series with --series",
        ));
    }
    if header.size == model.size && header.stored == model.stored {
        return Ok(());
    }
    let say = |header: &PictureHeader| {
        let [width, height] = header.size;
        let PictureHeader { stored, .. } = header;
        format!("{width} x {height} pixels of {} x {} bits", stored.components, stored.number.bytes() * 8)
    };
    Err(context.bad_input_error(
        "files",
        format!("{path} has {}, {first} has {}", say(header), say(model)),
        "put slices of one size and type into a folder of their own",
    ))
}
