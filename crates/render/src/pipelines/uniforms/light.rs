//! Uniforms of the shaders for lights and light volumes.

use bytemuck::{Pod, Zeroable};

use super::{CutUniform, SpaceUniform};

/// Light source, as declared in `shading/lights.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct LightUniform {
    pub position_or_direction: [f32; 3],
    pub perspective: f32,
    pub color: [f32; 3],
    pub extinction_scale: f32,
    pub lookup: [f32; 3],
    pub cone_cos_inner: f32,
    pub cone_axis: [f32; 3],
    pub cone_cos_outer: f32,
    pub last_step_extension: f32,
    pub points: u32,
    pub shape: u32,
    pub near_steps: u32,
    pub area_right: [f32; 3],
    pub two_sided: f32,
    pub area_up: [f32; 3],
    pub pad0: f32,
    pub area_near: [f32; 3],
    pub pad1: f32,
}

/// Shading and shadow parameters, as declared in `shading/lights.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ShadingUniform {
    pub emission: f32,
    pub ambient: f32,
    pub diffuse: f32,
    pub specular: f32,
    pub shininess: f32,
    pub surface_gradient: f32,
    pub strength: f32,
    pub ambient_offset: f32,
    pub gain: f32,
    pub bias: f32,
    pub ray_step: f32,
    pub max_optical_depth: f32,
    pub anisotropy: f32,
    pub amid: f32,
    pub opacity_unit: f32,
    pub pad0: f32,
}

/// Parameters of casting rays from light voxels, as declared in `light/raycast.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct RaycastUniform {
    pub light: LightUniform,
    pub space: SpaceUniform,
    pub dims: [u32; 3],
    pub bricks: u32,
    pub voxel_step: f32,
    pub ray_step: f32,
    pub max_optical_depth: f32,
    pub pad0: u32,
    pub shading_cut: CutUniform,
}

/// Parameters of averaging an area light's points, as declared in `light/area_light.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct AverageUniform {
    pub dims: [u32; 3],
    pub bricks: u32,
    pub place: [f32; 3],
    pub perspective: f32,
    pub right: [f32; 3],
    pub share: f32,
    pub up: [f32; 3],
    pub voxel_step: f32,
    pub to_right: [f32; 4],
    pub to_top: [f32; 4],
    pub lookup: [f32; 3],
    pub pad0: f32,
    pub space: SpaceUniform,
}

/// Parameters of finding normals near blocks of voxels, as declared in `light/block_normals.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct BlockNormalsUniform {
    pub space: SpaceUniform,
    pub dims: [u32; 3],
    pub pad0: u32,
    pub opacity_scale: [f32; 3],
    pub pad1: f32,
}

/// Parameters of a floor shadow map, as declared in `light/floor_shadow.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct FloorShadowUniform {
    pub origin: [f32; 3],
    pub size: u32,
    pub along_x: [f32; 3],
    pub share: f32,
    pub along_y: [f32; 3],
    pub cube_face: u32,
    pub up: [f32; 3],
    pub perspective: f32,
    pub place: [f32; 3],
    pub pad0: f32,
    pub centre: [f32; 4],
    pub right: [f32; 4],
    pub top: [f32; 4],
    pub light_from_scene_x: [f32; 4],
    pub light_from_scene_y: [f32; 4],
    pub light_from_scene_z: [f32; 4],
    pub first_pixel: [f32; 2],
    pub first_texel: [u32; 2],
}
