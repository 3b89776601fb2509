//! Voxels of a DICOM volume: layers are read, decompressed and rescaled in parallel.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::super::number::Part;
use super::super::placement::Parts;
use super::super::rescaled::rescaled;
use super::super::voxels::{Meant, NoMeans, Voxels, averaged};
use super::super::{Endian, LoadControl, LoadError, LoadOptions};
use super::groups::shape_of;
use super::header::Header;
use super::hints;
use super::layer::{Filling, Layer, Slice};
use super::layers::{Fault, Scratch, Source, no_memory, reserved};
use super::pixels::raster::{Raster, Voxel};
use super::pixels::shape::Shape;
use super::pixels::store::Store;
use super::stack::StackedVolume;
use crate::data::attempt::{Attempt, Extent, Kept};
use crate::data::{Samples, Volume, VoxelType};

/// Volume to be read: its slices and layers, and the storage of their pixels.
pub(super) struct VolumeRequest<'a> {
    pub(super) name: String,
    pub(super) headers: &'a [Header],
    pub(super) shape: Shape,
    pub(super) filling: Filling,
    pub(super) has_masks: bool,
    pub(super) volume: StackedVolume,
}

/// Reads a volume.
///
/// # Errors
/// [`Fault::Unreadable`] lists the slices that cannot be read, if others can.
pub(super) fn load(
    attempt: Attempt<'_>,
    request: &VolumeRequest<'_>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Volume, Fault> {
    let VolumeRequest { shape, volume, .. } = request;
    let headers = request.headers;
    let StackedVolume { slices, layers, placement, .. } = volume;
    let component = options.choice.component_among(shape.samples, shape.samples > 1);
    let part = Part::asked(attempt, component, shape.samples, shape.samples > 1)?;
    let Some(first) = slices.first() else {
        let why = attempt.bad_input("Number of Frames", "it has no frames", "copy or export the file again");
        return Err(why.into());
    };
    let scale = if request.has_masks { [1.0, 0.0] } else { first.plane.scale() };
    // Colours and segment numbers are not rescaled.
    let is_scaled =
        shape.samples == 1 && !request.has_masks && slices.iter().any(|slice| slice.plane.scale() != scale);
    let voxel_type = request.voxel_type(is_scaled);
    let dims = [shape.columns as u64, shape.rows as u64, layers.len() as u64];
    let extent = Extent::checked(attempt, "Rows, Columns", dims, voxel_type, options.room(control))?;
    let is_read = extent.read.slices().flat_map(|layer| layers[layer].pictures()).map(|at| &slices[at]);
    let stores = stores(headers, is_read, options, control)?;
    let found = &headers[first.file].found;
    let hints = hints::hints(found, shape, first, (!is_scaled).then_some(scale), request.has_masks);
    let source = Source {
        headers,
        stores: &stores,
        slices,
        filling: request.filling,
        raster: Raster { shape: *shape, endian: Endian::Little, part, scale: None },
        is_scaled,
        padding: hints::stored_padding(found, shape).filter(|_| !is_scaled),
        most_fraction: hints::most_fraction(found),
        overlapping: AtomicU64::new(0),
        control,
    };
    let values = |samples| {
        if is_scaled || shape.samples > 1 {
            Ok(samples)
        } else {
            rescaled(attempt, samples, scale, options.memory_budget_bytes)
        }
    };
    let meant = Meant { padding: hints.padding, values: &values };
    let layers = Layers { source: &source, list: layers, shape: *shape };
    let voxels = layers.read(attempt, &extent.read, voxel_type, &meant);
    let voxels = voxels.map_err(|fault| layers.looked_into(&extent.read, fault))?;
    let mut placement = placement.clone();
    let is_unpacked = first.tile.is_some();
    let part = hints::ShownPart { is_component: options.choice.component.is_some(), is_unpacked };
    placement.remarks.extend(hints::remarks(&headers[first.file], shape, part));
    let overlapping = source.overlapping.load(Ordering::Relaxed);
    if overlapping > 0 {
        placement.remarks.push(format!(
            "segments overlap in {overlapping} voxels: of those that lie there {} is shown",
            hints::shown_of_overlapping(found)
        ));
    }
    let parts = Parts { name: request.name.clone(), extent, placement, voxels, hints };
    parts.volume(attempt).map_err(Fault::from)
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
        let has_nothing = self.filling == Filling::Means && layers.contains(&Layer::Empty);
        match self.shape.voxel_type() {
            VoxelType::U32 | VoxelType::I32 | VoxelType::F64 if is_scaled || has_nothing => VoxelType::F64,
            _ if is_scaled || has_nothing => VoxelType::F32,
            stored => stored,
        }
    }
}

