//! Voxels of a DICOM volume: layers are read, decompressed and rescaled in parallel.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::super::number::ScalarReduction;
use super::super::placement::VolumeParts;
use super::super::rescale::rescale;
use super::super::voxels::{AveragingError, ReadVoxels, ValueMapping, average_blocks};
use super::super::{Endian, LoadControl, LoadError, LoadOptions};
use super::header::DicomHeader;
use super::hints;
use super::image_groups::readable_layout;
use super::layer_reader::{ImageBuffers, LayerSource, VolumeReadError, no_memory, reserve_voxels};
use super::pixels::conversion::{PixelConversion, VoxelNumber};
use super::pixels::layout::PixelLayout;
use super::pixels::pixel_store::PixelStore;
use super::slice_layer::{DicomSlice, GapFill, SliceLayer};
use super::stack::StackedVolume;
use chiaroscuro_volume::{GridExtent, LoadContext, ResolvedPortion, Samples, Volume, VoxelType};

/// Volume to be read: its slices and layers, and the storage of their pixels.
pub(super) struct VolumeRequest<'a> {
    pub(super) name: String,
    pub(super) headers: &'a [DicomHeader],
    pub(super) shape: PixelLayout,
    pub(super) filling: GapFill,
    pub(super) has_masks: bool,
    pub(super) volume: StackedVolume,
}

/// Reads a volume.
///
/// # Errors
/// [`VolumeReadError::Unreadable`] lists the slices that cannot be read, if others can.
pub(super) fn load_volume(
    context: LoadContext<'_>,
    request: &VolumeRequest<'_>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, VolumeReadError> {
    let VolumeRequest { shape, volume, .. } = request;
    let headers = request.headers;
    let StackedVolume { slices, layers, placement, .. } = volume;
    let component = options.choice.resolve_component(shape.samples, shape.samples > 1);
    let part = ScalarReduction::require(context, component, shape.samples, shape.samples > 1)?;
    let Some(first) = slices.first() else {
        let why =
            context.bad_input_error("Number of Frames", "it has no frames", "copy or export the file again");
        return Err(why.into());
    };
    let scale = if request.has_masks { [1.0, 0.0] } else { first.plane.scale() };
    // Colours and segment numbers are not rescaled.
    let is_scaled =
        shape.samples == 1 && !request.has_masks && slices.iter().any(|slice| slice.plane.scale() != scale);
    let voxel_type = request.voxel_type(is_scaled);
    let dims = [shape.columns as u64, shape.rows as u64, layers.len() as u64];
    let extent = GridExtent::checked(context, "Rows, Columns", dims, voxel_type, options.limits(control))?;
    let read_slices = extent.read.slices().flat_map(|layer| layers[layer].slices()).map(|at| &slices[at]);
    let stores = open_stores(headers, read_slices, options, control)?;
    let found = &headers[first.file].values;
    let hints = hints::volume_hints(found, shape, first, (!is_scaled).then_some(scale), request.has_masks);
    let source = LayerSource {
        headers,
        stores: &stores,
        slices,
        gap_fill: request.filling,
        raster: PixelConversion { shape: *shape, endian: Endian::Little, part, scale: None },
        has_own_scales: is_scaled,
        padding: hints::stored_padding(found, shape).filter(|_| !is_scaled),
        full_mask_value: hints::full_mask_value(found),
        overlapping: AtomicU64::new(0),
        control,
    };
    let values = |samples| {
        if is_scaled || shape.samples > 1 {
            Ok(samples)
        } else {
            rescale(context, samples, scale, options.memory_budget_bytes)
        }
    };
    let meant = ValueMapping { padding: hints.padding, map: &values };
    let layers = LayerReader { source: &source, layers, shape: *shape };
    let voxels = layers.read(context, &extent.read, voxel_type, &meant);
    let voxels = voxels.map_err(|fault| layers.list_unreadable(&extent.read, fault))?;
    let mut placement = placement.clone();
    let is_unpacked = first.tile.is_some();
    let part = hints::ShownImagePart {
        is_component: options.choice.component.is_some(),
        is_mosaic_tile: is_unpacked,
    };
    placement.remarks.extend(hints::remarks(&headers[first.file], shape, part));
    let overlapping = source.overlapping.load(Ordering::Relaxed);
    if overlapping > 0 {
        placement.remarks.push(format!(
            "segments overlap in {overlapping} voxels: the one with {} is shown",
            hints::overlap_rule(found)
        ));
    }
    let parts = VolumeParts { name: request.name.clone(), extent, placement, voxels, hints };
    parts.into_volume(context, control).map_err(VolumeReadError::from)
}

