//! Voxels of a layer, from its slices: one slice, a blend of two, or a label layer from masks of segments.

use std::sync::atomic::{AtomicU64, Ordering};

use super::super::samples::alloc_with_capacity;
use super::super::{LoadControl, LoadError};
use super::READ_FILE;
use super::header::DicomHeader;
use super::mosaic::Mosaic;
use super::pixels::conversion::{PixelConversion, VoxelNumber};
use super::pixels::pixel_store::PixelStore;
use super::slice_layer::{DicomSlice, GapFill, SliceLayer};
use chiaroscuro_volume::{LoadContext, LoadErrorKind};

/// Reason why a volume was not read.
#[derive(Debug)]
pub(super) enum VolumeReadError {
    /// Fatal error: no volume can be read.
    Load(LoadError),
    /// Unreadable slices, by their indices, among `total`; `why` is the error of the first.
    Unreadable { pictures: Vec<usize>, total: usize, why: LoadError },
}

impl From<LoadError> for VolumeReadError {
    fn from(error: LoadError) -> Self {
        Self::Load(error)
    }
}

/// Slices that layers are made from, and the conversion of their pixels to voxels.
pub(super) struct LayerSource<'a> {
    pub(super) headers: &'a [DicomHeader],
    /// Pixel stores of the files, by file index; `None` for files without slices to read.
    pub(super) stores: &'a [Option<PixelStore>],
    pub(super) slices: &'a [DicomSlice],
    pub(super) gap_fill: GapFill,
    pub(super) raster: PixelConversion,
    /// True if each slice has its own slope and intercept.
    pub(super) has_own_scales: bool,
    /// Padding value, as stored in the file.
    pub(super) padding: Option<f64>,
    /// Value of a mask pixel that lies entirely in its segment.
    pub(super) full_mask_value: f64,
    /// Number of voxels found so far that lie in several segments.
    pub(super) overlapping: AtomicU64,
    pub(super) control: &'a LoadControl,
}

/// Reusable buffers for images, one set per worker thread.
#[derive(Debug)]
pub(super) struct ImageBuffers<T> {
    whole: Vec<T>,
    other: Vec<T>,
    shares: Vec<T>,
    mosaic: Vec<T>,
}

impl<T> Default for ImageBuffers<T> {
    fn default() -> Self {
        Self { whole: Vec::new(), other: Vec::new(), shares: Vec::new(), mosaic: Vec::new() }
    }
}

impl<T: VoxelNumber> ImageBuffers<T> {
    /// Takes the buffer for a whole image, resized to this many pixels.
    pub(super) fn take_whole(
        &mut self,
        context: LoadContext<'_>,
        pixels: usize,
    ) -> Result<Vec<T>, LoadError> {
        let mut whole = std::mem::take(&mut self.whole);
        resize(context, &mut whole, pixels)?;
        Ok(whole)
    }

    /// Puts the buffer of a whole image back for reuse.
    pub(super) fn give_back(&mut self, whole: Vec<T>) {
        self.whole = whole;
    }
}

