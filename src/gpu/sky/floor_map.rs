//! A map of what the floor sees of the sky.

use glam::DVec3;

use crate::gpu::pipelines::uniforms;
use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};
use crate::math::SceneSpace;
use crate::plan::{FloorPlace, FloorTexels};

/// Texels along an edge.
pub(crate) const MAP_EDGE: u32 = 192;

/// What the floor sees of the sky.
#[derive(Debug)]
pub(crate) struct FloorMap {
    /// Where the floor lies.
    pub place: FloorPlace,
    /// C₁ in rgb, C₀ in a.
    pub view: wgpu::TextureView,
}

impl FloorMap {
    /// Makes the texture; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(context: &Context, place: FloorPlace) -> Result<Self, GpuError> {
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
        let FloorTexels { origin: corner, along: [right, front] } = self.place.texels(MAP_EDGE);
        let origin = block(corner);
        let along = |step: DVec3| (block(corner + step) - origin).as_vec3().into();
        uniforms::FloorMap {
            origin: origin.as_vec3().into(),
            share: share as f32,
            along_x: along(right),
            size: MAP_EDGE,
            along_y: along(front),
            pad0: 0.0,
        }
    }
}
