//! Reading of a volume's voxels from an array, slab by slab: the chunks of a slab are decoded on all cores, and besides
//! the volume only a slab and a few chunks are in memory.

use std::io::{self, Read};
use std::ops::Range;

use rayon::prelude::*;

use super::super::container::{HELP, Hdf5File};
use super::box_copy::ElementBox;
use super::chunk_index::{ChunkGrid, StoredChunk};
use super::filters::FilterFault;
use super::{DataLayout, Hdf5Array};
use crate::reading::number::VoxelEncoding;
use crate::reading::samples::{ReadFault, VoxelLayout, alloc_zeroed};
use crate::reading::voxels::{ReadVoxels, ValueMapping};
use chiaroscuro_volume::{GridExtent, LoadError, ResolvedPortion, human_bytes};

/// Bytes of chunks that are decoded at a time: enough for all cores, small against a volume.
const AT_ONCE_BYTES: u64 = 16 << 20;

/// Largest expansion of a file that has few chunks or compresses well; a volume beyond it is an error of the header.
const MAX_EXPANSION: u64 = 4096;
const EXPANSION_BYTES: u64 = 64 << 20;

/// Largest number of chunks of a volume that a small file may state, most of which were never written.
const MAX_EMPTY_CHUNKS: u64 = 1 << 20;

/// Volume in an array.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ArrayView {
    /// First element along each dimension of the array; those of other dimensions than the following select.
    pub(crate) first: Vec<u64>,
    /// Dimension of the array along x, y and z; `None` where the volume has one voxel.
    pub(crate) axes: [Option<usize>; 3],
    /// Dimension of the components of a voxel.
    pub(crate) component_axis: Option<usize>,
    /// Voxels along x, y and z.
    pub(crate) dims: [u64; 3],
}

