//! What every pass works with, whichever volume there is.

use super::pool::ResourcePool;
use crate::gpu::{Context, GpuError, ShaderLibrary};

/// The device, its pipelines, and resources that pictures leave for each other.
#[derive(Debug)]
pub(crate) struct Tools {
    pub context: Context,
    pub shaders: ShaderLibrary,
    pub pool: ResourcePool,
    /// Bound where a shader declares a light volume and a light has none.
    pub placeholder: wgpu::TextureView,
}

impl Tools {
    /// Tools for a device.
    ///
    /// # Errors
    /// When not even one texel can be had.
    pub(crate) fn new(context: &Context, shaders: ShaderLibrary) -> Result<Self, GpuError> {
        let texel = context.texture(&wgpu::TextureDescriptor {
            label: Some("Tools::placeholder"),
            size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: context.storage_format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })?;
        Ok(Self {
            context: context.clone(),
            shaders,
            pool: ResourcePool::default(),
            placeholder: texel.create_view(&wgpu::TextureViewDescriptor::default()),
        })
    }
}
