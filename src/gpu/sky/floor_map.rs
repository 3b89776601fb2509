//! A map of what the floor sees of the sky.

use glam::DVec3;

use crate::gpu::pipelines::uniforms;
use crate::gpu::volume::texture_3d;
use crate::gpu::{Context, GpuError};
use crate::math::SceneSpace;
use crate::plan::{FloorPlace, FloorTexels};

/// Texels along an edge: as fine as blocks of the sky's volume, within these. The most is a block of two voxels of 64 to the
/// scene's two units.
const EDGES: std::ops::RangeInclusive<u32> = 96..=192;

/// What the floor sees of the sky.
#[derive(Debug)]
pub(crate) struct FloorMap {
    /// Where the floor lies.
    pub place: FloorPlace,
    /// C₁ in rgb, C₀ in a.
    pub view: wgpu::TextureView,
    /// Texels along an edge.
    pub edge: u32,
}

impl FloorMap {
    /// Makes the texture, of a volume whose blocks are so long in scene units; nothing is filled yet.
    ///
    /// # Errors
    /// When memory is out.
    pub(crate) fn new(context: &Context, place: FloorPlace, block: f64) -> Result<Self, GpuError> {
        let edge = FloorPlace::texels_of(block).clamp(*EDGES.start(), *EDGES.end());
        let usages = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING;
        let format = wgpu::TextureFormat::Rgba16Float;
        let size = [edge as usize, edge as usize, 1];
        let texture = context.texture(&texture_3d("FloorMap::texture", size, format, usages))?;
        Ok(Self { place, view: texture.create_view(&wgpu::TextureViewDescriptor::default()), edge })
    }

    /// How many texels there are.
    pub(crate) fn texels(&self) -> u64 {
        u64::from(self.edge).pow(2)
    }

    /// Bytes of its texture.
    pub(crate) fn bytes(&self) -> u64 {
        8 * self.texels()
    }

    /// For the shader that fills it from blocks of so many voxels along an edge: `share` is one over what an open floor's moment is a sum of.
    pub(crate) fn uniform(&self, scene: &SceneSpace, divisor: usize, share: f64) -> uniforms::FloorMap {
        let divisor = divisor as f64;
        let block = |place: DVec3| (scene.index_from_scene.transform_point3(place) + 0.5) / divisor - 0.5;
        let FloorTexels { origin: corner, along: [right, front] } = self.place.texels(self.edge);
        let origin = block(corner);
        // Heights in the scene are heights over the plane, whichever the place in blocks: w such that the corner is in it.
        let up = self.place.up.direction();
        let scene_from_block = scene.scene_from_index.matrix3 * divisor;
        let normal = scene_from_block.transpose() * up;
        let along = |step: DVec3| (block(corner + step) - origin).as_vec3().into();
        uniforms::FloorMap {
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
