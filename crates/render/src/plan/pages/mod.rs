//! Pages of finer levels that a picture reads, and the level whose grid is then its index space.

mod demand;
mod view_pyramid;

use glam::DVec3;

pub use self::demand::{PageDemand, density_visibility, fill_pages, fill_part, page_demand};
use self::view_pyramid::ViewPyramid;
use crate::plan::{PixelWindow, picture_frame};
use chiaroscuro_scene::{FinerLevelRecord, LayerComposition, Settings, ShadowAlgorithm};
use chiaroscuro_volume::math::SceneSpace;
use chiaroscuro_volume::{FinerLevels, PAGE_EDGE, PageAddress};

/// Distance around a page, in its voxels, within which it may be read for what is outside: gradients reach three voxels,
/// near-field rays six.
const PAGE_REACH: f64 = 8.0;

/// Finer levels that a picture reads.
#[derive(Debug, Clone, PartialEq)]
pub struct PagedView {
    /// Index of the finest level, whose grid is the index space of the eye pass.
    pub first: usize,
    /// Scene space of that grid.
    pub scene: SceneSpace,
    /// Number of levels that are finer than the volume in memory, from the first on.
    pub level_count: usize,
    /// Number of voxels in memory per voxel of the grid, along x, y and z; at most 1.
    pub coarse: DVec3,
}

/// Returns true if pictures with these settings can read pages: those that gather densities of one field, without cuts
/// by voxel, and composite them. Others show the volume in memory.
pub fn shows_pages(settings: &Settings) -> bool {
    settings.sampling.finer_levels
        && settings.layer_composition() == LayerComposition::First
        && !settings.classification().is_pre()
        && !settings.uses_scattering_engine()
        && settings.shadows.algorithm != ShadowAlgorithm::Direct
        && settings.ray_projection().is_none()
        && !settings.has_sheet_gradients()
        && settings.cuts.shapes_id().is_none()
}

impl PagedView {
    /// Returns the finer levels that a picture of a volume in memory reads: from the coarsest level on whose voxels are
    /// nowhere wider than pixels; `None` if the volume in memory is fine enough.
    pub fn new(
        levels: &FinerLevels,
        settings: &Settings,
        volume: &SceneSpace,
        window: impl Into<PixelWindow>,
    ) -> Option<Self> {
        let frame = picture_frame(settings, volume, window);
        // A hair of slack, so that pixels as wide as voxels do not alternate between two levels.
        let narrowest = frame.pitch_at(frame.first_depth) * (1.0 + 1e-6);
        if levels.is_empty() || !shows_pages(settings) || volume.mean_edge() <= narrowest {
            return None;
        }
        let is_fine_enough = |level: &usize| levels.0[*level].scene(volume).mean_edge() <= narrowest;
        let first = (0..levels.0.len()).rev().find(is_fine_enough).unwrap_or(0);
        Some(Self::from_level(levels, first, volume))
    }

    /// Returns the levels from the one with this index on.
    fn from_level(levels: &FinerLevels, first: usize, volume: &SceneSpace) -> Self {
        Self {
            first,
            scene: levels.0[first].scene(volume),
            level_count: levels.0.len() - first,
            coarse: DVec3::from(levels.0[first].per_voxel.map(|n| 1.0 / n as f64)),
        }
    }

    /// Returns the record of a picture that shows all pages of these levels in view.
    pub fn record(&self, levels: &FinerLevels) -> FinerLevelRecord {
        FinerLevelRecord { finest: levels.0[self.first].key.clone(), is_substituted: false }
    }

