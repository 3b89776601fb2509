//! Pages of finer levels that a picture reads, and the level whose grid is then its index space.

use glam::DVec3;

use crate::plan::{MAX_STRETCH_LEVEL, PixelWindow, SheetFrame, picture_frame};
use chiaroscuro_scene::{FinerLevelRecord, LayerComposition, Projection, Settings, ShadowAlgorithm};
use chiaroscuro_volume::math::SceneSpace;
use chiaroscuro_volume::{Dataset, FinerLevels, LoadError, PAGE_EDGE, PageAddress, PageCache, ResidentPages};

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

/// Pages that a picture wants.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PageDemand {
    /// Index of the finest level of which all pages in view fit.
    pub finest: usize,
    /// True if a finer level is called for, of which only the nearest pages fit.
    pub is_substituted: bool,
    /// Pages to be read, unless they are there: those that show something, or may do so, nearest first, and of a level that
    /// does not fit the nearest ones after the others.
    pub wanted: Vec<PageAddress>,
}

impl PageDemand {
    /// Returns the record of the levels for the metadata of the picture; `levels` are those of the pages.
    pub fn record(&self, levels: &FinerLevels) -> FinerLevelRecord {
        let finest = levels.0.get(self.finest).map_or("in memory", |level| &level.key).to_owned();
        FinerLevelRecord { finest, is_substituted: self.is_substituted }
    }
}

/// Returns the pages that a picture of a dataset wants; `None` if it shows the volume in memory alone.
///
/// The pages of `known` are those that were read, with their ranges. At most as many pages show something as it has room for:
/// of larger views all pages of a coarser level are wanted, and as many of the next finer one as there is room for, nearest
/// first.
pub fn page_demand(
    dataset: &Dataset,
    known: &ResidentPages,
    settings: &Settings,
    window: impl Into<PixelWindow>,
) -> Option<PageDemand> {
    let (levels, window) = (known.levels(), window.into());
    let scene = dataset.volume().scene();
    let view = PagedView::new(levels, settings, &scene, window)?;
    let is_visible = density_visibility(dataset, settings);
    let may_show = |address| known.range_of(address).is_none_or(&is_visible);
    let wanted_from = |level: usize| {
        let view = PagedView::from_level(levels, level, &scene);
        view.wanted_pages(levels, settings, &scene, window, may_show)
    };
    let count_shown =
        |pages: &[PageAddress]| pages.iter().filter(|page| known.range_of(**page).is_some()).count();
    let mut finest = view.first;
    let (mut wanted, mut finer) = (wanted_from(finest), Vec::new());
    while count_shown(&wanted) > known.capacity() {
        finest += 1;
        let coarser = if finest < levels.0.len() { wanted_from(finest) } else { Vec::new() };
        finer = std::mem::replace(&mut wanted, coarser);
    }
    let room = known.capacity().saturating_sub(wanted.len());
    wanted.extend(finer.into_iter().filter(|page| page.level < finest).take(room));
    Some(PageDemand { finest, is_substituted: finest > view.first, wanted })
}

/// Reads the pages that a picture wants into a cache. Returns the demand, which is `None` if the volume in memory is fine enough.
///
/// # Arguments
/// * `progress`: function that is told the number of pages that are missing; reading ends if it returns false.
///
/// # Errors
/// Fails like [`PageCache::fill`].
pub fn fill_pages(
    cache: &mut PageCache,
    dataset: &Dataset,
    settings: &Settings,
    size: [u32; 2],
    progress: impl FnMut(usize) -> bool,
) -> Result<Option<PageDemand>, LoadError> {
    let demand = |cache: &PageCache| page_demand(dataset, cache.resident(), settings, size);
    let wanted = |cache: &PageCache| demand(cache).map_or_else(Vec::new, |demand| demand.wanted);
    cache.fill(wanted, density_visibility(dataset, settings), progress)?;
    Ok(demand(cache))
}

/// Returns a function that says whether any density of a range is visible, or attenuates light.
pub fn density_visibility(
    dataset: &Dataset,
    settings: &Settings,
) -> impl Fn([f32; 2]) -> bool + Send + Sync + use<> {
    let volume = dataset.volume();
    let (range, scene) = (volume.table_range(), volume.scene());
    let tables = [settings.bake_eye(range, &scene), settings.bake_lighting(range, &scene)];
    move |[low, high]: [f32; 2]| tables.iter().any(|table| table.visibility_test()(low, high))
}

/// View pyramid of a picture: the part of the scene that it shows, with the stretch of kernels in it.
struct ViewPyramid<'a> {
    frame: &'a SheetFrame,
    /// Planes at the sides, with normals inwards and their offsets.
    sides: Vec<(DVec3, f64)>,
    eye: DVec3,
    forward: DVec3,
    is_perspective: bool,
}