/// Reads the selected voxels of a volume in an array. `name` is that of the array, for messages; `mapping` and `budget`
/// as for other readers.
pub(crate) fn read_view(
    file: &Hdf5File<'_>,
    (name, array): (&str, &Hdf5Array),
    view: &ArrayView,
    (stored, extent): (&VoxelEncoding, GridExtent),
    (mapping, budget_bytes): (&ValueMapping<'_>, u64),
) -> Result<ReadVoxels, LoadError> {
    let limit = file.length().saturating_mul(MAX_EXPANSION).saturating_add(EXPANSION_BYTES);
    let stored_bytes = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
    let is_stored_whole =
        matches!(array.layout, DataLayout::Contiguous { address: Some(_) } | DataLayout::Compact(_));
    if stored_bytes > if is_stored_whole { file.length() } else { limit } {
        let why = format!(
            "it has {} of voxels, more than a file of {} can hold",
            human_bytes(extent.bytes.into()),
            human_bytes(file.length().into())
        );
        return Err(file.broken(name, why));
    }
    let counts =
        (0..3).map(|at| view.dims[at].div_ceil(view.axes[at].map_or(1, |axis| array.block_shape()[axis])));
    let chunks = counts.fold(1, u64::saturating_mul);
    if matches!(array.layout, DataLayout::Chunks { .. }) && chunks > file.length() / 4 + MAX_EMPTY_CHUNKS {
        let why = format!(
            "it has {chunks} chunks, more than a file of {} can hold",
            human_bytes(file.length().into())
        );
        return Err(file.broken(name, why));
    }
    let kept = extent.read;
    let needed = extent.restricted_to_slices(stored.voxel_type());
    // Only the box of each slice is handed on.
    let [width, height, _] = kept.box_dims();
    let grid = [width, height, needed.read.grid[2]];
    let ([_, _, low], [_, _, high]) = (needed.read.low, needed.read.high);
    let part = ResolvedPortion { grid, low: [0, 0, low], high: [width, height, high], ..needed.read };
    let boxed = GridExtent { wanted: part, read: part, ..GridExtent::unchecked(grid, stored.voxel_type()) };
    let slices: Vec<usize> = kept.slices().collect();
    let mut reader = BoxSlabReader::new(file, (name, array), view, stored, (kept, slices), budget_bytes)?;
    let read = stored.read_values(&mut reader, None, boxed, mapping, file.control());
    let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    match (read, reader.failed) {
        (_, Some(error)) => Err(error),
        (Err(fault), None) => Err(fault.into_error(file.context(), &layout, "bytes", HELP)),
        // Stored metadata alone make no volume.
        (Ok(_), None) if !reader.has_chunks => Err(file.context().bad_input_error(
            name,
            "none of its voxels was ever written",
            "wait for the program that writes it, or choose another array with --array",
        )),
        (Ok(voxels), None) => Ok(voxels),
    }
}

/// Byte of the file at which the voxels of a volume begin that lie there one after another; `None` for others.
pub(crate) fn contiguous_start(file: &Hdf5File<'_>, array: &Hdf5Array, view: &ArrayView) -> Option<u64> {
    let DataLayout::Contiguous { address: Some(address) } = array.layout else { return None };
    let ArrayView { first, axes, component_axis, dims } = view;
    // Volume's dimensions, fastest first, must be the fastest of the array, and whole.
    let mut rest = (0..first.len()).rev();
    let is_next = |axis: Option<usize>, rest: &mut dyn Iterator<Item = usize>| {
        axis.is_none_or(|axis| rest.next() == Some(axis))
    };
    let is_whole = |(axis, length): (Option<usize>, u64)| {
        axis.is_none_or(|axis| first[axis] == 0 && array.shape[axis] == length)
    };
    let in_order = is_next(*component_axis, &mut rest) && axes.iter().all(|axis| is_next(*axis, &mut rest));
    let are_whole = axes.iter().copied().zip(*dims).all(is_whole);
    let before = array
        .shape
        .iter()
        .zip(first)
        .fold(0u64, |number, (length, first)| number.saturating_mul(*length).saturating_add(*first));
    let start = before.saturating_mul(array.element_bytes as u64).saturating_add(address);
    (in_order && are_whole && !array.shape.contains(&0)).then(|| file.position(start))
}

/// Reader of the boxes of all needed slices, one after another.
struct BoxSlabReader<'a, 'f> {
    file: &'a Hdf5File<'f>,
    name: &'a str,
    array: &'a Hdf5Array,
    view: &'a ArrayView,
    /// Portion of the volume that is kept.
    kept: ResolvedPortion,
    /// Indices of the needed slices.
    slices: Vec<usize>,
    /// Position in `slices` after those in the slab.
    next: usize,
    /// Slices along z that one row of blocks has.
    block_slices: usize,
    block_shape: Vec<u64>,
    block_bytes: usize,
    /// Bytes of a voxel, and of the box of a slice.
    voxel_bytes: usize,
    slice_bytes: usize,
    /// Slices of the slab that are handed out, in bytes of `slab`.
    ready: Vec<Range<usize>>,
    slab: Vec<u8>,
    /// True once a chunk was found.
    has_chunks: bool,
    /// Error that ended the stream, since [`Read`] can only return [`io::Error`].
    failed: Option<LoadError>,
}

impl<'a, 'f> BoxSlabReader<'a, 'f> {
    fn new(
        file: &'a Hdf5File<'f>,
        (name, array): (&'a str, &'a Hdf5Array),
        view: &'a ArrayView,
        stored: &VoxelEncoding,
        (kept, slices): (ResolvedPortion, Vec<usize>),
        budget_bytes: u64,
    ) -> Result<Self, LoadError> {
        let block_shape = array.block_shape();
        let element = array.element_bytes as u64;
        let block_bytes = block_shape.iter().fold(element, |bytes, &n| bytes.saturating_mul(n));
        let [width, height, _] = kept.box_dims().map(|n| n as u64);
        let slice_bytes = width.saturating_mul(height).saturating_mul(stored.voxel_bytes());
        let depth = view.axes[2].map_or(1, |axis| block_shape[axis]).min(view.dims[2].max(1));
        let needed = block_bytes.saturating_add(slice_bytes.saturating_mul(depth));
        let limit = budget_bytes.max(EXPANSION_BYTES);
        let (true, Ok(block_bytes), Ok(slice_bytes)) =
            (needed <= limit, usize::try_from(block_bytes), usize::try_from(slice_bytes))
        else {
            let why = format!(
                "its chunks of {} need {}, {} are allowed",
                words(&block_shape),
                human_bytes(needed.into()),
                human_bytes(limit.into())
            );
            return Err(file.context().limit_error(
                name,
                why,
                "write it with smaller chunks: h5repack -l CHUNK=64x64x64 IN OUT",
            ));
        };
        Ok(Self {
            file,
            name,
            array,
            view,
            kept,
            slices,
            next: 0,
            block_slices: depth.max(1) as usize,
            block_shape,
            block_bytes,
            voxel_bytes: stored.voxel_bytes() as usize,
            slice_bytes,
            ready: Vec::new(),
            slab: Vec::new(),
            has_chunks: false,
            failed: None,
        })
    }

    /// Reads the next row of blocks with needed slices; returns false if there is none.
    fn read_slab(&mut self) -> Result<bool, LoadError> {
        let Some(&first) = self.slices.get(self.next) else { return Ok(false) };
        // Blocks begin at the first element of the array.
        let offset = self.view.axes[2].map_or(0, |axis| self.view.first[axis]) as usize;
        let row_end = ((first + offset) / self.block_slices + 1) * self.block_slices - offset;
        let in_row = self.slices[self.next..].iter().take_while(|&&z| z < row_end).count();
        let slices = &self.slices[self.next..self.next + in_row];
        let last = slices.last().copied().unwrap_or(first);
        let length = (last + 1 - first) * self.slice_bytes;
        self.ready = slices
            .iter()
            .rev()
            .map(|z| (z - first) * self.slice_bytes..(z - first + 1) * self.slice_bytes)
            .collect();
        self.next += in_row;
        self.allocate(length)?;
        let wanted = self.element_box(first..last + 1);
        self.read_box(&wanted)?;
        Ok(true)
    }

    /// Fills the slab with elements that were never written.
    fn allocate(&mut self, length: usize) -> Result<(), LoadError> {
        if self.slab.len() < length {
            self.slab = Vec::new();
            self.slab = alloc_zeroed(length).map_err(|_no_memory: ReadFault| {
                let why = format!("there is not enough memory for a slab of {}", human_bytes(length as u128));
                self.file.context().limit_error(self.name, why, "close other programs")
            })?;
        }
        match &self.array.fill {
            Some(fill) => {
                self.slab[..length]
                    .chunks_mut(fill.len())
                    .for_each(|element| element.copy_from_slice(&fill[..element.len()]));
            }
            None => self.slab[..length].fill(0),
        }
        Ok(())
    }

    /// Box of the array that has some slices.
    fn element_box(&self, slices: Range<usize>) -> ElementBox {
        let ArrayView { first, axes, component_axis, .. } = self.view;
        let element = self.array.element_bytes;
        let rank = first.len();
        let [width, _, _] = self.kept.box_dims();
        let strides = [self.voxel_bytes, self.voxel_bytes * width, self.slice_bytes];
        let low = [self.kept.low[0], self.kept.low[1], slices.start];
        let high = [self.kept.high[0], self.kept.high[1], slices.end];
        let mut wanted =
            ElementBox { low: first.clone(), counts: vec![1; rank], strides: vec![0; rank], element };
        for at in 0..3 {
            if let Some(axis) = axes[at] {
                wanted.low[axis] += low[at] as u64;
                wanted.counts[axis] = (high[at] - low[at]) as u64;
                wanted.strides[axis] = strides[at];
            }
        }
        if let Some(axis) = *component_axis {
            wanted.counts[axis] = (self.voxel_bytes / element) as u64;
            wanted.strides[axis] = element;
        }
        wanted
    }

    /// Reads the blocks of a box into the slab.
    fn read_box(&mut self, wanted: &ElementBox) -> Result<(), LoadError> {
        let shape = self.block_shape.clone();
        let bounds = wanted.low.iter().zip(&wanted.counts).zip(&shape);
        let range: Vec<Range<u64>> =
            bounds.map(|((&low, &count), &block)| low / block..(low + count).div_ceil(block)).collect();
        let grid = ChunkGrid {
            array: &self.array.shape,
            limits: &self.array.limits,
            chunk: &shape,
            chunk_bytes: self.block_bytes as u64,
        };
        let mut chunks = match &self.array.layout {
            DataLayout::Compact(bytes) => {
                self.has_chunks = true;
                wanted.copy_from(bytes, &vec![0; shape.len()], &shape, &mut self.slab);
                return Ok(());
            }
            DataLayout::Chunks { index, .. } => index.chunks_in(self.file, &grid, &range)?,
            DataLayout::Contiguous { address: Some(address) } => self.row_blocks(*address, &range),
            DataLayout::Contiguous { address: None } | DataLayout::Virtual => Vec::new(),
        };
        chunks.sort_by_key(|chunk| chunk.address);
        let at_once = (AT_ONCE_BYTES / (self.block_bytes as u64).max(1)).max(1) as usize;
        for batch in chunks.chunks(at_once) {
            self.has_chunks = true;
            let read = batch.iter().map(|chunk| self.read_chunk(chunk)).collect::<Result<Vec<_>, _>>()?;
            let (array, control, expected) = (self.array, self.file.control(), self.block_bytes);
            let decode = |(bytes, chunk): (Vec<u8>, &StoredChunk)| {
                control.run(|| array.filters.decode(bytes, expected, chunk.skipped_filters, control))
            };
            let decoded: Vec<_> = read.into_par_iter().zip(batch).map(decode).collect();
            // Chunks whose decoding was cancelled are not broken.
            control.check()?;
            for (decoded, chunk) in decoded.into_iter().zip(batch) {
                let bytes = decoded.map_err(|fault| match fault {
                    FilterFault::Stopped(error) => error,
                    FilterFault::Broken(why) => {
                        let chunk = words(&chunk.place);
                        self.file
                            .broken(self.name, format!("the data of the chunk at {chunk} are broken: {why}"))
                    }
                })?;
                let low: Vec<u64> =
                    chunk.place.iter().zip(&shape).map(|(place, n)| place.saturating_mul(*n)).collect();
                wanted.copy_from(&bytes, &low, &shape, &mut self.slab);
            }
        }
        Ok(())
    }

    /// Blocks of elements that lie one after another in the file.
    fn row_blocks(&self, address: u64, range: &[Range<u64>]) -> Vec<StoredChunk> {
        let (array, shape) = (&self.array.shape, &self.block_shape);
        let chunk = |place: Vec<u64>| {
            let mut number = 0u64;
            for ((place, length), block) in place.iter().zip(array).zip(shape) {
                number = number.saturating_mul(*length).saturating_add(place.saturating_mul(*block));
            }
            let address = address.saturating_add(number.saturating_mul(self.array.element_bytes as u64));
            StoredChunk { place, address, bytes: None, skipped_filters: u32::MAX }
        };
        ChunkGrid::places(range).map(chunk).collect()
    }

    fn read_chunk(&self, chunk: &StoredChunk) -> Result<Vec<u8>, LoadError> {
        let plain = self.block_bytes as u64;
        let bytes = chunk.bytes.unwrap_or(plain);
        if self.array.filters.is_empty() && bytes < plain {
            let why =
                format!("a chunk of {plain} bytes was expected at {}, {bytes} found", words(&chunk.place));
            return Err(self.file.broken(self.name, why));
        }
        // Filters that do not compress add little.
        if bytes > plain.saturating_mul(2).saturating_add(1 << 16) {
            let why = format!(
                "the chunk at {} has {bytes} bytes, for {plain} without filters",
                words(&chunk.place)
            );
            return Err(self.file.broken(self.name, why));
        }
        self.file.read_data(chunk.address, bytes, self.name)
    }
}

impl Read for BoxSlabReader<'_, '_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        loop {
            if let Some(slice) = self.ready.last_mut() {
                let count = out.len().min(slice.len());
                if count > 0 {
                    out[..count].copy_from_slice(&self.slab[slice.start..slice.start + count]);
                    slice.start += count;
                    return Ok(count);
                }
                if out.is_empty() {
                    return Ok(0);
                }
                self.ready.pop();
                continue;
            }
            match self.read_slab() {
                Ok(true) => {}
                Ok(false) => return Ok(0),
                Err(error) => {
                    self.failed = Some(error);
                    return Err(io::Error::other("a slab is not there"));
                }
            }
        }
    }
}

/// Numbers in words: 64 x 64 x 32.
fn words(numbers: &[u64]) -> String {
    numbers.iter().map(u64::to_string).collect::<Vec<_>>().join(" x ")
}
