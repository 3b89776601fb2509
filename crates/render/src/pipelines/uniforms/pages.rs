//! Uniform of the pages of finer levels, mirrored in `shaders/volume/pages.wgsl`.

use bytemuck::{Pod, Zeroable};

/// Maximum number of levels of pages that a picture reads: kernels are stretched over two levels, and one more stands in for
/// pages that are absent.
pub const MAX_PAGE_LEVELS: usize = 4;

/// Level of pages, as declared in `volume/pages.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct PageLevelUniform {
    pub scale: [f32; 3],
    pub first: u32,
    pub pages: [u32; 3],
    pub pad0: u32,
}

/// Pages of a picture, as declared in `volume/pages.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
pub struct PagesUniform {
    pub coarse: [f32; 3],
    pub count: u32,
    pub texel: [f32; 3],
    pub level_in_memory: f32,
    pub level_0: PageLevelUniform,
    pub level_1: PageLevelUniform,
    pub level_2: PageLevelUniform,
    pub level_3: PageLevelUniform,
    pub first_level: u32,
    pub pad0: u32,
    pub pad1: u32,
    pub pad2: u32,
}
