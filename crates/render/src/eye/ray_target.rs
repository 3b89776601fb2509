//! Pictures and rays of the dispatches that draw with the eye pass.

use crate::pipelines::uniforms;

/// Pictures and the list of pixels that the eye's rays read and write.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RayTarget<'a> {
    /// Picture that is drawn.
    pub picture: &'a wgpu::TextureView,
    /// Another picture, with the sum of earlier rays if the ray is added to them.
    pub earlier: &'a wgpu::TextureView,
    /// List of pixels with edges, which is read if only listed pixels are drawn.
    pub edges: &'a wgpu::Buffer,
}

/// Ray through each pixel that a dispatch draws.
#[derive(Debug, Clone, Copy)]
pub(super) struct DrawnRay<'a> {
    pub target: RayTarget<'a>,
    pub ray: uniforms::PixelRayUniform,
    /// Number of slabs in the stack of the ray.
    pub slab_count: u32,
}
