//! Voxel lists of the scattering engine: all non-empty bricks, brick by brick.

use std::sync::Arc;

use rayon::prelude::*;

use crate::plan::BrickSet;
use crate::volume::GpuVolume;
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::{BRICK_EDGE, Volume};

/// Number of words per brick, with two voxels in each.
const BRICK_WORDS: usize = BRICK_EDGE * BRICK_EDGE * BRICK_EDGE / 2;

/// Densities of the non-empty bricks, or of all, in the layout that `scatter/splat.wgsl` reads.
#[derive(Debug)]
pub(crate) struct ScatterVoxels {
    /// Buffer with two 16-bit normalised densities per word, and 8³ voxels per brick.
    pub buffer: wgpu::Buffer,
    /// Word where the voxels of each brick of the volume begin; `None` for empty bricks.
    pub first_word: Vec<Option<u32>>,
    /// Buffer with the word where each brick's voxels begin, for shaders; −1 for empty bricks.
    pub first_words: wgpu::Buffer,
    /// `true` if empty bricks are listed, too.
    pub has_empty_bricks: bool,
}

/// Voxels that a picture scatters, and the counter of its footprints.
#[derive(Debug)]
pub(crate) struct ScatterState {
    pub voxels: Arc<ScatterVoxels>,
    /// Buffer of one word: number of footprints so far.
    pub counter: wgpu::Buffer,
}

impl ScatterState {
    /// Creates the state for one picture, whose footprints are counted from zero.
    pub(crate) fn new(context: &GpuContext, voxels: Arc<ScatterVoxels>) -> Self {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        Self { voxels, counter: context.buffer("Scattering::counter", &[0u32], usage) }
    }
}

impl ScatterVoxels {
    /// Lists a volume's voxels; with `all` also bricks of zeros, which a transfer function may show.
    ///
    /// # Errors
    /// Returns an error if they exceed the adapter's largest buffer.
    pub(crate) fn new(context: &GpuContext, volume: &GpuVolume, all: bool) -> Result<Self, GpuError> {
        let [nx, ny, nz] = volume.bricks.dims;
        let layers: Vec<_> =
            (0..nz).into_par_iter().map(|z| encode_layer(&volume.volume, z, [nx, ny], all)).collect();
        let bricks = layers.iter().flatten().filter(|words| words.is_some()).count();
        let bytes = (bricks * BRICK_WORDS * 4) as u64;
        let limit = context.device.limits().max_storage_buffer_binding_size;
        if bytes > limit {
            return Err(GpuError::OverLimit {
                what: "the list of voxels to be scattered".to_owned(),
                size: bytes,
                limit,
                help: "choose the gathering engine, which makes the same picture without it",
            });
        }
        let mut listed = Vec::with_capacity(bricks.max(1) * BRICK_WORDS);
        let mut first_word = Vec::with_capacity(nx * ny * nz);
        for words in layers.into_iter().flatten() {
            first_word.push(words.is_some().then_some(listed.len() as u32));
            listed.extend(words.into_iter().flatten());
        }
        // Bindings must not be empty.
        listed.resize(listed.len().max(1), 0);
        let buffer = context.buffer("ScatterVoxels::buffer", &listed, wgpu::BufferUsages::STORAGE);
        let words: Vec<i32> = first_word.iter().map(|word| word.map_or(-1, |word| word as i32)).collect();
        let first_words = context.buffer("ScatterVoxels::first_words", &words, wgpu::BufferUsages::STORAGE);
        Ok(Self { buffer, first_word, first_words, has_empty_bricks: all })
    }

    /// Returns the non-empty bricks of a set: coordinates and first word.
    pub(crate) fn bricks_in<'a>(&'a self, set: &'a BrickSet) -> impl Iterator<Item = ([usize; 3], u32)> + 'a {
        let [nx, ny, _] = set.dims;
        set.positions()
            .filter_map(move |[x, y, z]| Some(([x, y, z], self.first_word[x + nx * (y + ny * z)]?)))
    }

    /// Returns the size of the list, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffer.size() + self.first_words.size()
    }
}

/// Encodes every brick of layer `z`; `None` for empty ones, unless `all` is set.
fn encode_layer(volume: &Volume, z: usize, [nx, ny]: [usize; 2], all: bool) -> Vec<Option<Vec<u32>>> {
    let dims = volume.dims();
    let first = z * BRICK_EDGE;
    let slices: Vec<Vec<f32>> =
        (first..(first + BRICK_EDGE).min(dims[2])).map(|z| volume.slice_densities(z)).collect();
    let density = |x: usize, y: usize, z: usize| match slices.get(z) {
        Some(slice) if x < dims[0] && y < dims[1] => slice[x + dims[0] * y],
        _ => 0.0,
    };
    let word = |low: f32, high: f32| unorm16(low) | unorm16(high) << 16;
    let brick = |bx: usize, by: usize| {
        let (x, y) = (bx * BRICK_EDGE, by * BRICK_EDGE);
        let words: Vec<u32> = (0..BRICK_WORDS)
            .map(|at| {
                let row = at * 2;
                let (dx, dy, dz) =
                    (row % BRICK_EDGE, row / BRICK_EDGE % BRICK_EDGE, row / (BRICK_EDGE * BRICK_EDGE));
                word(density(x + dx, y + dy, dz), density(x + dx + 1, y + dy, dz))
            })
            .collect();
        (all || words.iter().any(|&word| word != 0)).then_some(words)
    };
    (0..ny).flat_map(|by| (0..nx).map(move |bx| (bx, by))).map(|(bx, by)| brick(bx, by)).collect()
}

fn unorm16(density: f32) -> u32 {
    (density.clamp(0.0, 1.0) * 65535.0).round() as u32
}
