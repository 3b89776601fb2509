//! Page pool: the pages of finer levels on the GPU, in the slots of one texture, and the table of their slots.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::layers::BakedLayers;
use super::texture_3d;
use crate::pipelines::uniforms::{MAX_PAGE_LEVELS, PageLevelUniform, PagesUniform};
use crate::plan::{PagedView, PixelWindow};
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::math::SceneSpace;
use chiaroscuro_volume::{
    FinerLevels, PAGE_STORED_EDGE, Page, PageAddress, PagesId, PoolLayout, ResidentPages,
};
use half::f16;

/// Number of pages that one step uploads: some 11 MiB.
pub(crate) const PAGES_PER_STEP: usize = 16;

/// Pages on the GPU.
#[derive(Debug)]
pub(crate) struct PagePool {
    texture: wgpu::Texture,
    pub view: wgpu::TextureView,
    table: Option<PageTable>,
    layout: PoolLayout,
    /// Slot of each resident page.
    places: BTreeMap<PageAddress, usize>,
    /// Pages whose texels have yet to be uploaded, with their slots.
    pending: Vec<(usize, Arc<Page>)>,
    levels: Arc<FinerLevels>,
    /// Ranges of densities of all pages that were read.
    ranges: Arc<BTreeMap<PageAddress, [f32; 2]>>,
    id: PagesId,
    is_unorm: bool,
}

/// Table of the slots of all pages, with the layers by which it was found which of them show nothing.
#[derive(Debug)]
struct PageTable {
    /// One entry per page of all levels (`shaders/volume/pages.wgsl`).
    buffer: wgpu::Buffer,
    eye: Arc<BakedLayers>,
    lighting: Arc<BakedLayers>,
}

impl PagePool {
    /// Creates a pool with some pages, which have yet to be uploaded; those that an earlier pool has stay where they are.
    ///
    /// # Errors
    /// Returns an error if the adapter cannot hold them.
    pub(crate) fn new(
        context: &GpuContext,
        pages: &ResidentPages,
        earlier: Option<Self>,
    ) -> Result<Self, GpuError> {
        let count = pages.pages().len();
        let earlier =
            earlier.filter(|known| known.levels == *pages.levels() && count <= known.layout.page_count());
        let is_unorm = context.has_unorm16;
        let (texture, layout, mut places, mut pending) =
            if let Some(Self { texture, layout, places, pending, .. }) = earlier {
                (texture, layout, places, pending)
            } else {
                let (texture, layout) = pool_texture(context, count, is_unorm)?;
                (texture, layout, BTreeMap::new(), Vec::new())
            };
        places.retain(|address, _| pages.pages().contains_key(address));
        let mut is_taken = vec![false; layout.page_count()];
        for slot in places.values() {
            is_taken[*slot] = true;
        }
        pending.retain(|(slot, _)| is_taken[*slot]);
        let mut free = (0..is_taken.len()).filter(|slot| !is_taken[*slot]);
        for (address, page) in pages.pages() {
            if places.contains_key(address) {
                continue;
            }
            let Some(slot) = free.next() else { break };
            places.insert(*address, slot);
            pending.push((slot, Arc::clone(page)));
        }
        Ok(Self {
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            texture,
            table: None,
            layout,
            places,
            pending,
            levels: Arc::clone(pages.levels()),
            ranges: Arc::clone(pages.ranges()),
            id: pages.id(),
            is_unorm,
        })
    }

    /// Returns the identity of the pages that the pool holds.
    pub(crate) fn id(&self) -> PagesId {
        self.id
    }

