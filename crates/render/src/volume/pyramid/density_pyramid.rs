//! Pyramid of prefiltered densities with the gradients of its levels, made for the first picture that reads it:
//! pictures of labels, whose voxels are classified first, read neither.

use super::gradients::{self, gradient_texture};
use crate::volume::PyramidViews;
use crate::volume::texture_shapes::texel_count;
use crate::volume::textures::pyramid_texture;
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::{RenderEngine, Settings};
use chiaroscuro_volume::Volume;

/// Textures of the pyramid of densities and of its gradients.
#[derive(Debug)]
pub(crate) struct DensityPyramid {
    pub texture: wgpu::Texture,
    pub views: PyramidViews,
    /// Gradients of the pyramid; `None` if they take too much memory.
    pub gradients: Option<wgpu::Texture>,
    /// Views of the gradient texture.
    pub gradients_views: Option<PyramidViews>,
    is_complete: bool,
}

impl DensityPyramid {
    /// Creates the textures, which have yet to be filled.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold the pyramid.
    pub(crate) fn new(context: &GpuContext, volume: &Volume) -> Result<Self, GpuError> {
        let texture = pyramid_texture(context, volume.dims())?;
        let gradients = gradient_texture(context, &texture);
        Ok(Self {
            views: PyramidViews::new(&texture),
            texture,
            gradients_views: gradients.as_ref().map(PyramidViews::new),
            gradients,
            is_complete: false,
        })
    }

    /// Marks all levels as complete.
    pub(crate) fn mark_complete(&mut self) {
        self.is_complete = true;
    }

    /// Returns true if all levels are complete.
    pub(crate) fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Returns the size of the gradient texture, in bytes.
    pub(crate) fn gradient_bytes(&self) -> u64 {
        self.gradients.as_ref().map_or(0, |texture| gradients::gradient_bytes(texel_count(texture)))
    }
}

/// Returns true if pictures with these settings read the pyramid: all but those that gather voxels classified first.
pub(crate) fn needs_density_pyramid(settings: &Settings) -> bool {
    let sampling = &settings.sampling;
    !sampling.classification.is_pre() || sampling.engine == RenderEngine::Scatter
}
