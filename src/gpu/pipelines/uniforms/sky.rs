//! What shaders of a sky mirror.

use bytemuck::{Pod, Zeroable};

use super::Cut;

/// Most directions of a batch, as `sky/rays.wgsl` has it.
pub const MAX_SKY_RAYS: usize = 8;

/// `shading/sky_light.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Sky {
    pub red: [f32; 4],
    pub green: [f32; 4],
    pub blue: [f32; 4],
    pub lookup: [f32; 3],
    pub ahead: f32,
}

/// `sky/places.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Blocks {
    pub dims: [u32; 3],
    pub voxel_step: f32,
    pub level: f32,
    pub offset: f32,
    pub edge: f32,
    pub albedo: f32,
    pub shading_cut: Cut,
}

/// `sky/rays.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SkyRays {
    pub towards: [f32; 3],
    pub step: f32,
    pub drift: [f32; 2],
    pub first: [f32; 2],
    pub size: [u32; 2],
    pub axis: u32,
    pub rises: u32,
    pub arriving: [f32; 3],
    pub layer: u32,
    pub weight: f32,
    pub first_tile: u32,
    pub pad0: f32,
    pub pad1: f32,
}

/// `sky/rays.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Sweep {
    pub dims: [u32; 3],
    pub share: f32,
    pub block_scale: [f32; 3],
    pub has_sums: f32,
    pub sheet_scale: [f32; 3],
    pub pad0: f32,
    pub rays: [SkyRays; MAX_SKY_RAYS],
}

/// `sky/floor_place.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct FloorMap {
    pub origin: [f32; 3],
    pub share: f32,
    pub along_x: [f32; 3],
    pub size: u32,
    pub along_y: [f32; 3],
    pub pad0: f32,
    pub plane: [f32; 4],
}
