//! Reading of a box of an array as a stream of slices: layers of chunks are decoded in parallel, and only those that the
//! box meets.

use std::io::{self, Read};
use std::ops::Range;

use rayon::prelude::*;

use super::codec_pipeline::CodecPipeline;
use super::sharding::ShardIndices;
use super::{ByteRange, ReadFault, Store, StoreError, ZarrArray};
use chiaroscuro_volume::{LoadContext, LoadControl, LoadError, ReadContext, human_bytes};

/// Bytes of chunks that are decoded at a time, or one layer of chunks where that is more: enough for all cores, small
/// against a volume.
const LAYER_BYTES: u64 = 32 << 20;

/// Bytes of slices that are gathered from decoded chunks at a time.
const GATHERED_BYTES: usize = 4 << 20;

/// Box of an array that is read as a volume.
#[derive(Debug, Clone)]
pub(crate) struct ArrayBox {
    /// Axis of the array along x, y and z; `None` where the array has none.
    pub(crate) axes: [Option<usize>; 3],
    /// Index along each axis of the array; those along x, y and z do not count.
    pub(crate) indices: Vec<u64>,
    /// First voxel along x, y and z.
    pub(crate) low: [usize; 3],
    /// End of the box along x, y and z, exclusive.
    pub(crate) high: [usize; 3],
}

/// Decoded chunk of a layer.
struct LayerChunk {
    /// First voxel along x, y and z.
    first: [usize; 3],
    /// End along x, y and z, exclusive.
    end: [usize; 3],
    /// Elements; `None` for a chunk that the store does not hold.
    bytes: Option<Vec<u8>>,
}

/// Reader of the slices of a box, one after the other, without gaps.
pub(crate) struct SlabReader<'a> {
    context: LoadContext<'a>,
    store: &'a dyn Store,
    array: &'a ZarrArray,
    part: ArrayBox,
    control: &'a LoadControl,
    shard_indices: ShardIndices,
    /// Length of a chunk along x, y and z.
    chunk_edges: [usize; 3],
    /// Distance between neighbours along x, y and z in a decoded chunk, in elements.
    strides: [usize; 3],
    /// Element of a chunk at the fixed indices, with x, y and z at the beginning of the chunk.
    origin: usize,
    layer: Vec<LayerChunk>,
    /// Slices of the array that the layer holds.
    layer_slices: Range<usize>,
    /// Gathered bytes of some slices, and the position of the first of them in the stream.
    gathered: Vec<u8>,
    gathered_at: u64,
    position: u64,
    /// True if some chunk of the box was there.
    pub(crate) has_data: bool,
    /// Error that ended the stream, since [`Read`] can only return [`io::Error`].
    failed: Option<LoadError>,
}

impl<'a> SlabReader<'a> {
    /// Creates a reader; `volume_bytes` are taken by the voxels beside it.
    ///
    /// # Errors
    /// `Limit` where the chunks that are decoded at a time do not fit into the budget beside the volume.
    pub(crate) fn new(
        context: LoadContext<'a>,
        store: &'a dyn Store,
        array: &'a ZarrArray,
        part: ArrayBox,
        volume_bytes: u64,
        room: ReadContext<'a>,
    ) -> Result<Self, LoadError> {
        let narrow = |length: u64| usize::try_from(length).unwrap_or(usize::MAX);
        let edge = |axis: Option<usize>| axis.map_or(1, |axis| narrow(array.chunk_shape[axis]));
        let strides = array.pipeline.strides(&array.chunk_shape);
        let origin = part.indices.iter().enumerate().map(|(axis, &index)| {
            let is_spatial = part.axes.contains(&Some(axis));
            if is_spatial { 0 } else { narrow(index % array.chunk_shape[axis]).saturating_mul(strides[axis]) }
        });
        let origin = origin.fold(0, usize::saturating_add);
        let reader = Self {
            context,
            store,
            array,
            control: room.control,
            shard_indices: ShardIndices::default(),
            chunk_edges: part.axes.map(edge),
            strides: part.axes.map(|axis| axis.map_or(0, |axis| strides[axis])),
            part,
            origin,
            layer: Vec::new(),
            layer_slices: 0..0,
            gathered: Vec::new(),
            gathered_at: 0,
            position: 0,
            has_data: false,
            failed: None,
        };
        let at_once = array.chunk_bytes().saturating_mul(reader.chunks_per_layer());
        if at_once.saturating_add(volume_bytes) > room.budget_bytes {
            return Err(context.limit_error(
                &super::join(&array.path, "chunks"),
                format!(
                    "chunks of {} voxels are decoded at a time, which need {} beside {} of voxels; {} are allowed",
                    array.chunk_shape.iter().map(u64::to_string).collect::<Vec<_>>().join(" x "),
                    human_bytes(at_once.into()),
                    human_bytes(volume_bytes.into()),
                    human_bytes(room.budget_bytes.into())
                ),
                "open a coarser level (--level), a region (--region), or write the array with smaller chunks",
            ));
        }
        Ok(reader)
    }