impl LayerSource<'_> {
    /// Reads the voxels of a layer.
    pub(super) fn read_layer<T: VoxelNumber>(
        &self,
        context: LoadContext<'_>,
        layer: &SliceLayer,
        voxels: &mut [T],
        scratch: &mut ImageBuffers<T>,
    ) -> Result<(), VolumeReadError> {
        match layer {
            SliceLayer::Slice(picture) => {
                self.read_slice(&self.slices[*picture], voxels, &mut scratch.mosaic)?;
            }
            SliceLayer::Blend { is_missing: true, .. } if self.gap_fill == GapFill::NoSegment => {
                voxels.fill(T::default());
            }
            SliceLayer::Blend { pictures: [low, high], share, .. }
                if self.gap_fill != GapFill::Interpolate =>
            {
                let nearest = if *share < 0.5 { low } else { high };
                self.read_slice(&self.slices[*nearest], voxels, &mut scratch.mosaic)?;
            }
            SliceLayer::Blend { pictures: [low, high], share, .. } => {
                resize(context, &mut scratch.other, voxels.len())?;
                self.read_slice(&self.slices[*low], voxels, &mut scratch.mosaic)?;
                self.read_slice(&self.slices[*high], &mut scratch.other, &mut scratch.mosaic)?;
                self.interpolate(voxels, &scratch.other, *share);
            }
            SliceLayer::Masks(masks) => {
                self.read_masks(context, &self.slices[masks.clone()], voxels, scratch)?;
            }
            SliceLayer::Empty if self.gap_fill == GapFill::Interpolate => voxels.fill(T::UNMEASURED),
            SliceLayer::Empty => voxels.fill(T::default()),
        }
        Ok(())
    }

    /// Interpolates `voxels` towards `others` by `share`; padding in either gives padding.
    fn interpolate<T: VoxelNumber>(&self, voxels: &mut [T], others: &[T], share: f64) {
        for (voxel, other) in voxels.iter_mut().zip(others) {
            let (low, high) = (voxel.value(), other.value());
            *voxel = match self.padding {
                Some(padding) if low == padding || high == padding => T::from_float(padding),
                _ => T::from_mean(low + (high - low) * share),
            };
        }
    }

    /// Reads a label layer from masks: each voxel gets the segment with the largest share, at least a half; at equal
    /// shares the one with the highest number.
    fn read_masks<T: VoxelNumber>(
        &self,
        context: LoadContext<'_>,
        masks: &[DicomSlice],
        voxels: &mut [T],
        scratch: &mut ImageBuffers<T>,
    ) -> Result<(), VolumeReadError> {
        let ImageBuffers { other, shares, mosaic, .. } = scratch;
        resize(context, other, voxels.len())?;
        resize(context, shares, voxels.len())?;
        voxels.fill(T::default());
        shares.fill(T::default());
        let mut overlapping = 0;
        for mask in masks {
            self.read_slice(mask, other, mosaic)?;
            let number = f64::from(mask.plane.segment.unwrap_or(1));
            for ((voxel, share), value) in voxels.iter_mut().zip(shares.iter_mut()).zip(other.iter()) {
                let value = value.value();
                if value <= 0.0 || 2.0 * value < self.full_mask_value {
                    continue;
                }
                let (before, known) = (voxel.value(), share.value());
                overlapping += u64::from(known > 0.0 && before != number);
                if value > known || value == known && number > before {
                    (*voxel, *share) = (T::from_float(number), T::from_float(value));
                }
            }
        }
        self.overlapping.fetch_add(overlapping, Ordering::Relaxed);
        Ok(())
    }

    /// Reads a slice; `mosaic` is a buffer for the whole image that a tile is cut from.
    pub(super) fn read_slice<T: VoxelNumber>(
        &self,
        slice: &DicomSlice,
        voxels: &mut [T],
        mosaic: &mut Vec<T>,
    ) -> Result<(), VolumeReadError> {
        let header = &self.headers[slice.file];
        let context = LoadContext { operation: READ_FILE, path: &header.path };
        let Some(store) = &self.stores[slice.file] else { return Ok(()) };
        let scale = self.has_own_scales.then(|| slice.plane.scale());
        let raster = PixelConversion { scale, shape: store.shape(), ..self.raster };
        let read = match slice.tile.zip(Mosaic::new(header)) {
            None => store.read(context, slice.frame, raster, voxels, self.control),
            Some((tile, layout)) => {
                resize(context, mosaic, store.shape().pixel_count())?;
                let read = store.read(context, slice.frame, raster, mosaic, self.control);
                read.map(|()| layout.copy_tile(tile, mosaic, voxels))
            }
        };
        read.map_err(|error| match error.kind() {
            LoadErrorKind::BadInput => {
                VolumeReadError::Unreadable { pictures: Vec::new(), total: 0, why: error }
            }
            _ => VolumeReadError::Load(error),
        })
    }
}

/// Allocates an empty vector for this many voxels.
pub(super) fn reserve_voxels<T>(context: LoadContext<'_>, count: usize) -> Result<Vec<T>, LoadError> {
    alloc_with_capacity(count).map_err(|_no_memory| no_memory(context, count))
}

/// Makes the error for voxels that do not fit in memory.
pub(super) fn no_memory(context: LoadContext<'_>, count: usize) -> LoadError {
    context.limit_error(
        "data",
        format!("there is not enough memory for {count} voxels"),
        "close other programs",
    )
}

fn resize<T: VoxelNumber>(
    context: LoadContext<'_>,
    voxels: &mut Vec<T>,
    count: usize,
) -> Result<(), LoadError> {
    if voxels.len() != count {
        *voxels = reserve_voxels(context, count)?;
        voxels.resize(count, T::default());
    }
    Ok(())
}