impl VolumeRequest<'_> {
    /// Returns the type of the voxels before a common rescaling.
    fn voxel_type(&self, is_scaled: bool) -> VoxelType {
        let StackedVolume { slices, layers, .. } = &self.volume;
        if self.has_masks {
            let highest = slices.iter().filter_map(|slice| slice.plane.segment).max().unwrap_or(1);
            return if u8::try_from(highest).is_ok() { VoxelType::U8 } else { VoxelType::U16 };
        }
        // Only floating-point types have a value for unmeasured voxels (NaN).
        let has_empty_layers = self.filling == GapFill::Interpolate && layers.contains(&SliceLayer::Empty);
        match self.shape.voxel_type() {
            VoxelType::U32 | VoxelType::I32 | VoxelType::F64 if is_scaled || has_empty_layers => {
                VoxelType::F64
            }
            _ if is_scaled || has_empty_layers => VoxelType::F32,
            stored => stored,
        }
    }
}

/// Opens the pixel stores of all files that contribute a slice.
fn open_stores<'a>(
    headers: &[DicomHeader],
    slices: impl Iterator<Item = &'a DicomSlice>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Vec<Option<PixelStore>>, LoadError> {
    let mut is_used = vec![false; headers.len()];
    for slice in slices {
        is_used[slice.file] = true;
    }
    let found = headers.par_iter().zip(is_used).map(|(header, is_used)| {
        control.check()?;
        let store =
            || PixelStore::open(header, readable_layout(header)?, options.memory_budget_bytes, control);
        is_used.then(store).transpose()
    });
    found.collect()
}

/// Layers of a volume, with the source of their voxels.
struct LayerReader<'a> {
    source: &'a LayerSource<'a>,
    layers: &'a [SliceLayer],
    shape: PixelLayout,
}