    /// Returns the pages that a picture reads, nearest first: those in view, of the levels that the width of pixels asks for,
    /// for which `is_visible` holds.
    pub fn wanted_pages(
        &self,
        levels: &FinerLevels,
        settings: &Settings,
        volume: &SceneSpace,
        window: impl Into<PixelWindow>,
        is_visible: impl Fn(PageAddress) -> bool,
    ) -> Vec<PageAddress> {
        let frame = picture_frame(settings, &self.scene, window);
        let view = ViewPyramid::new(&frame, settings, &self.scene);
        let mut wanted = Vec::new();
        for (relative, level) in levels.0[self.first..].iter().enumerate() {
            let scene = level.scene(volume);
            let index = self.first + relative;
            let [nx, ny, nz] = level.page_dims();
            for at in 0..nx * ny * nz {
                let address = PageAddress { level: index, at: [at % nx, at / nx % ny, at / (nx * ny)] };
                let low = DVec3::from(address.at.map(|c| (c * PAGE_EDGE) as f64)) - PAGE_REACH;
                let high = low + PAGE_EDGE as f64 + 2.0 * PAGE_REACH;
                let corners: [DVec3; 8] = std::array::from_fn(|corner| {
                    let side = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
                    scene.scene_from_index.transform_point3(DVec3::new(side(0), side(1), side(2)))
                });
                let Some((nearest, stretch)) = view.stretch_range(&corners) else { continue };
                let relative = relative as f64;
                if stretch[0] < relative + 1.0 && stretch[1] > relative - 1.0 && is_visible(address) {
                    wanted.push((nearest, address));
                }
            }
        }
        wanted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        wanted.into_iter().map(|(_, address)| address).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::Projection;
    use glam::DAffine3;

    fn levels() -> FinerLevels {
        let fine = [([512; 3], "0".to_owned()), ([256; 3], "1".to_owned())];
        FinerLevels::of_volume([128; 3], fine)
    }

    fn volume() -> SceneSpace {
        SceneSpace::new([128; 3], DAffine3::IDENTITY)
    }

    fn view(size: [u32; 2]) -> Option<PagedView> {
        PagedView::new(&levels(), &Settings::default(), &volume(), size)
    }

    #[test]
    fn the_level_follows_the_width_of_pixels() {
        assert_eq!(view([60, 60]), None, "pixels are wider than voxels in memory");
        let firsts: Vec<usize> =
            (60..600).step_by(5).filter_map(|n| view([n, n])).map(|view| view.first).collect();
        assert!(firsts.is_sorted_by(|a, b| a >= b), "finer pixels, finer levels: {firsts:?}");
        assert!(firsts.contains(&1) && firsts.contains(&0), "{firsts:?}");
        let mut settings = Settings::default();
        settings.shadows.algorithm = ShadowAlgorithm::Direct;
        assert_eq!(PagedView::new(&levels(), &settings, &volume(), [3000, 3000]), None);
    }

    #[test]
    fn pages_in_view_are_wanted_nearest_first() {
        let (levels, volume) = (levels(), volume());
        let size = [500, 500];
        let all = |settings: &Settings| {
            let view = PagedView::new(&levels, settings, &volume, size).unwrap();
            view.wanted_pages(&levels, settings, &volume, size, |_| true)
        };
        let whole = all(&Settings::default());
        assert_eq!(whole.iter().filter(|page| page.level == 0).count(), 512, "all of it is in view");
        let mut close = Settings::default();
        close.camera.distance *= 0.3;
        let part = all(&close);
        assert!(part.len() * 2 < whole.len(), "{} of {}", part.len(), whole.len());
        let distance = |page: &PageAddress| {
            let scene = levels.0[page.level].scene(&volume);
            let middle = DVec3::from(page.at.map(|c| (c * PAGE_EDGE + PAGE_EDGE / 2) as f64));
            let forward = -close.camera.scene_from_view().z_axis;
            (scene.scene_from_index.transform_point3(middle) - close.camera.position()).dot(forward)
        };
        assert!(distance(&part[0]) < distance(&part[part.len() - 1]));
    }

    #[test]
    fn samples_in_view_lie_in_wanted_pages() {
        let (levels, volume) = (levels(), volume());
        for (distance, projection) in [(0.3, Projection::Perspective), (0.5, Projection::Orthographic)] {
            let mut settings = Settings::default();
            settings.camera.distance *= distance;
            settings.camera.projection = projection;
            let size = [400, 300];
            let view = PagedView::new(&levels, &settings, &volume, size).unwrap();
            let wanted = view.wanted_pages(&levels, &settings, &volume, size, |_| true);
            let frame = picture_frame(&settings, &view.scene, size);
            let mut seen = 0;
            for at in 0..400 {
                let (i, j) = (f64::from(at % 20) * 20.9, f64::from(at / 20) * 15.7);
                for k in 0..40 {
                    let depth =
                        frame.first_depth + f64::from(frame.slab_count) * frame.slab * f64::from(k) / 40.0;
                    let p = frame.point(i, j, depth);
                    let dims = levels.0[view.first].dims;
                    if (0..3).any(|axis| p[axis] < 0.0 || p[axis] > dims[axis] as f64 - 1.0) {
                        continue;
                    }
                    let level = frame.stretch_level(depth);
                    for relative in [level.floor(), level.ceil()] {
                        let index = view.first + relative as usize;
                        if index >= levels.0.len() {
                            continue;
                        }
                        let scale = f64::exp2(relative);
                        let at = [0, 1, 2].map(|axis| ((p[axis] + 0.5) / scale / PAGE_EDGE as f64) as usize);
                        assert!(wanted.contains(&PageAddress { level: index, at }), "{p} on level {index}");
                        seen += 1;
                    }
                }
            }
            assert!(seen > 500, "{seen}");
        }
    }
}
