//! Zarr and OME-Zarr: images in several resolutions and arrays, as folders or ZIP archives of chunks.
//!
//! `hierarchy` finds the images and arrays of a store, `ome` has the metadata of images, and `array` reads boxes of
//! chunks. Metadata name no path outside of the folder, and links in it are not followed.

mod array;
mod hierarchy;
mod ome;
mod store;
#[cfg(test)]
mod tests;

use std::path::Path;

use glam::DVec3;

use super::input::name_without_extension;
use super::placement::{GridPlacement, VolumeParts};
use super::reader::{FormatReader, VolumeSource, checked_offer_count};
use super::samples::VoxelLayout;
use super::voxels::ValueMapping;
use super::{Endian, FileDimension, LoadControl, LoadError, LoadOptions, VolumeOffer};
use super::{input, number, samples, zip};
use array::{ArrayBox, SlabReader, ZarrArray, ZarrNode};
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{GridExtent, LoadContext, ResolutionLevel, ValueMeaning, ValueMetadata, Volume};
use hierarchy::{Hierarchy, HierarchyEntry};
use ome::{AxisRole, AxisScale, ImageAxis, OmeImage, OmeLevel};
use store::{FolderStore, Store, ZipStore, join};

/// Archive of a hierarchy.
pub(crate) const ARCHIVE: FormatReader = FormatReader {
    name: "OME-Zarr",
    extensions: &[".zarr.zip", ".ozx"],
    recognises: |start| zip::first_entry(start.stored()).is_some_and(store::is_document),
    load: |source| {
        let context = LoadContext { operation: OPERATION, path: source.path };
        let VolumeSource { input, options, control, .. } = source;
        load_store(context, &ZipStore::new(context, input)?, options, control)
    },
};

/// Document of metadata, by which the folder around it is opened where a dialog offers files alone.
pub(crate) const DOCUMENT: FormatReader = FormatReader {
    name: "OME-Zarr",
    extensions: &store::DOCUMENT_NAMES,
    recognises: |_| false,
    load: |source| {
        load_folder(source.path.parent().unwrap_or(Path::new(".")), source.options, source.control)
    },
};

const OPERATION: &str = "read the Zarr image";

const HELP: &str = "copy or download the folder again";

/// Returns true if a folder holds a hierarchy.
pub(crate) fn is_zarr_folder(path: &Path) -> bool {
    store::DOCUMENT_NAMES.iter().any(|name| path.join(name).is_file())
}

/// Loads an image or array of a folder.
pub(crate) fn load_folder(
    path: &Path,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    options.choice.record_format(ARCHIVE.name);
    control.record_read(path);
    let context = LoadContext { operation: OPERATION, path };
    load_store(context, &FolderStore::new(path.to_owned()), options, control)
}

