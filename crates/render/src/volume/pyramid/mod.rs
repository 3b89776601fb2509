//! Pyramid of prefiltered density: level 0 by `volume/prefilter.wgsl`, coarser levels by `volume/downsample.wgsl`.

pub(crate) mod density_pyramid;
pub(crate) mod gradients;
pub(super) mod pyramid_views;

use std::ops::Range;

use super::texture_shapes::pyramid_dims;
use super::{GpuVolume, VolumeContext};
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::pipelines::uniforms;
use crate::plan::{BrickSet, MAX_STRETCH_LEVEL};
use crate::resources::pass;
use crate::volume::brick_list;
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::{BRICK_EDGE, BrickBounds};

/// Number of bricks per step: 2^18 texels with eight fetches each, some 40 ms on a software adapter.
const STEP_BRICKS: usize = 512;

/// Returns the packed coordinates of the bricks of 8³ texels in which each level of the pyramid of densities, or its
/// gradients, are non-zero.
pub(crate) fn nonempty_bricks(bricks: &BrickBounds, dims: [usize; 3]) -> Vec<Vec<u32>> {
    // A brick's range covers three voxels beyond it: one for the blur, two for differences.
    level_bricks(dims, bricks.dims, |at| bricks.ranges[at] != [0.0, 0.0])
}

/// Returns the packed coordinates of the bricks of 8³ texels, in each level of a pyramid of `dims` voxels, that overlap
/// bricks of voxels which are filled, of a grid of `bricks`.
pub(super) fn level_bricks(
    dims: [usize; 3],
    [nx, ny, nz]: [usize; 3],
    is_filled: impl Fn(usize) -> bool,
) -> Vec<Vec<u32>> {
    let size = pyramid_dims(dims);
    let dims = |level: u32| size.map(|n| (n >> level).max(1).div_ceil(BRICK_EDGE));
    // Beyond the grid its border is repeated.
    let is_filled = |x: usize, y: usize, z: usize| {
        let [x, y, z] = [x.min(nx - 1), y.min(ny - 1), z.min(nz - 1)];
        is_filled(x + nx * (y + ny * z))
    };
    let finest = dims(0);
    let holds = |at: usize| {
        let [x, y, z] = [at % finest[0], at / finest[0] % finest[1], at / (finest[0] * finest[1])];
        // Four texels of padding are half a brick, so a brick of texels overlaps two of voxels.
        let sides = |c: usize| c.saturating_sub(1)..=c;
        sides(z).any(|z| sides(y).any(|y| sides(x).any(|x| is_filled(x, y, z))))
    };
    let mut set = BrickSet::new(finest, (0..finest.iter().product()).map(holds).collect());
    let mut levels = Vec::new();
    for level in 0..=MAX_STRETCH_LEVEL as u32 {
        if level > 0 {
            // Texel i is made of texels 2i − 1 … 2i + 2, and differences reach two texels further.
            set = set.dilated(1).coarsened(2, dims(level));
        }
        levels.push(set.positions().map(brick_list::pack_coordinates).collect());
    }
    levels
}

/// Returns each level with its bricks, split into short steps; finest first.
pub(crate) fn steps(volume: &GpuVolume) -> impl Iterator<Item = (u32, Range<usize>)> + '_ {
    level_steps(&volume.filled_levels)
}

/// Splits lists of bricks, one list for each level, into short steps; finest first.
pub(crate) fn level_steps(levels: &[Vec<u32>]) -> impl Iterator<Item = (u32, Range<usize>)> + '_ {
    (0..).zip(levels).flat_map(|(level, bricks)| {
        // At least one step per level, so that the texture is cleared.
        let firsts = (0..bricks.len().max(1)).step_by(STEP_BRICKS);
        firsts.map(move |first| (level, first..bricks.len().min(first + STEP_BRICKS)))
    })
}

/// Creates a view of one level of a texture.
pub(crate) fn level_view(texture: &wgpu::Texture, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        label: Some("Pyramid::level"),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

/// Buffers of a pass that fills bricks of one level.
pub(crate) struct LevelBuffers {
    pub uniform: wgpu::Buffer,
    /// List of the bricks to be filled.
    pub bricks: wgpu::Buffer,
}

/// Creates the uniform of a level and the list of its bricks, which has at least one entry.
pub(crate) fn level_buffers(context: &GpuContext, level: u32, bricks: &[u32]) -> LevelBuffers {
    let spacing = (1u32 << level) as f32;
    let uniform = uniforms::PyramidLevelUniform { bricks: bricks.len() as u32, spacing, pad0: 0, pad1: 0 };
    let list = if bricks.is_empty() { &[0] } else { bricks };
    LevelBuffers {
        uniform: context.buffer("Pyramid::uniform", &[uniform], wgpu::BufferUsages::UNIFORM),
        bricks: context.buffer("Pyramid::bricks", list, wgpu::BufferUsages::STORAGE),
    }
}

/// Fills some bricks of one level. The finer level must be complete.
pub(crate) fn fill_pyramid(
    gpu: VolumeContext<'_>,
    level: u32,
    range: &Range<usize>,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), GpuError> {
    let VolumeContext { context, shaders, volume, .. } = gpu;
    let bricks = &volume.filled_levels[level as usize][range.clone()];
    let Some(pyramid) = &volume.pyramid else { return Ok(()) };
    let texture = &pyramid.texture;
    let format = texture.format();
    let pipeline = match level {
        0 => shaders.pipeline_into(&SingleVariant("volume/prefilter.wgsl"), format)?,
        _ => shaders.pipeline_into(&SingleVariant("volume/downsample.wgsl"), format)?,
    };
    let source = match level {
        0 => volume.density_view.clone(),
        _ => level_view(texture, level - 1),
    };
    let LevelBuffers { uniform, bricks: list } = level_buffers(context, level, bricks);
    let target = level_view(texture, level);
    let entries = [
        bind_view("source_texture", &source),
        sampler("source_sampler", &volume.clamped),
        bind_view("level", &target),
        bind_buffer("bound_resample", &uniform),
        bind_buffer("bricks", &list),
    ];
    let bind_group = pass::bind(context, "Pyramid::bind_group", &pipeline, 0, &entries);
    let groups = brick_list::two_workgroups_per_brick(bricks.len().max(1) as u32);
    pass::dispatch(encoder, "Pyramid::fill", &pipeline, &[&bind_group], groups);
    Ok(())
}