    /// Updates the table of slots to the densities that layers show. Returns true if it is another one.
    pub(crate) fn refresh_table(
        &mut self,
        context: &GpuContext,
        eye: &Arc<BakedLayers>,
        lighting: &Arc<BakedLayers>,
    ) -> bool {
        let is_valid = self.table.as_ref().is_some_and(|known| {
            known.eye.has_same_visibility(eye) && known.lighting.has_same_visibility(lighting)
        });
        if is_valid {
            return false;
        }
        let tests = [eye.visibility_test(), lighting.visibility_test()];
        let is_visible = |range: [f32; 2]| tests.iter().any(|test| test(range));
        let is_constant = |(address, range): &(&PageAddress, &[f32; 2])| {
            !self.places.contains_key(address) && !Page::has_texels(**range, is_visible)
        };
        let constants = self.ranges.iter().filter(is_constant);
        let constants = constants.map(|(address, range)| (*address, range[0])).collect();
        let table = page_table(&self.levels, &self.places, &constants, self.layout);
        let buffer = context.buffer("PagePool::table", &table, wgpu::BufferUsages::STORAGE);
        self.table = Some(PageTable { buffer, eye: Arc::clone(eye), lighting: Arc::clone(lighting) });
        true
    }

    /// Returns the table of slots, once it is made.
    pub(crate) fn table(&self) -> Option<&wgpu::Buffer> {
        self.table.as_ref().map(|table| &table.buffer)
    }

    /// Returns the number of steps that upload what is missing.
    pub(crate) fn pending_steps(&self) -> usize {
        self.pending.len().div_ceil(PAGES_PER_STEP)
    }

    /// Uploads the next pages that are missing.
    pub(crate) fn upload(&mut self, context: &GpuContext) {
        let first = self.pending.len().saturating_sub(PAGES_PER_STEP);
        for (slot, page) in self.pending.drain(first..) {
            let place = self.layout.slot_place(slot).map(|c| (c * PAGE_STORED_EDGE) as u32);
            let converted: Vec<u16>;
            let texels = if self.is_unorm {
                &page.texels
            } else {
                let float = |texel: &u16| f16::from_f32(f32::from(*texel) / 65535.0).to_bits();
                converted = page.texels.iter().map(float).collect();
                &converted
            };
            let edge = PAGE_STORED_EDGE as u32;
            context.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    texture: &self.texture,
                    mip_level: 0,
                    origin: wgpu::Origin3d { x: place[0], y: place[1], z: place[2] },
                    aspect: wgpu::TextureAspect::All,
                },
                bytemuck::cast_slice(texels),
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(2 * edge),
                    rows_per_image: Some(edge),
                },
                wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: edge },
            );
        }
    }

    /// Returns the levels that a picture reads, if those in memory are not fine enough for it.
    pub(crate) fn view_of(
        &self,
        settings: &Settings,
        scene: &SceneSpace,
        window: PixelWindow,
    ) -> Option<PagedView> {
        PagedView::new(&self.levels, settings, scene, window)
    }

    /// Returns the uniform of the levels that a picture reads.
    pub(crate) fn uniform(&self, view: &PagedView) -> PagesUniform {
        let mut levels = [PageLevelUniform::default(); MAX_PAGE_LEVELS];
        let mut first = 0;
        let finest = &self.levels.0[view.first];
        for (index, level) in self.levels.0.iter().enumerate() {
            let pages = level.page_dims();
            let slot = index.checked_sub(view.first).and_then(|relative| levels.get_mut(relative));
            if let Some(uniform) = slot {
                let scale: [f32; 3] =
                    std::array::from_fn(|axis| level.per_voxel[axis] as f32 / finest.per_voxel[axis] as f32);
                *uniform = PageLevelUniform { scale, first, pages: pages.map(|n| n as u32), pad0: 0 };
            }
            first += pages.iter().product::<usize>() as u32;
        }
        PagesUniform {
            coarse: view.coarse.as_vec3().into(),
            count: view.level_count.min(MAX_PAGE_LEVELS) as u32,
            texel: self.layout.edges.map(|edge| 1.0 / edge as f32),
            level_in_memory: view.level_count as f32,
            level_0: levels[0],
            level_1: levels[1],
            level_2: levels[2],
            level_3: levels[3],
            first_level: view.first as u32,
            ..PagesUniform::default()
        }
    }

    /// Returns the size of the texture, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.layout.bytes()
    }
}

