//! The voxels of slices: each is read, unpacked and rescaled on a core of its own.

use rayon::prelude::*;

use super::super::number::Part;
use super::super::placement::{Parts, Placement};
use super::super::rescaled::rescaled;
use super::super::samples::reserve;
use super::super::{Endian, LoadControl, LoadError, LoadOptions};
use super::groups::Slice;
use super::header::Header;
use super::pixels::raster::{Raster, Voxel};
use super::pixels::shape::Shape;
use super::pixels::store::Store;
use super::{WHAT, hints};
use crate::data::attempt::{Attempt, Extent};
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
    extent: Extent,
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
    let extent = Extent::checked(attempt, "Rows, Columns", dims, voxel_type, options.memory_budget_bytes)?;
    let stores = stores(headers, shape, slices, options, control)?;
    let raster = Raster { shape, endian: Endian::Little, part, scale: None };
    let slices_of = Slices { headers, stores: &stores, order: slices, raster, is_scaled, extent, control };
    let samples = slices_of.read(attempt, voxel_type)?;
    let samples = if is_scaled || shape.samples > 1 {
        samples
    } else {
        rescaled(attempt, samples, scale, options.memory_budget_bytes)?
    };
    let found = &headers[first.file].found;
    let hints = hints::hints(found, &shape, first, (!is_scaled).then_some(scale));
    placement.remarks.extend(hints::remarks(found, &shape, options.choice.component.is_some()));
    Parts { name, dims: extent.dims, placement, samples, hints }.volume(attempt)
}

/// Finds the pixels of all files that have some of the slices.
fn stores(
    headers: &[Header],
    shape: Shape,
    slices: &[Slice],
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
    fn read(&self, attempt: Attempt<'_>, voxel_type: VoxelType) -> Result<Samples, LoadError> {
        match voxel_type {
            VoxelType::U8 => self.voxels(attempt).map(Samples::U8),
            VoxelType::I8 => self.voxels(attempt).map(Samples::I8),
            VoxelType::U16 => self.voxels(attempt).map(Samples::U16),
            VoxelType::I16 => self.voxels(attempt).map(Samples::I16),
            VoxelType::U32 => self.voxels(attempt).map(Samples::U32),
            VoxelType::I32 => self.voxels(attempt).map(Samples::I32),
            VoxelType::F32 => self.voxels(attempt).map(Samples::F32),
            VoxelType::F64 => self.voxels(attempt).map(Samples::F64),
        }
    }

    fn voxels<T: Voxel>(&self, attempt: Attempt<'_>) -> Result<Vec<T>, LoadError> {
        let of_slice = self.raster.shape.pixels();
        // The first picture, before there is room for all: one that is not what its header says asks for none.
        if let Some(first) = self.order.first() {
            let mut room = reserved(attempt, of_slice)?;
            room.resize(of_slice, T::default());
            self.slice(first, &mut room)?;
        }
        let mut voxels: Vec<T> = reserved(attempt, self.extent.voxels)?;
        voxels.resize(self.extent.voxels, T::default());
        self.control.start(self.extent.bytes);
        voxels.par_chunks_mut(of_slice).zip(self.order.par_iter()).try_for_each(|(voxels, slice)| {
            self.control.check()?;
            self.slice(slice, voxels)?;
            self.control.advance(size_of_val(voxels) as u64);
            Ok(())
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
    reserve(count).map_err(|_no_memory| {
        attempt.limit("data", format!("the memory for {count} voxels is not there"), "close other programs")
    })
}
