//! Voxels of a layer, from its slices: one slice, a blend of two, or a label layer from masks of segments.

use std::sync::atomic::{AtomicU64, Ordering};

use super::super::samples::reserve;
use super::super::{LoadControl, LoadError};
use super::WHAT;
use super::header::Header;
use super::layer::{Filling, Layer, Slice};
use super::mosaic::Mosaic;
use super::pixels::raster::{Raster, Voxel};
use super::pixels::store::Store;
use crate::data::attempt::Attempt;
use crate::data::load::LoadErrorKind;

/// Reason why a volume was not read.
#[derive(Debug)]
pub(super) enum Fault {
    /// Fatal error: no volume can be read.
    Load(LoadError),
    /// Unreadable slices, by their indices, among `total`; `why` is the error of the first.
    Unreadable { pictures: Vec<usize>, total: usize, why: LoadError },
}

impl From<LoadError> for Fault {
    fn from(error: LoadError) -> Self {
        Self::Load(error)
    }
}

/// Slices that layers are made from, and the conversion of their pixels to voxels.
pub(super) struct Source<'a> {
    pub(super) headers: &'a [Header],
    /// Pixel stores of the files, by file index; `None` for files without slices to read.
    pub(super) stores: &'a [Option<Store>],
    pub(super) slices: &'a [Slice],
    pub(super) filling: Filling,
    pub(super) raster: Raster,
    /// True if each slice has its own slope and intercept.
    pub(super) is_scaled: bool,
    /// Padding value, as stored in the file.
    pub(super) padding: Option<f64>,
    /// Value of a mask pixel that lies entirely in its segment.
    pub(super) most_fraction: f64,
    /// Number of voxels found so far that lie in several segments.
    pub(super) overlapping: AtomicU64,
    pub(super) control: &'a LoadControl,
}

/// Reusable buffers for images, one set per worker thread.
#[derive(Debug)]
pub(super) struct Scratch<T> {
    whole: Vec<T>,
    other: Vec<T>,
    shares: Vec<T>,
    mosaic: Vec<T>,
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { whole: Vec::new(), other: Vec::new(), shares: Vec::new(), mosaic: Vec::new() }
    }
}

impl<T: Voxel> Scratch<T> {
    /// Takes the buffer for a whole image, resized to this many pixels.
    pub(super) fn taken_whole(&mut self, attempt: Attempt<'_>, pixels: usize) -> Result<Vec<T>, LoadError> {
        let mut whole = std::mem::take(&mut self.whole);
        resize(attempt, &mut whole, pixels)?;
        Ok(whole)
    }

    /// Puts the buffer of a whole image back for reuse.
    pub(super) fn give_back(&mut self, whole: Vec<T>) {
        self.whole = whole;
    }
}

