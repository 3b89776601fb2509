//! How the voxels of a layer are made of pictures: as they are, between two, or from the masks of segments.

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

/// Why a volume was not read.
#[derive(Debug)]
pub(super) enum Fault {
    /// It cannot be.
    Load(LoadError),
    /// These pictures, by their numbers, of so many; and why the first of them.
    Unreadable { pictures: Vec<usize>, total: usize, why: LoadError },
}

impl From<LoadError> for Fault {
    fn from(error: LoadError) -> Self {
        Self::Load(error)
    }
}

/// Pictures that layers are made of, and how their pixels become voxels.
pub(super) struct Source<'a> {
    pub(super) headers: &'a [Header],
    /// Of the files that have slices among these.
    pub(super) stores: &'a [Option<Store>],
    pub(super) slices: &'a [Slice],
    pub(super) filling: Filling,
    pub(super) raster: Raster,
    /// Each slice has a slope and an intercept of its own.
    pub(super) is_scaled: bool,
    /// As it is stored.
    pub(super) padding: Option<f64>,
    /// The value of a mask that is all of a segment.
    pub(super) most_fraction: f64,
    /// Voxels of several segments, so far.
    pub(super) overlapping: AtomicU64,
    pub(super) control: &'a LoadControl,
}

/// Room for pictures, which one core needs again and again.
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
    /// A picture of so many pixels.
    pub(super) fn taken_whole(&mut self, attempt: Attempt<'_>, pixels: usize) -> Result<Vec<T>, LoadError> {
        let mut whole = std::mem::take(&mut self.whole);
        resize(attempt, &mut whole, pixels)?;
        Ok(whole)
    }

    /// Takes back a picture that was taken.
    pub(super) fn give_back(&mut self, whole: Vec<T>) {
        self.whole = whole;
    }
}

impl Source<'_> {
    /// Reads a layer.
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

    /// Adds this share of other voxels to the rest of these; where either is padding, there is padding.
    fn mix<T: Voxel>(&self, voxels: &mut [T], others: &[T], share: f64) {
        for (voxel, other) in voxels.iter_mut().zip(others) {
            let (low, high) = (voxel.value(), other.value());
            *voxel = match self.padding {
                Some(padding) if low == padding || high == padding => T::of_float(padding),
                _ => T::of_mean(low + (high - low) * share),
            };
        }
    }

    /// Numbers of segments where their masks are: where several are, that of the largest share, or else the highest.
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

    /// Reads a picture, or its part; `mosaic` has room for the whole that it is a part of.
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

/// Room for so many voxels.
pub(super) fn reserved<T>(attempt: Attempt<'_>, count: usize) -> Result<Vec<T>, LoadError> {
    reserve(count).map_err(|_no_memory| no_memory(attempt, count))
}

/// The error that there is no room for so many voxels.
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
