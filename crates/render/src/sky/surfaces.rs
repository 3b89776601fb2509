//! Surfaces of dense material near the blocks that pictures look up, in front of which rays to the sky start.

use super::block_texture::BlockTexture;
use super::direction_batches::DirectionBatches;
use crate::pipelines::binding::{bind_buffer, bind_view, sampler};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::pipelines::uniforms;
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::cell_list::CellList;
use crate::{GpuContext, GpuError};
use glam::DVec3;

/// Size of a block's packed surface, in bytes.
const SURFACE_BYTES: u64 = 16;

/// Distance from the cells that pictures look up, in blocks along an axis, within which rays must be followed: they
/// start up to 2.5 blocks from a block (`MAX_START_DISTANCE` in `shaders/sky/moments.wgsl`), and are interpolated
/// over another.
pub(crate) const START_REACH: f64 = 3.5;

/// Surface of each listed block: its normal, its distance, and the height above it that is free of its own material.
#[derive(Debug)]
pub(crate) struct SurfaceBlocks {
    pub buffer: wgpu::Buffer,
}

impl SurfaceBlocks {
    /// Allocates surfaces for a number of blocks.
    pub(crate) fn new(context: &GpuContext, blocks: u64) -> Self {
        let buffer = context.uninitialised_buffer(&wgpu::BufferDescriptor {
            label: Some("Sky::surfaces"),
            size: SURFACE_BYTES * blocks.max(1),
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        Self { buffer }
    }

    /// Uploads the geometry of blocks, and the number of directions in which light is followed.
    pub(crate) fn geometry(
        gpu: VolumeContext<'_>,
        blocks: &BlockTexture,
        directions: usize,
        has_surfaces: bool,
    ) -> wgpu::Buffer {
        let linear = gpu.volume.scene.index_from_scene.matrix3;
        // Blocks per shortest edge of a voxel: only ratios count.
        let scale = gpu.volume.scene.smallest_edge() / blocks.divisor as f64;
        let column = |axis: DVec3| (axis * scale).as_vec3().into();
        let uniform = uniforms::SurfaceBlocksUniform {
            dims: blocks.dims.map(|n| n as u32),
            has_surfaces: u32::from(has_surfaces),
            block_scale: blocks.dims.map(|n| 1.0 / (n + 2) as f32),
            directions: directions as u32,
            along_x: column(linear.x_axis),
            pad1: 0.0,
            along_y: column(linear.y_axis),
            pad2: 0.0,
            along_z: column(linear.z_axis),
            pad3: 0.0,
        };
        gpu.uniform("Sky::geometry", uniform)
    }

    /// Uploads the directions of all sweeps.
    pub(crate) fn directions(gpu: VolumeContext<'_>, batches: &DirectionBatches) -> wgpu::Buffer {
        let mut uniform: uniforms::SkyDirectionsUniform = bytemuck::Zeroable::zeroed();
        for (packed, rays) in uniform.directions.iter_mut().zip(batches.all()) {
            *packed = rays.frame.towards.as_vec3().extend(0.0).into();
        }
        gpu.uniform("Sky::directions", uniform)
    }

    /// Records the pass that finds the surfaces near listed blocks; `extinction` is that of all blocks, with a border,
    /// and `geometry` and `directions` are the uniforms of this type.
    pub(crate) fn find(
        &self,
        gpu: VolumeContext<'_>,
        extinction: &wgpu::TextureView,
        cells: &CellList,
        geometry: &wgpu::Buffer,
        directions: &wgpu::Buffer,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let pipeline = gpu.shaders.pipeline(&SingleVariant("sky/surfaces.wgsl"))?;
        let entries = [
            bind_view("extinction", extinction),
            sampler("clamped", &gpu.volume.clamped),
            cells.binding(),
            bind_buffer("surfaces", &self.buffer),
            bind_buffer("bound_geometry", geometry),
            bind_buffer("bound_directions", directions),
        ];
        let own = gpu.bind("Sky::surfaces", &pipeline, 0, &entries);
        pass::dispatch(encoder, "Sky::surfaces", &pipeline, &[&own], cells.workgroups());
        Ok(())
    }
}
