//! Views of pyramid textures, and the levels that passes read.

/// Range of pyramid levels that a pass may read.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PyramidLevels {
    /// Level 0 alone, for kernels that are not stretched.
    Finest,
    /// All levels, for stretched kernels.
    All,
}

impl PyramidLevels {
    /// Returns the levels that stretched or unstretched kernels need.
    pub(crate) fn for_stretch(is_stretched: bool) -> Self {
        if is_stretched { Self::All } else { Self::Finest }
    }

    /// Selects the view with these levels.
    pub(crate) fn choose(self, views: &PyramidViews) -> &wgpu::TextureView {
        match self {
            Self::Finest => &views.finest,
            Self::All => &views.all,
        }
    }
}

/// Views of a pyramid texture: all levels, and the finest alone. For views with several levels a software driver
/// computes the level sizes for each lane and fetch, which the second view avoids.
#[derive(Debug)]
pub(crate) struct PyramidViews {
    /// View of all levels of the pyramid.
    pub all: wgpu::TextureView,
    /// View of level 0 of the pyramid.
    finest: wgpu::TextureView,
}

impl PyramidViews {
    pub(crate) fn new(texture: &wgpu::Texture) -> Self {
        let all = wgpu::TextureViewDescriptor::default();
        let finest = wgpu::TextureViewDescriptor { mip_level_count: Some(1), ..all.clone() };
        Self { all: texture.create_view(&all), finest: texture.create_view(&finest) }
    }
}
