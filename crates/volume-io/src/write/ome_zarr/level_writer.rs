//! Writer of one resolution level: layers of chunks, which become shards.

use std::io::Result;

use rayon::prelude::*;

use super::chunk_encoder::compress_chunk;
use super::hierarchy_sink::HierarchySink;
use crate::reading::chunk_codecs::crc32c;

/// Edge of a chunk, in voxels.
pub(super) const CHUNK_EDGE: usize = 64;

/// Maximum number of chunks of a shard along each axis: 512 voxels.
const SHARD_CHUNKS: usize = 8;

/// Offset and length of a chunk that is not stored, in the index of a shard.
const ABSENT: [u64; 2] = [u64::MAX; 2];

/// Grid of chunks and shards of an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ShardGrid {
    /// Voxels of the array along x, y, z.
    pub(super) dims: [usize; 3],
    /// Voxels of a chunk along x, y, z.
    pub(super) chunk: [usize; 3],
    /// Chunks of a shard along x, y, z.
    pub(super) shard_chunks: [usize; 3],
}

impl ShardGrid {
    /// Creates the grid of an array of so many voxels; chunks are no longer than the array.
    pub(super) fn new(dims: [usize; 3]) -> Self {
        let chunk = dims.map(|n| n.min(CHUNK_EDGE));
        let counts = [0, 1, 2].map(|axis| dims[axis].div_ceil(chunk[axis]));
        Self { dims, chunk, shard_chunks: counts.map(|count| count.min(SHARD_CHUNKS)) }
    }

    /// Voxels of a shard along x, y, z.
    pub(super) fn shard(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.chunk[axis] * self.shard_chunks[axis])
    }

    /// Chunks along each axis.
    fn counts(&self) -> [usize; 3] {
        [0, 1, 2].map(|axis| self.dims[axis].div_ceil(self.chunk[axis]))
    }
}

/// Shard to which layers of chunks are being added.
#[derive(Debug, Clone)]
struct OpenShard {
    /// Place along x and y, in shards.
    at: [usize; 2],
    /// Bytes written until now.
    length: u64,
    /// Offset and length of each chunk, x fastest.
    index: Vec<[u64; 2]>,
}

/// Writer of a level, which is fed slices and writes a layer of chunks at a time.
#[derive(Debug)]
pub(super) struct LevelWriter {
    /// Path of the array.
    path: String,
    grid: ShardGrid,
    /// Bytes of a voxel.
    voxel_bytes: usize,
    /// Chunk of voxels of which nothing is stored.
    empty_chunk: Vec<u8>,
    /// Slices of the layer that is not complete yet.
    pending: Vec<u8>,
    /// Slices that were written.
    written: usize,
    shards: Vec<OpenShard>,
}

impl LevelWriter {
    /// Creates a writer; `fill` are the bytes of a voxel of which nothing is stored.
    pub(super) fn new(path: String, grid: ShardGrid, fill: &[u8]) -> Self {
        let counts = grid.counts();
        let [width, height] = [0, 1].map(|axis| counts[axis].div_ceil(grid.shard_chunks[axis]));
        let index = vec![ABSENT; grid.shard_chunks.iter().product()];
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let shards = places.map(|at| OpenShard { at, length: 0, index: index.clone() }).collect();
        let empty_chunk = fill.repeat(grid.chunk.iter().product());
        Self { path, grid, voxel_bytes: fill.len(), empty_chunk, pending: Vec::new(), written: 0, shards }
    }

    fn row_bytes(&self) -> usize {
        self.grid.dims[0] * self.voxel_bytes
    }

    fn slice_bytes(&self) -> usize {
        self.row_bytes() * self.grid.dims[1]
    }

    /// Returns true if all slices were written.
    pub(super) fn is_complete(&self) -> bool {
        self.written == self.grid.dims[2]
    }

