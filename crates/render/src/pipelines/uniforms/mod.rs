//! Uniform structs, mirrored field by field in WGSL. `tests/shaders/structs.rs` compares names, offsets and sizes
//! with the declarations in the shaders.

#![cfg_attr(
    feature = "testing",
    expect(missing_docs, reason = "each field is documented where the shader declares it")
)]

mod layers;
mod light;
mod pages;
mod scattered_light;
mod sky;

pub use self::layers::{LayerUniform, LayersUniform, MaterialUniform};
pub use self::light::{
    AverageUniform, BlockNormalsUniform, FloorShadowUniform, LightUniform, RaycastUniform, ShadingUniform,
};
pub use self::pages::{MAX_PAGE_LEVELS, PageLevelUniform, PagesUniform};
pub use self::scattered_light::{
    BounceUniform, DiffusionLevelUniform, ScatteredLightUniform, SingleScatteringUniform,
};
pub use self::sky::{
    BlocksUniform, FloorSkyMapUniform, MAX_BATCH_DIRECTIONS, SkyDirectionsUniform, SkyUniform,
    SurfaceBlocksUniform, SweepRaysUniform, SweepUniform,
};

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec2, DVec3};

use crate::plan::SheetFrame as Frame;
use chiaroscuro_volume::math::{ClipRegion, SceneSpace};

fn vec3(v: DVec3) -> [f32; 3] {
    v.as_vec3().into()
}

fn vec2(v: DVec2) -> [f32; 2] {
    v.as_vec2().into()
}

/// Returns the three rows of an affine map, with the translation in w.
pub(crate) fn rows(map: &DAffine3) -> [[f32; 4]; 3] {
    let transposed = map.matrix3.transpose();
    let row = |linear: DVec3, offset: f64| [linear.x as f32, linear.y as f32, linear.z as f32, offset as f32];
    [
        row(transposed.x_axis, map.translation.x),
        row(transposed.y_axis, map.translation.y),
        row(transposed.z_axis, map.translation.z),
    ]
}

/// Rays and slabs of a stack of sheets, as declared in `sheets/sheet_frame.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SheetFrameUniform {
    pub origin: [f32; 3],
    pub first_depth: f32,
    pub origin_di: [f32; 3],
    pub slab: f32,
    pub origin_dj: [f32; 3],
    pub pitch: f32,
    pub direction: [f32; 3],
    pub inverse_distance: f32,
    pub direction_di: [f32; 3],
    pub voxel_edge: f32,
    pub direction_dj: [f32; 3],
    pub slab_count: u32,
    pub slope: [f32; 2],
    pub slope_di: [f32; 2],
    pub slope_dj: [f32; 2],
    pub size: [u32; 2],
}

impl SheetFrameUniform {
    pub fn new(frame: &Frame) -> Self {
        Self {
            origin: vec3(frame.origin.base),
            first_depth: frame.first_depth as f32,
            origin_di: vec3(frame.origin.per_i),
            slab: frame.slab as f32,
            origin_dj: vec3(frame.origin.per_j),
            pitch: frame.pitch as f32,
            direction: vec3(frame.direction.base),
            inverse_distance: frame.inverse_distance as f32,
            direction_di: vec3(frame.direction.per_i),
            voxel_edge: frame.voxel_edge as f32,
            direction_dj: vec3(frame.direction.per_j),
            slab_count: frame.slab_count,
            slope: vec2(frame.slope.base),
            slope_di: vec2(frame.slope.per_i),
            slope_dj: vec2(frame.slope.per_j),
            size: frame.size,
        }
    }
}

/// Crop box and clip plane, as declared in `density/cut.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct CutUniform {
    pub low: [f32; 3],
    pub pad0: f32,
    pub high: [f32; 3],
    pub pad1: f32,
    pub plane: [f32; 4],
}

impl CutUniform {
    /// Distance, in voxels, of the faces and the plane where nothing is cut: far outside every volume, and far from
    /// overflow.
    const UNBOUNDED_VOXELS: f64 = 1e9;

    pub fn new(region: &ClipRegion) -> Self {
        let near = |v: DVec3| {
            vec3(v.clamp(DVec3::splat(-Self::UNBOUNDED_VOXELS), DVec3::splat(Self::UNBOUNDED_VOXELS)))
        };
        let plane = region
            .plane
            .map_or(DVec3::ZERO.extend(Self::UNBOUNDED_VOXELS), |half| half.normal.extend(half.offset));
        Self {
            low: near(region.low),
            pad0: 0.0,
            high: near(region.high),
            pad1: 0.0,
            plane: plane.as_vec4().into(),
        }
    }
}

/// Voxel grid and texture scales, as declared in `volume/field.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct GridUniform {
    pub dims: [f32; 3],
    pub dilation: i32,
    pub density_scale: [f32; 3],
    pub pad0: f32,
    pub pyramid_scale: [f32; 3],
    pub pad1: f32,
    pub cell_scale: [f32; 3],
    pub pad2: f32,
}

/// Parameters of filling a pyramid level, as declared in `volume/levels.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct PyramidLevelUniform {
    pub bricks: u32,
    pub spacing: f32,
    pub pad0: u32,
    pub pad1: u32,
}

/// Parameters of a slab of the scattering engine, as declared in `scatter/slab.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ScatterSlabUniform {
    pub frame: SheetFrameUniform,
    pub sheets_from_index_x: [f32; 4],
    pub sheets_from_index_y: [f32; 4],
    pub sheets_from_index_z: [f32; 4],
    pub half_extents: [f32; 3],
    pub stretch: f32,
    pub dims: [f32; 3],
    pub k: u32,
    pub bricks: [i32; 3],
    pub layers: u32,
    pub first: u32,
    pub count: u32,
    pub pixel_share: f32,
    pub voxel_step: f32,
    pub light_dims: [u32; 3],
    pub cube_face: u32,
    pub first_pixel: [f32; 2],
    pub sheet_count: u32,
    pub first_slice: f32,
    pub axis: [f32; 3],
    pub slice_step: f32,
    pub extinction_unit: f32,
    pub pad0: f32,
    pub pad1: f32,
    pub pad2: f32,
}