/// Creates a texture with slots for a number of pages, or as many as the adapter allows.
fn pool_texture(
    context: &GpuContext,
    count: usize,
    is_unorm: bool,
) -> Result<(wgpu::Texture, PoolLayout), GpuError> {
    let layout = PoolLayout::for_pages(count, context.device.limits().max_texture_dimension_3d as usize);
    let format = if is_unorm { wgpu::TextureFormat::R16Unorm } else { wgpu::TextureFormat::R16Float };
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    Ok((context.texture(&texture_3d("PagePool::texture", layout.edges, format, usage))?, layout))
}

/// Entry of the table for a page whose densities are the same all over, or show nothing: the density, and a bit.
fn constant_entry(density: f32) -> u32 {
    (density.clamp(0.0, 1.0) * 65535.0 + 0.5) as u32 | 1 << 30
}

/// Returns the table of all levels, of which the coarsest is last, as `shaders/volume/pages.wgsl` reads it: for each page its
/// slot or its only density or, if it is absent, the entry of the finest coarser one in its place.
fn page_table(
    levels: &FinerLevels,
    places: &BTreeMap<PageAddress, usize>,
    constants: &BTreeMap<PageAddress, f32>,
    layout: PoolLayout,
) -> Vec<u32> {
    let mut tables: Vec<Vec<u32>> = Vec::new();
    // Coarse levels first, which stand in for finer ones.
    for (index, level) in levels.0.iter().enumerate().rev() {
        let [nx, ny, nz] = level.page_dims();
        let coarser = levels.0.get(index + 1).zip(tables.last());
        let mut table = vec![0; nx * ny * nz];
        if let Some((coarse, above)) = coarser {
            let [width, height, _] = coarse.page_dims();
            for (at, entry) in table.iter_mut().enumerate() {
                let place = [at % nx, at / nx % ny, at / (nx * ny)];
                let [x, y, z]: [usize; 3] =
                    std::array::from_fn(|axis| place[axis] * coarse.per_voxel[axis] / level.per_voxel[axis]);
                *entry = above[x + width * (y + height * z)];
            }
        }
        let begin = PageAddress { level: index, at: [0; 3] };
        let end = PageAddress { level: index + 1, at: [0; 3] };
        for (PageAddress { at: [x, y, z], .. }, density) in constants.range(begin..end) {
            table[x + nx * (y + ny * z)] = constant_entry(*density);
        }
        for (PageAddress { at: [x, y, z], .. }, slot) in places.range(begin..end) {
            let [sx, sy, sz] = layout.slot_place(*slot).map(|c| c as u32);
            table[x + nx * (y + ny * z)] = sx | sy << 8 | sz << 16 | (index as u32) << 24 | 1 << 31;
        }
        tables.push(table);
    }
    tables.into_iter().rev().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarser_pages_take_the_place_of_absent_ones() {
        let fine = [([300, 64, 64], "0".to_owned()), ([150, 32, 32], "1".to_owned())];
        let levels = FinerLevels::of_volume([75, 16, 16], fine);
        let place = |level, x| PageAddress { level, at: [x, 0, 0] };
        let places = BTreeMap::from([(place(0, 3), 5), (place(1, 1), 3)]);
        let (own, coarse) = (2 | 1 << 8 | 1 << 31, 1 << 8 | 1 << 24 | 1 << 31);
        // Five pages of the finest level, and three of the other.
        let table =
            |constants| page_table(&levels, &places, &constants, PoolLayout { edges: [256, 256, 128] });
        assert_eq!(table(BTreeMap::new()), [0, 0, coarse, own, 0, 0, coarse, 0]);
        let (low, high) = (1 << 30, 65535 | 1 << 30);
        let constants = BTreeMap::from([(place(0, 2), 0.0), (place(1, 0), 1.0)]);
        assert_eq!(table(constants), [high, high, low, own, 0, high, coarse, 0]);
    }
}