fn load_store(
    context: LoadContext<'_>,
    store: &dyn Store,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let HierarchyEntry { path, image } = Hierarchy::new(context, store, options, control).choose()?;
    let image = image.unwrap_or_else(OmeImage::without_metadata);
    let levels = read_levels(context, store, &path, &image)?;
    let sizes: Vec<ResolutionLevel> = levels.iter().map(ImageLevel::size).collect();
    let chosen = if sizes.len() > 1 { options.limits(control).choose_level(context, &sizes)? } else { 0 };
    let level = &levels[chosen];
    let dims = level.dims();
    let indices = level.choose_indices(context, options, &image, dims)?;
    let channel = level.axis(AxisRole::Channel).and_then(|axis| image.channels.get(indices[axis] as usize));
    let stored = level.array.encoding();
    let limits = options.limits(control);
    let extent =
        GridExtent::checked(context, &join(&level.path, "shape"), dims, stored.voxel_type(), limits)?;
    let part = ArrayBox { axes: level.spatial_axes(), indices, low: extent.read.low, high: extent.read.high };
    let mut slabs = SlabReader::new(
        context,
        store,
        &level.array,
        part,
        extent.restricted_to_box(stored.voxel_type()).bytes,
        limits,
    )?;
    let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    let needed = extent.restricted_to_box(stored.voxel_type());
    let read = stored.read_values(
        &mut slabs,
        Some(SlabReader::skip),
        needed,
        &ValueMapping::identity(None),
        control,
    );
    let voxels = read.map_err(|fault| slabs.error(fault).into_error(context, &layout, "bytes", HELP))?;
    let nothing = "the store holds no chunk of what was read: all voxels have the fill value";
    // Regions of a sparse volume are often empty.
    let is_whole = limits.choice.portion.is_none_or(|portion| portion.is_whole());
    let placement = level.placement().with_remark((!slabs.has_data && is_whole).then_some(nothing));
    let mut hints = ValueMetadata::default();
    if let Some([low, high]) = channel.and_then(|channel| channel.window) {
        hints.set_window(low, high);
    }
    if let Some(labels) = &image.labels {
        hints.labels = labels.clone();
        hints.meaning = ValueMeaning::Labels;
    }
    let name = volume_name(context.path, &path);
    VolumeParts { name, extent, placement, voxels, hints }.into_volume(context, control)
}

/// Name of a volume: that of the file or folder, and the path in it.
fn volume_name(file: &Path, path: &str) -> String {
    let name = name_without_extension(file, &[".ome.zarr.zip", ".ome.zarr", ".zarr.zip", ".zarr", ".ozx"]);
    sanitised(&if path.is_empty() { name } else { format!("{name} {path}") }, 120)
}

/// Resolution level of the image that is opened.
struct ImageLevel {
    /// Name below the image.
    name: String,
    /// Path of the array in the hierarchy.
    path: String,
    array: ZarrArray,
    /// Axes, slowest first, one for each of the array.
    axes: Vec<ImageAxis>,
    /// Scale and translation of each axis, as far as they are known.
    scales: Vec<AxisScale>,
}

/// Reads the metadata of all levels of an image, finest first.
fn read_levels(
    context: LoadContext<'_>,
    store: &dyn Store,
    path: &str,
    image: &OmeImage,
) -> Result<Vec<ImageLevel>, LoadError> {
    let mut levels = Vec::new();
    for OmeLevel { path: name, scales } in &image.levels {
        let at = if name.is_empty() { path.to_owned() } else { join(path, name) };
        let Some(ZarrNode::Array(array)) = ZarrNode::read(context, store, &at)? else {
            return Err(context.bad_input_error(
                &at,
                "no array is there, although the image names it as a level",
                HELP,
            ));
        };
        let count = array.shape.len();
        let axes = match image.axes.len() {
            0 => ome::axes_by_names(&array.axis_names).filter(|axes| axes.len() == count),
            _ => Some(image.axes.clone()),
        };
        let axes = axes.unwrap_or_else(|| ome::axes_by_position(count));
        if axes.len() != count || count < 2 {
            return Err(context.bad_input_error(
                &join(&at, "shape"),
                format!("an array of {count} axes was found, where {} were expected", axes.len().max(2)),
                "check the metadata of the image against its arrays",
            ));
        }
        let (name, scales) = (name.clone(), scales.clone());
        levels.push(ImageLevel { name, path: at, array: *array, axes, scales });
    }
    levels.sort_by_key(|level| std::cmp::Reverse(level.voxels()));
    Ok(levels)
}

impl ImageLevel {
    fn axis(&self, role: AxisRole) -> Option<usize> {
        self.axes.iter().position(|axis| axis.role == role)
    }

    /// Axes of the array along x, y and z.
    fn spatial_axes(&self) -> [Option<usize>; 3] {
        AxisRole::SPACE.map(|role| self.axis(role))
    }

    /// Voxels along x, y and z.
    fn dims(&self) -> [u64; 3] {
        self.spatial_axes().map(|axis| axis.map_or(1, |axis| self.array.shape[axis]))
    }

