//! Device, pipelines and pool: the tools of every pass, independent of the volume.

use super::resource_pool::ResourcePool;
use super::submission_pace::SubmissionPace;
use crate::{GpuContext, GpuError, ShaderLibrary};

/// Device with its pipelines and the resources that successive pictures share.
#[derive(Debug)]
pub(crate) struct GpuTools {
    pub context: GpuContext,
    pub shaders: ShaderLibrary,
    pub pool: ResourcePool,
    pub pace: SubmissionPace,
    /// 1 × 1 × 1 texture that is bound where a shader declares a texture which the pass does not need.
    pub placeholder: wgpu::TextureView,
}

impl GpuTools {
    /// Creates the tools for a device.
    ///
    /// # Errors
    /// Returns an error if memory is exhausted.
    pub(crate) fn new(context: &GpuContext, shaders: ShaderLibrary) -> Result<Self, GpuError> {
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
            pace: SubmissionPace::default(),
            placeholder: texel.create_view(&wgpu::TextureViewDescriptor::default()),
        })
    }
}
