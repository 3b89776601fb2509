//! Uniforms of the shaders for scattered light.

use bytemuck::{Pod, Zeroable};

use super::{Light, Space};

/// Look-up of scattered light, as declared in `shading/bounces.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Bounces {
    pub lookup: [f32; 3],
    pub ahead: f32,
    pub share: f32,
    pub pad0: f32,
    pub pad1: f32,
    pub pad2: f32,
}

/// Parameters of passes over blocks of scattered light, as declared in `bounces/bounce.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Bounce {
    pub dims: [u32; 3],
    pub share: f32,
    pub color: [f32; 3],
    pub least: f32,
}

/// Scene of the single-scattering pass, as declared in `bounces/first.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct First {
    pub space: Space,
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
    pub lights: [Light; crate::model::MAX_LIGHTS],
}