    /// Takes slices until a layer is complete; returns those that were not taken.
    pub(super) fn take<'a>(&mut self, slices: &'a [u8]) -> &'a [u8] {
        let missing = self.layer_bytes() - self.pending.len();
        let (taken, rest) = slices.split_at(missing.min(slices.len()));
        self.pending.extend_from_slice(taken);
        rest
    }

    /// Bytes of the slices of the current layer of chunks.
    fn layer_bytes(&self) -> usize {
        (self.grid.dims[2] - self.written).min(self.grid.chunk[2]) * self.slice_bytes()
    }

    /// Writes the layer if it is complete, and returns its slices.
    pub(super) fn write_layer(&mut self, sink: &mut dyn HierarchySink) -> Result<Option<Vec<u8>>> {
        if self.is_complete() || self.pending.len() < self.layer_bytes() {
            return Ok(None);
        }
        let layer = std::mem::take(&mut self.pending);
        let [_, _, depth] = self.grid.shard_chunks;
        let layer_index = self.written / self.grid.chunk[2];
        let is_last = self.written + self.grid.chunk[2] >= self.grid.dims[2];
        let is_shard_complete = is_last || layer_index % depth == depth - 1;
        let mut shards = std::mem::take(&mut self.shards);
        for shard in &mut shards {
            let [x, y] = shard.at;
            let key = format!("{}/c/{}/{y}/{x}", self.path, layer_index / depth);
            let mut bytes = self.encode_chunks(&layer, shard, layer_index % depth);
            shard.length += bytes.len() as u64;
            if is_shard_complete && shard.length > 0 {
                bytes.extend(encode_index(&shard.index));
            }
            if !bytes.is_empty() {
                sink.append(&key, &bytes)?;
            }
            if is_shard_complete {
                shard.length = 0;
                shard.index.fill(ABSENT);
            }
        }
        self.shards = shards;
        self.written += layer.len() / self.slice_bytes();
        Ok(Some(layer))
    }

    /// Encodes the chunks of a layer that belong to a shard, and adds them to its index.
    fn encode_chunks(&self, layer: &[u8], shard: &mut OpenShard, z: usize) -> Vec<u8> {
        let [width, height, _] = self.grid.shard_chunks;
        let counts = self.grid.counts();
        let [first_x, first_y] = [shard.at[0] * width, shard.at[1] * height];
        let encode = |place: usize| {
            let [x, y] = [first_x + place % width, first_y + place / width];
            let is_there = x < counts[0] && y < counts[1];
            is_there.then(|| self.gather_chunk(layer, [x, y])).flatten().map(|chunk| compress_chunk(&chunk))
        };
        let encoded: Vec<Option<Vec<u8>>> = (0..width * height).into_par_iter().map(encode).collect();
        let mut bytes = Vec::new();
        for (place, chunk) in encoded.into_iter().enumerate() {
            if let Some(chunk) = chunk {
                shard.index[z * width * height + place] =
                    [shard.length + bytes.len() as u64, chunk.len() as u64];
                bytes.extend(chunk);
            }
        }
        bytes
    }

    /// Gathers the voxels of a chunk of a layer; `None` if nothing need be stored of them.
    fn gather_chunk(&self, layer: &[u8], at: [usize; 2]) -> Option<Vec<u8>> {
        let [width, height, _] = self.grid.chunk;
        let voxel_bytes = self.voxel_bytes;
        let [nx, ny, _] = self.grid.dims;
        let [x, y] = [at[0] * width, at[1] * height];
        let row_bytes = (nx - x).min(width) * voxel_bytes;
        let rows = (ny - y).min(height);
        let mut chunk = self.empty_chunk.clone();
        for (z, slice) in layer.chunks_exact(self.slice_bytes()).enumerate() {
            for row in 0..rows {
                let from = (y + row) * self.row_bytes() + x * voxel_bytes;
                let to = (z * height + row) * width * voxel_bytes;
                chunk[to..to + row_bytes].copy_from_slice(&slice[from..from + row_bytes]);
            }
        }
        (chunk != self.empty_chunk).then_some(chunk)
    }
}

/// Encodes the index at the end of a shard: offsets and lengths, and their checksum.
fn encode_index(index: &[[u64; 2]]) -> Vec<u8> {
    let mut bytes: Vec<u8> = index.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend(crc32c(&bytes).to_le_bytes());
    bytes
}
