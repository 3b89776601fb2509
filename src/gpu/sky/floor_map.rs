//! A map of what the floor sees of the sky.

use glam::DVec3;

use crate::gpu::pipelines::uniforms;
use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};
use crate::math::SceneSpace;
use crate::plan::SkyFloor;

/// Texels along an edge.
pub(crate) const MAP_EDGE: u32 = 192;

/// How far the map reaches from the middle of the floor, in scene units: beyond, a volume hides next to nothing.
const REACH: f64 = 3.0;

/// What the floor sees of the sky.
#[derive(Debug)]
pub(crate) struct FloorMap {
    /// Where the floor lies.
    pub place: SkyFloor,
    /// C₁ in rgb, C₀ in a.
    pub view: wgpu::TextureView,
}

impl FloorMap {
    /// Makes the texture; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(context: &Context, place: SkyFloor) -> Result<Self, GpuError> {
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let format = wgpu::TextureFormat::Rgba16Float;
        let edge = MAP_EDGE as usize;
        let texture = context.texture(&texture_3d("FloorMap::texture", [edge, edge, 1], format, usages))?;
        Ok(Self { place, view: texture.create_view(&wgpu::TextureViewDescriptor::default()) })
    }

    /// Bytes of its texture.
    pub(crate) const fn bytes() -> u64 {
        8 * MAP_EDGE as u64 * MAP_EDGE as u64
    }

    /// For the shader that fills it from blocks of so many voxels along an edge: `share` is one over what an open floor's moment is a sum of.
    pub(crate) fn uniform(&self, scene: &SceneSpace, divisor: usize, share: f64) -> uniforms::FloorMap {
        let divisor = divisor as f64;
        let block = |place: DVec3| (scene.index_from_scene.transform_point3(place) + 0.5) / divisor - 0.5;
        let [right, front, up] = self.axes();
        let texel = 2.0 * REACH / f64::from(MAP_EDGE);
        let corner = up * self.place.height - (right + front) * (REACH - 0.5 * texel);
        let origin = block(corner);
        let along = |axis: DVec3| (block(corner + axis * texel) - origin).as_vec3().into();
        uniforms::FloorMap {
            origin: origin.as_vec3().into(),
            share: share as f32,
            along_x: along(right),
            size: MAP_EDGE,
            along_y: along(front),
            pad0: 0.0,
            up: up.as_vec3().into(),
            pad1: 0.0,
        }
    }

    /// From scene space to texture coordinates: vectors, and what is added.
    pub(crate) fn lookup(place: SkyFloor) -> [[f32; 4]; 2] {
        let map = |axis: DVec3| (axis / (2.0 * REACH)).extend(0.5).as_vec4().into();
        let [right, front, _] = axes(place);
        [map(right), map(front)]
    }

    fn axes(&self) -> [DVec3; 3] {
        axes(self.place)
    }
}

/// Two directions along a floor, and up.
fn axes(place: SkyFloor) -> [DVec3; 3] {
    let upright = place.up.scene_from_upright();
    [upright * DVec3::X, upright * DVec3::Y, place.up.direction()]
}