/// Phase of compositing footprints, as declared in `scatter/footprints.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct FootprintPhaseUniform {
    pub u: u32,
    pub v: u32,
    pub brick_u: u32,
    pub brick_v: u32,
    pub stride: u32,
    pub pad0: u32,
    pub pad1: u32,
    pub pad2: u32,
}

/// Parameters of marching light through slabs, as declared in `sheets/march.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct MarchUniform {
    pub frame: SheetFrameUniform,
    pub begin: u32,
    pub end: u32,
    pub layers: u32,
    pub tiles: u32,
    pub extinction_scale: f32,
    pub cone_cos_inner: f32,
    pub cone_cos_outer: f32,
    pub reach: i32,
    pub cone_axis: [f32; 3],
    pub min_transmittance: f32,
    pub shading_cut: CutUniform,
}

/// Parameters of the back-projection, as declared in `light/backproject.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct BackprojectionUniform {
    pub frame: SheetFrameUniform,
    pub light_from_index_x: [f32; 4],
    pub light_from_index_y: [f32; 4],
    pub light_from_index_z: [f32; 4],
    pub first_pixel: [f32; 2],
    pub kernel_edge: f32,
    pub voxel_step: f32,
    pub dims: [u32; 3],
    pub cube_face: u32,
    pub begin: u32,
    pub end: u32,
    pub layers: u32,
    pub bricks: u32,
    pub ring_scale: [f32; 2],
    pub pad0: f32,
    pub pad1: f32,
}

/// Parameters of combining lights, as declared in `light/combined_light.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct CombineUniform {
    pub dims: [u32; 3],
    pub bricks: u32,
    pub voxel_step: f32,
    pub pad0: f32,
    pub pad1: f32,
    pub pad2: f32,
}

/// Transforms between index and scene space, as declared in `common/space.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SpaceUniform {
    pub scene_from_index_x: [f32; 4],
    pub scene_from_index_y: [f32; 4],
    pub scene_from_index_z: [f32; 4],
    pub index_from_scene_x: [f32; 4],
    pub index_from_scene_y: [f32; 4],
    pub index_from_scene_z: [f32; 4],
}

impl SpaceUniform {
    pub fn new(scene: &SceneSpace) -> Self {
        let [scene_from_index_x, scene_from_index_y, scene_from_index_z] = rows(&scene.scene_from_index);
        let [index_from_scene_x, index_from_scene_y, index_from_scene_z] = rows(&scene.index_from_scene);
        Self {
            scene_from_index_x,
            scene_from_index_y,
            scene_from_index_z,
            index_from_scene_x,
            index_from_scene_y,
            index_from_scene_z,
        }
    }
}

/// Parameters of the eye pass, as declared in `shading/shade.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct EyeUniform {
    pub frame: SheetFrameUniform,
    pub shading: ShadingUniform,
    pub space: SpaceUniform,
    pub eye: [f32; 4],
    pub first_row: u32,
    pub end_row: u32,
    pub dilation: i32,
    pub min_transmittance: f32,
    pub gradient_pixels: i32,
    pub gradient_slabs: i32,
    pub runs: u32,
    pub voxel_edge: f32,
    pub combined_lookup: [f32; 3],
    /// Share of the visible light above which an adaptive slab is halved.
    pub max_undivided_share: f32,
    pub visible_cut: CutUniform,
    pub face_cut: CutUniform,
    pub shading_cut: CutUniform,
    pub sky: SkyUniform,
    pub scattered_light: ScatteredLightUniform,
    pub lights: [LightUniform; chiaroscuro_scene::MAX_LIGHTS],
}

/// Parameters of the floor pass, as declared in `eye/floor.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct FloorUniform {
    pub frame: SheetFrameUniform,
    pub space: SpaceUniform,
    pub shading: ShadingUniform,
    pub shading_cut: CutUniform,
    pub plane: [f32; 4],
    pub up: [f32; 3],
    pub height: f32,
    pub color: [f32; 3],
    pub opacity: f32,
    pub radius: f32,
    pub fade_width: f32,
    pub inverse_balance: f32,
    pub shadow_only: f32,
    pub first_row: u32,
    pub end_row: u32,
    pub runs: u32,
    pub pad0: u32,
    pub sky: SkyUniform,
    pub map_x: [f32; 4],
    pub map_y: [f32; 4],
    pub lights: [LightUniform; chiaroscuro_scene::MAX_LIGHTS],
}

/// Ray through each pixel of a dispatch, as declared in `eye/eye_pass.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct PixelRayUniform {
    pub place: [f32; 4],
    pub is_listed: u32,
    pub is_added: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// Picture and rows of the search for edges, as declared in `eye/edges.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct EdgesUniform {
    pub size: [u32; 2],
    pub first_row: u32,
    pub end_row: u32,
    pub min_contrast: f32,
    pub pad0: u32,
    pub pad1: u32,
    pub pad2: u32,
}

/// Parameters of the display pass, as declared in `output/tone_map.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct DisplayUniform {
    pub top: [f32; 4],
    pub bottom: [f32; 4],
    pub transparent: u32,
    pub clip: u32,
    pub exposure: f32,
    pub first_row: f32,
    pub rows: f32,
    pub first_column: f32,
    pub dither_step: f32,
    pub floor_exposure: f32,
}