impl<'a> ViewPyramid<'a> {
    fn new(frame: &'a SheetFrame, settings: &Settings, scene: &SceneSpace) -> Self {
        let [width, height] = frame.size.map(|n| f64::from(n) - 0.5);
        let depths = [frame.first_depth, frame.first_depth + f64::from(frame.slab_count.max(1)) * frame.slab];
        let point =
            |[i, j]: [f64; 2], depth: f64| scene.scene_from_index.transform_point3(frame.point(i, j, depth));
        let corners = [[-0.5, -0.5], [width, -0.5], [width, height], [-0.5, height]];
        let middle = point([0.5 * width, 0.5 * height], depths[1]);
        let sides = (0..4).map(|at| {
            let (a, b) = (corners[at], corners[(at + 1) % 4]);
            let (near, far, next) = (point(a, depths[0]), point(a, depths[1]), point(b, depths[1]));
            let normal = (far - near).cross(next - far).normalize_or_zero();
            let normal = if normal.dot(middle - far) < 0.0 { -normal } else { normal };
            (normal, normal.dot(far))
        });
        let camera = &settings.camera;
        Self {
            sides: sides.collect(),
            eye: camera.position(),
            forward: -camera.scene_from_view().z_axis,
            is_perspective: camera.projection == Projection::Perspective,
            frame,
        }
    }

    /// Returns the distance of the nearest corner of a box and the range of stretch levels in it; `None` if the box lies
    /// outside.
    fn stretch_range(&self, corners: &[DVec3; 8]) -> Option<(f64, [f64; 2])> {
        let is_beyond = |(normal, offset): &(DVec3, f64)| corners.iter().all(|c| normal.dot(*c) < *offset);
        let depths = corners.map(|corner| (corner - self.eye).dot(self.forward));
        let [near, far] = [
            depths.iter().copied().fold(f64::INFINITY, f64::min),
            depths.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ];
        if self.sides.iter().any(is_beyond) || (self.is_perspective && far <= 0.0) {
            return None;
        }
        let level = |distance: f64| {
            let wider =
                if self.is_perspective { self.frame.inverse_distance * distance.max(0.0) } else { 1.0 };
            (self.frame.pitch * wider / self.frame.voxel_edge).max(1e-9).log2().clamp(0.0, MAX_STRETCH_LEVEL)
        };
        Some((near, [level(near), level(far)]))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use chiaroscuro_scene::{ControlPoint, TransferFunction};
    use chiaroscuro_volume::{CellRanges, Page, Samples, Volume};
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

    /// Dataset of 32³ voxels whose densities are visible, with levels of 128³ and 64³ of which all pages were read, and with room
    /// for some.
    fn read_pages(capacity: usize) -> (Dataset, ResidentPages) {
        let samples = Samples::U8((0..32 * 32 * 32).map(|at: usize| (at % 251) as u8).collect());
        let volume = Volume::with_spacing("noise", [32; 3], DVec3::ONE, samples).unwrap();
        let dataset = Dataset::new(volume);
        let fine = [([128; 3], "0".to_owned()), ([64; 3], "1".to_owned())];
        let levels = FinerLevels::of_volume([32; 3], fine);
        let (mapping, bounds) = (dataset.volume().density_mapping(), Arc::clone(dataset.bricks()));
        let mut known = ResidentPages::new(levels.clone(), mapping, bounds, capacity);
        for (level, of_level) in levels.0.iter().enumerate() {
            let [nx, ny, nz] = of_level.page_dims();
            let address = |at: usize| PageAddress { level, at: [at % nx, at / nx % ny, at / (nx * ny)] };
            let page = Page { texels: Vec::new(), range: [0.0, 1.0], cells: CellRanges::default() };
            let page = Arc::new(page);
            known.record((0..nx * ny * nz).map(|at| (address(at), Arc::clone(&page))));
        }
        (dataset, known)
    }

    #[test]
    fn the_nearest_pages_of_a_level_that_does_not_fit_are_wanted_with_all_of_a_coarser_one() {
        let demand = |capacity: usize| {
            let (dataset, known) = read_pages(capacity);
            let points = vec![ControlPoint::new(0.0, [1.0; 3], 0.0), ControlPoint::new(250.0, [1.0; 3], 0.5)];
            let transfer = TransferFunction { points, ..TransferFunction::default() };
            let settings = Settings::default().with_transfer(transfer);
            page_demand(&dataset, &known, &settings, [900, 900]).unwrap()
        };
        let count = |demand: &PageDemand, level: usize| {
            demand.wanted.iter().filter(|page| page.level == level).count()
        };
        let all = demand(100);
        assert_eq!((all.finest, all.is_substituted, count(&all, 0)), (0, false, 8));
        let some = demand(4);
        assert_eq!((some.finest, some.is_substituted), (1, true));
        assert_eq!((count(&some, 1), count(&some, 0)), (1, 3), "{:?}", some.wanted);
        assert_eq!(some.wanted[1..], all.wanted[..3], "the nearest come first");
        let none = demand(0);
        assert_eq!((none.finest, none.is_substituted, none.wanted.len()), (2, true, 0));
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