impl LayerReader<'_> {
    /// Reads the kept part of the volume, averaged if requested.
    fn read(
        &self,
        context: LoadContext<'_>,
        kept: &ResolvedPortion,
        voxel_type: VoxelType,
        meant: &ValueMapping<'_>,
    ) -> Result<ReadVoxels, VolumeReadError> {
        let boxed = kept.voxels_to_read();
        // Reads one pixel of the first layer before memory for the volume is allocated: an image that contradicts its
        // header must not cost any.
        let first = kept.low[2];
        let one = ResolvedPortion {
            low: [0, 0, first],
            high: [1, 1, first + 1],
            ..ResolvedPortion::whole_grid(kept.grid)
        };
        self.read_typed(context, &one, voxel_type)?;
        self.source.overlapping.store(0, Ordering::Relaxed);
        self.source.control.start(GridExtent::unchecked(boxed.dims(), voxel_type).bytes);
        if !kept.is_averaged {
            return Ok((meant.map)(self.read_typed(context, &boxed, voxel_type)?)?.into());
        }
        average_blocks(kept, voxel_type.bytes(), meant, self.source.control, |slices| {
            let (mut low, mut high) = (boxed.low, boxed.high);
            (low[2], high[2]) = (boxed.low[2] + slices.start, boxed.low[2] + slices.end);
            self.read_typed(context, &ResolvedPortion { low, high, ..boxed }, voxel_type)
        })
        .map_err(|why| match why {
            AveragingError::Read(fault) => fault,
            AveragingError::NoMemory => no_memory(context, kept.count()).into(),
        })
    }

    /// Reads a part of the volume without averaging, in the given type.
    fn read_typed(
        &self,
        context: LoadContext<'_>,
        kept: &ResolvedPortion,
        voxel_type: VoxelType,
    ) -> Result<Samples, VolumeReadError> {
        match voxel_type {
            VoxelType::U8 => self.read_voxels(context, kept).map(Samples::U8),
            VoxelType::I8 => self.read_voxels(context, kept).map(Samples::I8),
            VoxelType::U16 => self.read_voxels(context, kept).map(Samples::U16),
            VoxelType::I16 => self.read_voxels(context, kept).map(Samples::I16),
            VoxelType::U32 => self.read_voxels(context, kept).map(Samples::U32),
            VoxelType::I32 => self.read_voxels(context, kept).map(Samples::I32),
            VoxelType::F32 => self.read_voxels(context, kept).map(Samples::F32),
            VoxelType::F64 => self.read_voxels(context, kept).map(Samples::F64),
        }
    }

    fn read_voxels<T: VoxelNumber>(
        &self,
        context: LoadContext<'_>,
        kept: &ResolvedPortion,
    ) -> Result<Vec<T>, VolumeReadError> {
        let [width, height, _] = kept.dims();
        let mut voxels: Vec<T> = reserve_voxels(context, kept.count())?;
        voxels.resize(kept.count(), T::default());
        let layers: Vec<&SliceLayer> = kept.slices().map(|layer| &self.layers[layer]).collect();
        let is_whole = [width, height] == [kept.grid[0], kept.grid[1]];
        let chunks = voxels.par_chunks_mut(width * height).zip(layers.par_iter());
        chunks.try_for_each_init(
            ImageBuffers::default,
            |scratch: &mut ImageBuffers<T>, (voxels, layer)| {
                self.source.control.check()?;
                if is_whole {
                    self.source.read_layer(context, layer, voxels, scratch)?;
                } else {
                    let mut whole = scratch.take_whole(context, self.shape.pixel_count())?;
                    self.source.read_layer(context, layer, &mut whole, scratch)?;
                    kept.copy_from_slice(&whole, voxels);
                    scratch.give_back(whole);
                }
                self.source.control.advance(size_of_val(voxels) as u64);
                Ok::<(), VolumeReadError>(())
            },
        )?;
        Ok(voxels)
    }

    /// After a failure, tests all slices of the kept layers and lists every unreadable one, so that the others can be
    /// shown.
    fn list_unreadable(&self, kept: &ResolvedPortion, fault: VolumeReadError) -> VolumeReadError {
        let VolumeReadError::Unreadable { why, .. } = fault else { return fault };
        let mut pictures: Vec<usize> = kept.slices().flat_map(|layer| self.layers[layer].slices()).collect();
        pictures.sort_unstable();
        pictures.dedup();
        let total = pictures.len();
        let tested = pictures.into_par_iter().map_init(Vec::new, |voxels: &mut Vec<f32>, picture| {
            self.source.control.check()?;
            let slice = &self.source.slices[picture];
            voxels.resize(self.shape.pixel_count(), 0.0);
            match self.source.read_slice(slice, voxels, &mut Vec::new()) {
                Ok(()) => Ok(None),
                Err(VolumeReadError::Unreadable { .. }) => Ok(Some(picture)),
                Err(VolumeReadError::Load(error)) => Err(error),
            }
        });
        match tested.collect::<Result<Vec<Option<usize>>, LoadError>>() {
            Ok(found) => {
                VolumeReadError::Unreadable { pictures: found.into_iter().flatten().collect(), total, why }
            }
            Err(error) => VolumeReadError::Load(error),
        }
    }
}
