//! Uniforms of the shaders for scattered light.

use bytemuck::{Pod, Zeroable};

use super::{LightUniform, SpaceUniform};

/// Look-up of scattered light, as declared in `shading/scattered_light.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ScatteredLightUniform {
    pub lookup: [f32; 3],
    pub lookup_distance: f32,
    pub share: f32,
    pub pad0: f32,
    pub pad1: f32,
    pub pad2: f32,
}

/// Parameters of passes over blocks of scattered light, as declared in `scattered_light/bounce.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct BounceUniform {
    pub dims: [u32; 3],
    pub share: f32,
    pub color: [f32; 3],
    pub min_extinction: f32,
}

/// Level of the diffusion equation, as declared in `diffusion/level.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct DiffusionLevelUniform {
    pub dims: [u32; 3],
    pub first: u32,
    pub coarser_dims: [u32; 3],
    pub coarser_first: u32,
    pub edges: [f32; 3],
    pub pad0: f32,
}

/// Scene of the single-scattering pass, as declared in `scattered_light/single_scattering.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SingleScatteringUniform {
    pub space: SpaceUniform,
    pub block_scale: [f32; 3],
    pub voxel_step: f32,
    pub count: u32,
    pub shadowed: u32,
    pub edge: f32,
    pub emission: f32,
    pub slice: u32,
    pub end: u32,
    pub pad0: f32,
    pub has_sky: f32,
    pub lights: [LightUniform; chiaroscuro_scene::MAX_LIGHTS],
}
