//! Page pool: the pages of finer levels on the GPU, in the slots of one texture, and the table of their slots.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::texture_3d;
use crate::pipelines::uniforms::{MAX_PAGE_LEVELS, PageLevelUniform, PagesUniform};
use crate::plan::{PagedView, PixelWindow};
use crate::{GpuContext, GpuError};
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::math::SceneSpace;
use chiaroscuro_volume::{FinerLevels, PAGE_STORED_EDGE, Page, PageAddress, PagesId, ResidentPages};
use half::f16;

/// Number of pages that one step uploads: some 11 MiB.
pub(crate) const PAGES_PER_STEP: usize = 16;

/// Pages on the GPU.
#[derive(Debug)]
pub(crate) struct PagePool {
    texture: wgpu::Texture,
    pub view: wgpu::TextureView,
    /// Slots of the pages of all levels, one entry per page (`shaders/volume/pages.wgsl`).
    pub table: wgpu::Buffer,
    /// Number of slots along x, y and z.
    slots: [usize; 3],
    /// Slot of each resident page.
    places: BTreeMap<PageAddress, usize>,
    /// Pages whose texels have yet to be uploaded, with their slots.
    pending: Vec<(usize, Arc<Page>)>,
    levels: Arc<FinerLevels>,
    id: PagesId,
    is_unorm: bool,
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
        let earlier = earlier.filter(|known| {
            known.levels == *pages.levels() && count <= known.slots.iter().product::<usize>()
        });
        let is_unorm = context.has_unorm16;
        let (texture, slots, mut places, mut pending) =
            if let Some(Self { texture, slots, places, pending, .. }) = earlier {
                (texture, slots, places, pending)
            } else {
                let (texture, slots) = pool_texture(context, pages, is_unorm)?;
                (texture, slots, BTreeMap::new(), Vec::new())
            };
        places.retain(|address, _| pages.pages().contains_key(address));
        let mut is_taken = vec![false; slots.iter().product()];
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
        let table = page_table(pages.levels(), &places, slots);
        Ok(Self {
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            texture,
            table: context.buffer("PagePool::table", &table, wgpu::BufferUsages::STORAGE),
            slots,
            places,
            pending,
            levels: Arc::clone(pages.levels()),
            id: pages.id(),
            is_unorm,
        })
    }

    /// Returns the identity of the pages that the pool holds.
    pub(crate) fn id(&self) -> PagesId {
        self.id
    }

    /// Returns the number of steps that upload what is missing.
    pub(crate) fn pending_steps(&self) -> usize {
        self.pending.len().div_ceil(PAGES_PER_STEP)
    }

    /// Uploads the next pages that are missing.
    pub(crate) fn upload(&mut self, context: &GpuContext) {
        let first = self.pending.len().saturating_sub(PAGES_PER_STEP);
        for (slot, page) in self.pending.drain(first..) {
            let place = slot_place(slot, self.slots).map(|c| (c * PAGE_STORED_EDGE) as u32);
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
            texel: self.slots.map(|n| 1.0 / (n * PAGE_STORED_EDGE) as f32),
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
        self.slots.iter().product::<usize>() as u64 * Page::bytes()
    }
}

/// Creates a texture that holds at least these pages, with the number of its slots along x, y and z.
fn pool_texture(
    context: &GpuContext,
    pages: &ResidentPages,
    is_unorm: bool,
) -> Result<(wgpu::Texture, [usize; 3]), GpuError> {
    // Slots are stored in eight bits along each axis.
    let longest = (context.device.limits().max_texture_dimension_3d as usize / PAGE_STORED_EDGE).min(255);
    let count = pages.pages().len();
    // A quarter more if there is room, so that a moved camera does not mean another texture.
    let slots = slot_dims((count + count / 4 + 1).min(pages.capacity()).max(count), longest);
    let format = if is_unorm { wgpu::TextureFormat::R16Unorm } else { wgpu::TextureFormat::R16Float };
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let dims = slots.map(|n| n * PAGE_STORED_EDGE);
    Ok((context.texture(&texture_3d("PagePool::texture", dims, format, usage))?, slots))
}

/// Returns the number of slots along x, y and z of a texture for at least `count` of them, at most `longest` along an axis.
fn slot_dims(count: usize, longest: usize) -> [usize; 3] {
    let longest = longest.max(1);
    let edge = (1..longest).find(|n| n * n * n >= count).unwrap_or(longest);
    [edge, edge, count.div_ceil(edge * edge).clamp(1, longest)]
}

fn slot_place(slot: usize, [nx, ny, _]: [usize; 3]) -> [usize; 3] {
    [slot % nx, slot / nx % ny, slot / (nx * ny)]
}

/// Returns the table of all levels, of which the coarsest is last: for each page the slot of itself or, if it is absent, of the
/// finest coarser one in its place, as `shaders/volume/pages.wgsl` reads it.
fn page_table(levels: &FinerLevels, places: &BTreeMap<PageAddress, usize>, slots: [usize; 3]) -> Vec<u32> {
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
        for (PageAddress { at: [x, y, z], .. }, slot) in places.range(begin..end) {
            let [sx, sy, sz] = slot_place(*slot, slots).map(|c| c as u32);
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
    fn slots_fill_a_box_within_the_limit() {
        assert_eq!(slot_dims(1, 29), [1, 1, 1]);
        assert_eq!(slot_dims(28, 29), [4, 4, 2]);
        assert_eq!(slot_dims(1_000_000, 29), [29, 29, 29]);
        assert_eq!(slot_place(13, [3, 2, 9]), [1, 0, 2]);
    }

    #[test]
    fn coarser_pages_take_the_place_of_absent_ones() {
        let fine = [([300, 64, 64], "0".to_owned()), ([150, 32, 32], "1".to_owned())];
        let levels = FinerLevels::of_volume([75, 16, 16], fine);
        let place = |level, x| PageAddress { level, at: [x, 0, 0] };
        let places = BTreeMap::from([(place(0, 3), 5), (place(1, 1), 2)]);
        let (own, coarse) = (1 | 1 << 16 | 1 << 31, 1 << 8 | 1 << 24 | 1 << 31);
        // Five pages of the finest level, and three of the other.
        assert_eq!(page_table(&levels, &places, [2, 2, 2]), [0, 0, coarse, own, 0, 0, coarse, 0]);
    }
}