/// Opens the pixel stores of all files that contribute a slice.
fn stores<'a>(
    headers: &[Header],
    slices: impl Iterator<Item = &'a Slice>,
    options: &LoadOptions,
    control: &LoadControl,
) -> Result<Vec<Option<Store>>, LoadError> {
    let mut is_used = vec![false; headers.len()];
    for slice in slices {
        is_used[slice.file] = true;
    }
    let found = headers.par_iter().zip(is_used).map(|(header, is_used)| {
        control.check()?;
        let store = || Store::of(header, shape_of(header)?, options.memory_budget_bytes, control);
        is_used.then(store).transpose()
    });
    found.collect()
}

/// Layers of a volume, with the source of their voxels.
struct Layers<'a> {
    source: &'a Source<'a>,
    list: &'a [Layer],
    shape: Shape,
}

impl Layers<'_> {
    /// Reads the kept part of the volume, averaged if requested.
    fn read(
        &self,
        attempt: Attempt<'_>,
        kept: &Kept,
        voxel_type: VoxelType,
        meant: &Meant<'_>,
    ) -> Result<Voxels, Fault> {
        let boxed = kept.boxed_if_averaged();
        // Reads one pixel of the first layer before memory for the volume is allocated: an image that contradicts its
        // header must not cost any.
        let first = kept.low[2];
        let one = Kept { low: [0, 0, first], high: [1, 1, first + 1], ..Kept::all(kept.grid) };
        self.stretch(attempt, &one, voxel_type)?;
        self.source.overlapping.store(0, Ordering::Relaxed);
        self.source.control.start(Extent::sized(boxed.dims(), voxel_type).bytes);
        if !kept.is_averaged {
            return Ok((meant.values)(self.stretch(attempt, &boxed, voxel_type)?)?.into());
        }
        averaged(kept, voxel_type.bytes(), meant, self.source.control, |slices| {
            let (mut low, mut high) = (boxed.low, boxed.high);
            (low[2], high[2]) = (boxed.low[2] + slices.start, boxed.low[2] + slices.end);
            self.stretch(attempt, &Kept { low, high, ..boxed }, voxel_type)
        })
        .map_err(|why| match why {
            NoMeans::Unread(fault) => fault,
            NoMeans::NoMemory => no_memory(attempt, kept.count()).into(),
        })
    }

    /// Reads a part of the volume without averaging, in the given type.
    fn stretch(&self, attempt: Attempt<'_>, kept: &Kept, voxel_type: VoxelType) -> Result<Samples, Fault> {
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

    fn voxels<T: Voxel>(&self, attempt: Attempt<'_>, kept: &Kept) -> Result<Vec<T>, Fault> {
        let [width, height, _] = kept.dims();
        let mut voxels: Vec<T> = reserved(attempt, kept.count())?;
        voxels.resize(kept.count(), T::default());
        let layers: Vec<&Layer> = kept.slices().map(|layer| &self.list[layer]).collect();
        let is_whole = [width, height] == [kept.grid[0], kept.grid[1]];
        let chunks = voxels.par_chunks_mut(width * height).zip(layers.par_iter());
        chunks.try_for_each_init(Scratch::default, |scratch: &mut Scratch<T>, (voxels, layer)| {
            self.source.control.check()?;
            if is_whole {
                self.source.layer(attempt, layer, voxels, scratch)?;
            } else {
                let mut whole = scratch.taken_whole(attempt, self.shape.pixels())?;
                self.source.layer(attempt, layer, &mut whole, scratch)?;
                kept.pick_in_slice(&whole, voxels);
                scratch.give_back(whole);
            }
            self.source.control.advance(size_of_val(voxels) as u64);
            Ok::<(), Fault>(())
        })?;
        Ok(voxels)
    }

    /// After a failure, tests all slices of the kept layers and lists every unreadable one, so that the others can be
    /// shown.
    fn looked_into(&self, kept: &Kept, fault: Fault) -> Fault {
        let Fault::Unreadable { why, .. } = fault else { return fault };
        let mut pictures: Vec<usize> = kept.slices().flat_map(|layer| self.list[layer].pictures()).collect();
        pictures.sort_unstable();
        pictures.dedup();
        let total = pictures.len();
        let looked = pictures.into_par_iter().map_init(Vec::new, |voxels: &mut Vec<f32>, picture| {
            self.source.control.check()?;
            let slice = &self.source.slices[picture];
            voxels.resize(self.shape.pixels(), 0.0);
            match self.source.picture(slice, voxels, &mut Vec::new()) {
                Ok(()) => Ok(None),
                Err(Fault::Unreadable { .. }) => Ok(Some(picture)),
                Err(Fault::Load(error)) => Err(error),
            }
        });
        match looked.collect::<Result<Vec<Option<usize>>, LoadError>>() {
            Ok(found) => Fault::Unreadable { pictures: found.into_iter().flatten().collect(), total, why },
            Err(error) => Fault::Load(error),
        }
    }
}
