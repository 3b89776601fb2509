//! Pages that a picture wants, and reading of them.

use super::PagedView;
use crate::plan::PixelWindow;
use chiaroscuro_scene::{FinerLevelRecord, Settings};
use chiaroscuro_volume::{Dataset, FinerLevels, LoadError, Page, PageAddress, PageCache, ResidentPages};

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
    let may_show =
        |address| known.ranges().get(&address).is_none_or(|range| Page::has_texels(*range, &is_visible));
    let wanted_from = |level: usize| {
        let view = PagedView::from_level(levels, level, &scene);
        view.wanted_pages(levels, settings, &scene, window, may_show)
    };
    let count_shown =
        |pages: &[PageAddress]| pages.iter().filter(|page| known.ranges().contains_key(page)).count();
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
    let wanted = |cache: &PageCache| Some(demand(cache).map_or_else(Vec::new, |demand| demand.wanted));
    cache.fill(wanted, density_visibility(dataset, settings), progress)?;
    Ok(demand(cache))
}

/// Reads the pages that a part of a picture wants, on the finest level that its pixels call for. Returns false as soon as more
/// of them show something than the cache has room for.
///
/// # Arguments
/// * `dataset`: volume with the mapping of densities that the cache has.
/// * `progress`: function that is told the number of pages that are missing; reading ends if it returns false.
///
/// # Errors
/// Fails like [`PageCache::fill`].
pub fn fill_part(
    cache: &mut PageCache,
    dataset: &Dataset,
    settings: &Settings,
    part: PixelWindow,
    progress: impl FnMut(usize) -> bool,
) -> Result<bool, LoadError> {
    let wanted = |cache: &PageCache| {
        let demand = page_demand(dataset, cache.resident(), settings, part);
        match demand {
            Some(demand) if demand.is_substituted => None,
            demand => Some(demand.map_or_else(Vec::new, |demand| demand.wanted)),
        }
    };
    cache.fill(wanted, density_visibility(dataset, settings), progress)
}

/// Returns a function that says whether any density of a range is visible, or attenuates light.
pub fn density_visibility(
    dataset: &Dataset,
    settings: &Settings,
) -> impl Fn([f32; 2]) -> bool + Send + Sync + use<> {
    let volume = dataset.volume();
    let (range, scene) = (volume.table_range(), volume.scene());
    let tables = [settings.bake_eye(range, &scene), settings.bake_lighting(range, &scene)];
    let tests = tables.map(|table| table.visibility_test());
    move |[low, high]: [f32; 2]| tests.iter().any(|is_visible| is_visible(low, high))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use chiaroscuro_scene::{ControlPoint, TransferFunction};
    use chiaroscuro_volume::{CellRanges, Samples, Volume};
    use glam::DVec3;

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
            known.insert((0..nx * ny * nz).map(|at| (address(at), Arc::clone(&page))));
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
}