    fn voxels(&self) -> u64 {
        self.dims().into_iter().fold(1, u64::saturating_mul)
    }

    fn size(&self) -> ResolutionLevel {
        let voxel_type = self.array.encoding().voxel_type();
        ResolutionLevel { name: self.name.clone(), dims: self.dims(), voxel_type }
    }

    /// Index along each axis that is none of space, by the user's choice.
    fn choose_indices(
        &self,
        context: LoadContext<'_>,
        options: &LoadOptions,
        image: &OmeImage,
        dims: [u64; 3],
    ) -> Result<Vec<u64>, LoadError> {
        let mut indices = vec![0; self.axes.len()];
        // Axes of unknown roles count time steps or channels, where there are none of these.
        let mut free = [FileDimension::Frame, FileDimension::Channel].into_iter().filter(|dimension| {
            let role = if *dimension == FileDimension::Frame { AxisRole::Time } else { AxisRole::Channel };
            self.axis(role).is_none()
        });
        for (at, axis) in self.axes.iter().enumerate() {
            let count = self.array.shape[at];
            let dimension = match axis.role {
                AxisRole::X | AxisRole::Y | AxisRole::Z => continue,
                AxisRole::Channel => FileDimension::Channel,
                AxisRole::Time => FileDimension::Frame,
                AxisRole::Other if count <= 1 => continue,
                AxisRole::Other => free.next().ok_or_else(|| {
                    context.bad_input_error(
                        &join(&self.path, "shape"),
                        "it has more axes than x, y, z, channel and time step",
                        "save an array of at most five axes",
                    )
                })?,
            };
            indices[at] = choose_index(context, options, dimension, count, dims, |index| {
                let channel = image.channels.get(index).filter(|_| dimension == FileDimension::Channel);
                channel.map(|channel| (channel.name.clone(), channel.color)).unwrap_or_default()
            })?;
        }
        Ok(indices)
    }

    /// Placement of the grid by scales and units; of unknown scale without units.
    fn placement(&self) -> GridPlacement {
        let Some(scale) = self.scales_mm(1.0, |axis| axis.scale) else { return GridPlacement::unknown() };
        let translation = self.scales_mm(0.0, |axis| axis.translation).map(DVec3::from);
        let mut placement = GridPlacement::from_spacing(scale);
        placement.world_from_index.translation = translation.filter(|at| at.is_finite()).unwrap_or_default();
        match self.axis(AxisRole::X).and_then(|axis| self.axes[axis].unit_mm) {
            Some(unit_mm) => placement.with_length_unit(unit_mm),
            None => placement.with_unknown_scale(),
        }
    }

    /// Numbers of the axes x, y and z in millimetres, or without units as they are; `other` where there is no axis.
    fn scales_mm(&self, other: f64, number: impl Fn(&AxisScale) -> f64) -> Option<[f64; 3]> {
        (self.scales.len() == self.axes.len()).then(|| {
            self.spatial_axes().map(|axis| {
                axis.map_or(other, |axis| number(&self.scales[axis]) * self.axes[axis].unit_mm.unwrap_or(1.0))
            })
        })
    }
}

/// Index of the chosen volume along a dimension, with the name and colour of each.
fn choose_index(
    context: LoadContext<'_>,
    options: &LoadOptions,
    dimension: FileDimension,
    count: u64,
    dims: [u64; 3],
    name_and_color: impl Fn(usize) -> (String, Option<[u8; 3]>),
) -> Result<u64, LoadError> {
    let offer = |index: usize| {
        let (name, color) = name_and_color(index);
        VolumeOffer { color, ..VolumeOffer::with_number(index, &name, dims) }
    };
    let count = checked_offer_count(context, dimension, count)?;
    let offers = (0..count).map(offer).collect();
    context.resolve_choice(&options.choice, dimension, offers).map(|index| index as u64)
}
