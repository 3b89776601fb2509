//! Uniforms of layers, of which voxels are composed.

use bytemuck::{Pod, Zeroable};

use chiaroscuro_scene::MAX_MATERIAL_BOXES;
use chiaroscuro_volume::MAX_FIELDS;

/// Parameters of a layer, as declared in `volume/layers.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct LayerUniform {
    pub blend: u32,
    pub is_label: u32,
    pub opacity_unit: f32,
    pub edges: f32,
    pub material_count: u32,
    pub ignores_cuts: u32,
    pub pad1: u32,
    pub pad2: u32,
    pub materials: [MaterialUniform; MAX_MATERIAL_BOXES],
}

/// Parameters of a material by value and change, as declared in `volume/layers.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct MaterialUniform {
    pub densities: [f32; 4],
    pub changes: [f32; 4],
    pub matter: [f32; 4],
}

/// Parameters of all layers, as declared in `volume/layers.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LayersUniform {
    pub count: u32,
    pub largest: f32,
    pub voxel: f32,
    pub pad0: u32,
    pub layers: [LayerUniform; MAX_FIELDS],
}