    /// Returns the error that ended the stream, or else the fault.
    pub(crate) fn error(&mut self, fault: ReadFault) -> ReadFault {
        self.failed.take().map_or(fault, ReadFault::Stopped)
    }

    /// Skips bytes of the stream; chunks that hold nothing else are not read.
    pub(crate) fn skip(&mut self, count: u64) -> io::Result<()> {
        let beyond = || io::Error::from(io::ErrorKind::UnexpectedEof);
        self.position = self.position.checked_add(count).ok_or_else(beyond)?;
        Ok(())
    }

    /// Number of chunks that one slice meets.
    fn chunks_per_layer(&self) -> u64 {
        [0, 1].iter().fold(1, |count: u64, &axis| {
            let chunks = self.chunk_indices(axis, self.part.low[axis]..self.part.high[axis]);
            count.saturating_mul(chunks.end - chunks.start)
        })
    }

    /// Indices of the chunks that hold voxels along x, y or z.
    fn chunk_indices(&self, axis: usize, voxels: Range<usize>) -> Range<u64> {
        let edge = self.chunk_edges[axis];
        (voxels.start / edge) as u64..voxels.end.div_ceil(edge) as u64
    }

    fn slice_bytes(&self) -> usize {
        let count = |axis: usize| self.part.high[axis] - self.part.low[axis];
        count(0).saturating_mul(count(1)).saturating_mul(self.array.number.bytes())
    }

    /// Decodes the chunks of the layer that holds a slice of the array.
    fn decode_layer(&mut self, z: usize) -> Result<(), LoadError> {
        // Before the next one is decoded.
        self.layer = Vec::new();
        let edge = self.chunk_edges[2];
        let layer_bytes = self.array.chunk_bytes().saturating_mul(self.chunks_per_layer()).max(1);
        let layers = usize::try_from(LAYER_BYTES / layer_bytes).unwrap_or(usize::MAX).max(1);
        let first = (z / edge).saturating_mul(edge);
        let end = first.saturating_add(edge.saturating_mul(layers)).min(self.part.high[2]);
        let ranges = [0, 1].map(|axis| self.chunk_indices(axis, self.part.low[axis]..self.part.high[axis]));
        let mut chunks = Vec::new();
        for cz in self.chunk_indices(2, first..end) {
            for cy in ranges[1].clone() {
                chunks.extend(ranges[0].clone().map(|cx| [cx, cy, cz]));
            }
        }
        let this = &*self;
        let decoded = chunks.into_par_iter().map(|chunk| this.decode_chunk(chunk));
        self.layer = decoded.collect::<Result<_, _>>()?;
        self.has_data |= self.layer.iter().any(|chunk| chunk.bytes.is_some());
        self.layer_slices = first..end;
        Ok(())
    }

    /// Reads and decodes the chunk at indices along x, y and z.
    fn decode_chunk(&self, chunk: [u64; 3]) -> Result<LayerChunk, LoadError> {
        self.control.check()?;
        let mut indices: Vec<u64> =
            self.part.indices.iter().zip(&self.array.chunk_shape).map(|(index, edge)| index / edge).collect();
        for (axis, index) in self.part.axes.iter().zip(chunk) {
            if let Some(axis) = axis {
                indices[*axis] = index;
            }
        }
        let first = [0, 1, 2].map(|axis| (chunk[axis] as usize).saturating_mul(self.chunk_edges[axis]));
        let end = [0, 1, 2].map(|axis| first[axis].saturating_add(self.chunk_edges[axis]));
        let (key, number) = match &self.array.sharding {
            None => (self.array.keys.key(&self.array.path, &indices), None),
            Some(sharding) => {
                let (shard, number) = sharding.locate(&indices);
                (self.array.keys.key(&self.array.path, &shard), Some((sharding, number)))
            }
        };
        let read = self.control.run(|| self.read_chunk(&key, number));
        if self.control.is_cancelled() {
            return Err(LoadError::Cancelled);
        }
        let bytes = read.map_err(|error| error.into_load_error(self.context, &key))?;
        Ok(LayerChunk { first, end, bytes })
    }

