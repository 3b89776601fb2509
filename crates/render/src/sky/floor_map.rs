//! Sky-visibility map of the floor, as moments over the directions above.

use glam::DVec3;

use crate::pipelines::uniforms;
use crate::plan::{FloorPlane, FloorTexels};
use crate::volume::texture_3d;
use crate::{GpuContext, GpuError};
use chiaroscuro_volume::math::SceneSpace;

/// Range of the map's texels along an edge; within it, texels are as large as the blocks of the sky volume. The
/// maximum is a block of two voxels of 64, for the two units of the scene.
const TEXEL_RANGE: std::ops::RangeInclusive<u32> = 96..=192;

/// Map of the sky visibility on the floor.
#[derive(Debug)]
pub(crate) struct FloorSkyMap {
    /// Extent of the floor that the map covers.
    pub extent: FloorPlane,
    /// View of the moments: C₁ in rgb, C₀ in a.
    pub view: wgpu::TextureView,
    /// Number of texels along an edge.
    pub edge: u32,
}

impl FloorSkyMap {
    /// Creates the texture, for a volume with blocks of edge `block` in scene units; nothing is filled yet.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext, place: FloorPlane, block: f64) -> Result<Self, GpuError> {
        let edge = FloorPlane::texel_count(block).clamp(*TEXEL_RANGE.start(), *TEXEL_RANGE.end());
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let format = wgpu::TextureFormat::Rgba16Float;
        let size = [edge as usize, edge as usize, 1];
        let texture = context.texture(&texture_3d("FloorMap::texture", size, format, usages))?;
        Ok(Self { extent: place, view: texture.create_view(&wgpu::TextureViewDescriptor::default()), edge })
    }

    /// Returns the number of texels.
    pub(crate) fn texels(&self) -> u64 {
        u64::from(self.edge).pow(2)
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        8 * self.texels()
    }

    /// Builds the uniform for filling the map from blocks of `divisor`³ voxels; `share` normalises the sums so that
    /// the moment C₀ of an open floor is 1.
    pub(crate) fn uniform(
        &self,
        scene: &SceneSpace,
        divisor: usize,
        share: f64,
    ) -> uniforms::FloorSkyMapUniform {
        let divisor = divisor as f64;
        let block = |place: DVec3| (scene.index_from_scene.transform_point3(place) + 0.5) / divisor - 0.5;
        let FloorTexels { origin: corner, along: [right, front] } = self.extent.texels(self.edge);
        let origin = block(corner);
        // The floor's plane in block coordinates: the gradient of height, and its value at the corner, which lies on
        // the floor.
        let up = self.extent.up.direction();
        let scene_from_block = scene.scene_from_index.matrix3 * divisor;
        let normal = scene_from_block.transpose() * up;
        let along = |step: DVec3| (block(corner + step) - origin).as_vec3().into();
        uniforms::FloorSkyMapUniform {
            origin: origin.as_vec3().into(),
            share: share as f32,
            along_x: along(right),
            size: self.edge,
            along_y: along(front),
            pad0: 0.0,
            plane: normal.extend(normal.dot(origin)).as_vec4().into(),
        }
    }
}