impl Source<'_> {
    /// Reads the voxels of a layer.
    pub(super) fn layer<T: Voxel>(
        &self,
        attempt: Attempt<'_>,
        layer: &Layer,
        voxels: &mut [T],
        scratch: &mut Scratch<T>,
    ) -> Result<(), Fault> {
        match layer {
            Layer::Picture(picture) => {
                self.picture(&self.slices[*picture], voxels, &mut scratch.mosaic)?;
            }
            Layer::Between { is_missing: true, .. } if self.filling == Filling::NoSegment => {
                voxels.fill(T::default());
            }
            Layer::Between { pictures: [low, high], share, .. } if self.filling != Filling::Means => {
                let nearest = if *share < 0.5 { low } else { high };
                self.picture(&self.slices[*nearest], voxels, &mut scratch.mosaic)?;
            }
            Layer::Between { pictures: [low, high], share, .. } => {
                resize(attempt, &mut scratch.other, voxels.len())?;
                self.picture(&self.slices[*low], voxels, &mut scratch.mosaic)?;
                self.picture(&self.slices[*high], &mut scratch.other, &mut scratch.mosaic)?;
                self.mix(voxels, &scratch.other, *share);
            }
            Layer::Masks(masks) => self.masks(attempt, &self.slices[masks.clone()], voxels, scratch)?,
            Layer::Empty if self.filling == Filling::Means => voxels.fill(T::NOTHING),
            Layer::Empty => voxels.fill(T::default()),
        }
        Ok(())
    }

    /// Interpolates `voxels` towards `others` by `share`; padding in either gives padding.
    fn mix<T: Voxel>(&self, voxels: &mut [T], others: &[T], share: f64) {
        for (voxel, other) in voxels.iter_mut().zip(others) {
            let (low, high) = (voxel.value(), other.value());
            *voxel = match self.padding {
                Some(padding) if low == padding || high == padding => T::of_float(padding),
                _ => T::of_mean(low + (high - low) * share),
            };
        }
    }

    /// Reads a label layer from masks: each voxel gets the segment with the largest share, at least a half; at equal
    /// shares the one with the highest number.
    fn masks<T: Voxel>(
        &self,
        attempt: Attempt<'_>,
        masks: &[Slice],
        voxels: &mut [T],
        scratch: &mut Scratch<T>,
    ) -> Result<(), Fault> {
        let Scratch { other, shares, mosaic, .. } = scratch;
        resize(attempt, other, voxels.len())?;
        resize(attempt, shares, voxels.len())?;
        voxels.fill(T::default());
        shares.fill(T::default());
        let mut overlapping = 0;
        for mask in masks {
            self.picture(mask, other, mosaic)?;
            let number = f64::from(mask.plane.segment.unwrap_or(1));
            for ((voxel, share), value) in voxels.iter_mut().zip(shares.iter_mut()).zip(other.iter()) {
                let value = value.value();
                if value <= 0.0 || 2.0 * value < self.most_fraction {
                    continue;
                }
                let (before, known) = (voxel.value(), share.value());
                overlapping += u64::from(known > 0.0 && before != number);
                if value > known || value == known && number > before {
                    (*voxel, *share) = (T::of_float(number), T::of_float(value));
                }
            }
        }
        self.overlapping.fetch_add(overlapping, Ordering::Relaxed);
        Ok(())
    }

    /// Reads a slice; `mosaic` is a buffer for the whole image that a tile is cut from.
    pub(super) fn picture<T: Voxel>(
        &self,
        slice: &Slice,
        voxels: &mut [T],
        mosaic: &mut Vec<T>,
    ) -> Result<(), Fault> {
        let header = &self.headers[slice.file];
        let attempt = Attempt { what: WHAT, path: &header.path };
        let Some(store) = &self.stores[slice.file] else { return Ok(()) };
        let scale = self.is_scaled.then(|| slice.plane.scale());
        let raster = Raster { scale, shape: store.shape(), ..self.raster };
        let read = match slice.tile.zip(Mosaic::new(header)) {
            None => store.read(attempt, slice.frame, raster, voxels, self.control),
            Some((tile, layout)) => {
                resize(attempt, mosaic, store.shape().pixels())?;
                let read = store.read(attempt, slice.frame, raster, mosaic, self.control);
                read.map(|()| layout.pick(tile, mosaic, voxels))
            }
        };
        read.map_err(|error| match error.kind() {
            LoadErrorKind::BadInput => Fault::Unreadable { pictures: Vec::new(), total: 0, why: error },
            _ => Fault::Load(error),
        })
    }
}

/// Allocates an empty vector for this many voxels.
pub(super) fn reserved<T>(attempt: Attempt<'_>, count: usize) -> Result<Vec<T>, LoadError> {
    reserve(count).map_err(|_no_memory| no_memory(attempt, count))
}

/// Makes the error for voxels that do not fit in memory.
pub(super) fn no_memory(attempt: Attempt<'_>, count: usize) -> LoadError {
    attempt.limit("data", format!("the memory for {count} voxels is not there"), "close other programs")
}

fn resize<T: Voxel>(attempt: Attempt<'_>, voxels: &mut Vec<T>, count: usize) -> Result<(), LoadError> {
    if voxels.len() != count {
        *voxels = reserved(attempt, count)?;
        voxels.resize(count, T::default());
    }
    Ok(())
}