    /// Reads and decodes a chunk, or one within a shard; `None` if the store does not hold it.
    fn read_chunk(
        &self,
        key: &str,
        in_shard: Option<(&super::Sharding, u64)>,
    ) -> Result<Option<Vec<u8>>, StoreError> {
        let chunk_bytes = self.array.chunk_bytes();
        let most = CodecPipeline::max_stored_bytes(chunk_bytes);
        let range = match in_shard {
            None => ByteRange::AtMost(most),
            Some((sharding, number)) => {
                match sharding.chunk_range(self.store, &self.shard_indices, key, number)? {
                    None => return Ok(None),
                    Some(ByteRange::From(_, length)) if length > most => {
                        let why =
                            format!("chunk {number} of the shard has {length} bytes, {most} are allowed");
                        return Err(StoreError::Unusable(why, "copy or download the file again"));
                    }
                    Some(range) => range,
                }
            }
        };
        let Some(stored) = self.store.read(key, range)? else { return Ok(None) };
        let decoded = self.array.pipeline.decode(stored, usize::try_from(chunk_bytes).unwrap_or(usize::MAX));
        decoded.map(Some).map_err(|why| {
            StoreError::Unusable(format!("the chunk is broken: {why}"), "copy or download the file again")
        })
    }

    /// Gathers the slices from `z` of the array on, as far as the layer reaches.
    fn gather(&mut self, z: usize) {
        let slice_bytes = self.slice_bytes();
        let end = self.layer_slices.end.min(z + (GATHERED_BYTES / slice_bytes.max(1)).max(1));
        let mut gathered = std::mem::take(&mut self.gathered);
        gathered.resize((end - z) * slice_bytes, 0);
        let this = &*self;
        let slices = gathered.par_chunks_mut(slice_bytes).enumerate();
        slices.for_each(|(at, slice)| {
            let chunks = this.layer.iter().filter(|chunk| (chunk.first[2]..chunk.end[2]).contains(&(z + at)));
            chunks.for_each(|chunk| this.copy_slice(chunk, z + at, slice));
        });
        self.gathered = gathered;
        self.gathered_at = (z - self.part.low[2]) as u64 * slice_bytes as u64;
    }

    /// Copies the part of a slice that a chunk holds.
    fn copy_slice(&self, chunk: &LayerChunk, z: usize, slice: &mut [u8]) {
        let size = self.array.number.bytes();
        let [low, high] = [self.part.low, self.part.high];
        let [x, y] = [0, 1].map(|axis| chunk.first[axis].max(low[axis])..chunk.end[axis].min(high[axis]));
        let width = high[0] - low[0];
        for row in y {
            let to = ((row - low[1]) * width + x.start - low[0]) * size;
            let out = &mut slice[to..to + x.len() * size];
            let Some(bytes) = &chunk.bytes else {
                out.chunks_exact_mut(size).for_each(|element| element.copy_from_slice(&self.array.fill));
                continue;
            };
            let from = self.origin
                + (x.start - chunk.first[0]) * self.strides[0]
                + (row - chunk.first[1]) * self.strides[1]
                + (z - chunk.first[2]) * self.strides[2];
            if self.strides[0] == 1 {
                out.copy_from_slice(&bytes[from * size..][..out.len()]);
                continue;
            }
            for (at, element) in out.chunks_exact_mut(size).enumerate() {
                let from = (from + at * self.strides[0]) * size;
                element.copy_from_slice(&bytes[from..from + size]);
            }
        }
    }

    /// Makes the bytes at the position available; false at the end of the box.
    fn fill_at_position(&mut self) -> Result<bool, LoadError> {
        let held = self.gathered_at..self.gathered_at + self.gathered.len() as u64;
        if held.contains(&self.position) {
            return Ok(true);
        }
        let slice = usize::try_from(self.position / (self.slice_bytes().max(1) as u64)).unwrap_or(usize::MAX);
        let z = self.part.low[2].saturating_add(slice);
        if z >= self.part.high[2] {
            return Ok(false);
        }
        if !self.layer_slices.contains(&z) {
            self.decode_layer(z)?;
        }
        self.gather(z);
        Ok(true)
    }
}

impl Read for SlabReader<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        match self.fill_at_position() {
            Ok(true) => {}
            Ok(false) => return Ok(0),
            Err(error) => {
                self.failed = Some(error);
                return Err(io::Error::other("a chunk cannot be read"));
            }
        }
        let rest = &self.gathered[(self.position - self.gathered_at) as usize..];
        let count = out.len().min(rest.len());
        out[..count].copy_from_slice(&rest[..count]);
        self.position += count as u64;
        Ok(count)
    }
}
