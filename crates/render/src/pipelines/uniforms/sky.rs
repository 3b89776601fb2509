//! Uniforms of the shaders for sky visibility.

use bytemuck::{Pod, Zeroable};

use super::CutUniform;

/// Maximum number of directions in a batch, as in `sky/rays.wgsl`.
pub const MAX_BATCH_DIRECTIONS: usize = 8;

/// Radiance and look-up of the sky, as declared in `shading/sky.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SkyUniform {
    pub red: [f32; 4],
    pub green: [f32; 4],
    pub blue: [f32; 4],
    pub lookup: [f32; 3],
    pub lookup_distance: f32,
}

/// Blocks of averaged extinction, as declared in `sky/places.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct BlocksUniform {
    pub dims: [u32; 3],
    pub voxel_step: f32,
    pub level: f32,
    pub offset: f32,
    pub edge: f32,
    pub albedo: f32,
    pub max_depth: f32,
    pub pad0: f32,
    pub pad1: f32,
    pub pad2: f32,
    pub shading_cut: CutUniform,
}

/// Parallel rays of one direction, as declared in `sky/rays.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SweepRaysUniform {
    pub direction_to_light: [f32; 3],
    pub step: f32,
    pub drift: [f32; 2],
    pub first: [f32; 2],
    pub size: [u32; 2],
    pub axis: u32,
    pub is_ascending: u32,
    pub incoming_radiance: [f32; 3],
    pub layer: u32,
    pub weight: f32,
    pub first_tile: u32,
    pub pad0: f32,
    pub pad1: f32,
}

/// Batch of directions of a sweep, as declared in `sky/rays.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SweepUniform {
    pub dims: [u32; 3],
    pub share: f32,
    pub block_scale: [f32; 3],
    pub has_sums: f32,
    pub sheet_scale: [f32; 3],
    pub pad0: f32,
    pub rays: [SweepRaysUniform; MAX_BATCH_DIRECTIONS],
}

/// Geometry of blocks of voxels, as declared in `sky/surface_block.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SurfaceBlocksUniform {
    pub dims: [u32; 3],
    pub has_surfaces: u32,
    pub block_scale: [f32; 3],
    pub directions: u32,
    pub along_x: [f32; 3],
    pub pad1: f32,
    pub along_y: [f32; 3],
    pub pad2: f32,
    pub along_z: [f32; 3],
    pub pad3: f32,
}

/// Maximum number of directions of a sky, as in `sky/surfaces.wgsl`.
const MAX_SKY_DIRECTIONS: usize = 96;

/// Directions in which the light of a sky is followed, as declared in `sky/surfaces.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SkyDirectionsUniform {
    pub directions: [[f32; 4]; MAX_SKY_DIRECTIONS],
}

/// Position of the floor's sky map, as declared in `sky/floor_place.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct FloorSkyMapUniform {
    pub origin: [f32; 3],
    pub share: f32,
    pub along_x: [f32; 3],
    pub size: u32,
    pub along_y: [f32; 3],
    pub pad0: f32,
    pub plane: [f32; 4],
}
