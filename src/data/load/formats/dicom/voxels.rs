//! The voxels of slices: each is read, unpacked and rescaled on a core of its own.

use rayon::prelude::*;

use super::super::number::Part;
use super::super::placement::{Parts, Placement};
use super::super::rescaled::rescaled;
use super::super::samples::reserve;
use super::super::voxels::{Meant, NoMeans, Voxels, averaged};
use super::super::{Endian, LoadControl, LoadError, LoadOptions};
use super::groups::Slice;
use super::header::Header;
use super::pixels::raster::{Raster, Voxel};
use super::pixels::shape::Shape;
use super::pixels::store::Store;
use super::{WHAT, hints};
use crate::data::attempt::{Attempt, Extent, Kept};
use crate::data::{Samples, Volume, VoxelType};

/// Slices, and how their pixels become voxels.
struct Slices<'a> {
    headers: &'a [Header],
    /// Of the files that have slices among these.
    stores: &'a [Option<Store>],
    order: &'a [Slice],
    raster: Raster,
    /// Each slice has a slope and an intercept of its own.
    is_scaled: bool,
    control: &'a LoadControl,
}

/// The volume of slices in order.
#[expect(clippy::too_many_arguments, reason = "all that was found out of a volume, once")]
pub(super) fn load(
    attempt: Attempt<'_>,
    name: String,
    headers: &[Header],
    shape: Shape,
    slices: &[Slice],
    mut placement: Placement,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, LoadError> {
    let component = options.choice.component_among(shape.samples, shape.samples > 1);
    let part = Part::asked(attempt, component, shape.samples, shape.samples > 1)?;
    let Some(first) = slices.first() else {
        return Err(attempt.bad_input(
            "Number of Frames",
            "it has no frames",
            "copy or export the file again",
        ));
    };
    let scale = first.plane.scale();
    // What colours are called is not rescaled.
    let is_scaled = shape.samples == 1 && slices.iter().any(|slice| slice.plane.scale() != scale);
    let voxel_type = match shape.voxel_type() {
        VoxelType::U32 | VoxelType::I32 | VoxelType::F64 if is_scaled => VoxelType::F64,
        _ if is_scaled => VoxelType::F32,
        stored => stored,
    };
    let dims = [shape.columns as u64, shape.rows as u64, slices.len() as u64];
    let extent = Extent::checked(attempt, "Rows, Columns", dims, voxel_type, options.room(control))?;
    let stores = stores(headers, shape, extent.read.slices().map(|slice| slices[slice]), options, control)?;
    let raster = Raster { shape, endian: Endian::Little, part, scale: None };
    let slices_of = Slices { headers, stores: &stores, order: slices, raster, is_scaled, control };
    let found = &headers[first.file].found;
    let hints = hints::hints(found, &shape, first, (!is_scaled).then_some(scale));
    let values = |samples| {
        if is_scaled || shape.samples > 1 {
            Ok(samples)
        } else {
            rescaled(attempt, samples, scale, options.memory_budget_bytes)
        }
    };
    let meant = Meant { padding: hints.padding, values: &values };
    let voxels = slices_of.read(attempt, &extent.read, voxel_type, &meant)?;
    placement.remarks.extend(hints::remarks(found, &shape, options.choice.component.is_some()));
    Parts { name, extent, placement, voxels, hints }.volume(attempt)
}

/// Finds the pixels of all files that have some of the slices.
fn stores(
    headers: &[Header],
    shape: Shape,
    slices: impl Iterator<Item = Slice>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Vec<Option<Store>>, LoadError> {
    let mut is_used = vec![false; headers.len()];
    for slice in slices {
        is_used[slice.file] = true;
    }
    let found = headers.par_iter().zip(is_used).map(|(header, is_used)| {
        control.check()?;
        is_used.then(|| Store::of(header, shape, options.memory_budget_bytes, control)).transpose()
    });
    found.collect()
}

impl Slices<'_> {
    /// Reads what is kept.
    fn read(
        &self,
        attempt: Attempt<'_>,
        kept: &Kept,
        voxel_type: VoxelType,
        meant: &Meant<'_>,
    ) -> Result<Voxels, LoadError> {
        let boxed = kept.boxed_if_averaged();
        // The first picture, before there is room for all: one that is not what its header says asks for none.
        let first = kept.low[2];
        let one = Kept { low: [0, 0, first], high: [1, 1, first + 1], ..Kept::all(kept.grid) };
        self.stretch(attempt, &one, voxel_type)?;
        self.control.start(Extent::sized(boxed.dims(), voxel_type).bytes);
        if !kept.is_averaged {
            return Ok((meant.values)(self.stretch(attempt, &boxed, voxel_type)?)?.into());
        }
        averaged(kept, voxel_type.bytes(), meant, self.control, |slices| {
            let (mut low, mut high) = (boxed.low, boxed.high);
            (low[2], high[2]) = (boxed.low[2] + slices.start, boxed.low[2] + slices.end);
            self.stretch(attempt, &Kept { low, high, ..boxed }, voxel_type)
        })
        .map_err(|why| match why {
            NoMeans::Unread(error) => error,
            NoMeans::NoMemory => no_memory(attempt, kept.count()),
        })
    }

    /// Reads voxels that are not averaged.
    fn stretch(
        &self,
        attempt: Attempt<'_>,
        kept: &Kept,
        voxel_type: VoxelType,
    ) -> Result<Samples, LoadError> {
        match voxel_type {
            VoxelType::U8 => self.voxels(attempt, kept).map(Samples::U8),
            VoxelType::I8 => self.voxels(attempt, kept).map(Samples::I8),
            VoxelType::U16 => self.voxels(attempt, kept).map(Samples::U16),
            VoxelType::I16 => self.voxels(attempt, kept).map(Samples::I16),
            VoxelType::U32 => self.voxels(attempt, kept).map(Samples::U32),
            VoxelType::I32 => self.voxels(attempt, kept).map(Samples::I32),
            VoxelType::F32 => self.voxels(attempt, kept).map(Samples::F32),
            VoxelType::F64 => self.voxels(attempt, kept).map(Samples::F64),
        }
    }

    fn voxels<T: Voxel>(&self, attempt: Attempt<'_>, kept: &Kept) -> Result<Vec<T>, LoadError> {
        let [width, height, _] = kept.dims();
        let mut voxels: Vec<T> = reserved(attempt, kept.count())?;
        voxels.resize(kept.count(), T::default());
        let slices: Vec<&Slice> = kept.slices().map(|slice| &self.order[slice]).collect();
        let is_whole = [width, height] == [kept.grid[0], kept.grid[1]];
        let chunks = voxels.par_chunks_mut(width * height).zip(slices.par_iter());
        chunks.try_for_each_init(Vec::new, |whole: &mut Vec<T>, (voxels, slice)| {
            self.control.check()?;
            if is_whole {
                self.slice(slice, voxels)?;
            } else {
                if whole.is_empty() {
                    *whole = reserved(attempt, self.raster.shape.pixels())?;
                    whole.resize(self.raster.shape.pixels(), T::default());
                }
                self.slice(slice, whole)?;
                kept.pick_in_slice(whole, voxels);
            }
            self.control.advance(size_of_val(voxels) as u64);
            Ok::<(), LoadError>(())
        })?;
        Ok(voxels)
    }

    fn slice<T: Voxel>(&self, slice: &Slice, voxels: &mut [T]) -> Result<(), LoadError> {
        let attempt = Attempt { what: WHAT, path: &self.headers[slice.file].path };
        let Some(store) = &self.stores[slice.file] else { return Ok(()) };
        let scale = self.is_scaled.then(|| slice.plane.scale());
        store.read(attempt, slice.frame, Raster { scale, ..self.raster }, voxels, self.control)
    }
}

fn reserved<T>(attempt: Attempt<'_>, count: usize) -> Result<Vec<T>, LoadError> {
    reserve(count).map_err(|_no_memory| no_memory(attempt, count))
}

fn no_memory(attempt: Attempt<'_>, count: usize) -> LoadError {
    attempt.limit("data", format!("the memory for {count} voxels is not there"), "close other programs")
}
