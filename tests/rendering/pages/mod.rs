//! Pages of finer levels: a picture that reads them equals the one of the fine volume in memory.

use std::ops::Range;
use std::sync::Arc;

use chiaroscuro_media::PixelRows;
use chiaroscuro_render::plan::{PagedView, density_visibility};
use chiaroscuro_render::{BandError, PartPages, RenderedPicture, Renderer};
use chiaroscuro_scene::{
    ImageSpec, OpacityLength, PixelFormat, Projection, QualityPreset, ReconstructionKernel, Settings,
    ShadowAlgorithm, ShadowSettings,
};
use chiaroscuro_volume::{
    FinerLevels, LoadError, Page, PageAddress, PageCache, PageSource, PoolLayout, ResidentPages, Volume,
};
use glam::DVec3;

use crate::common::{Dataset, damaged_renderer, full_precision_renderer, new_renderer, render};
use crate::compare::{ErrorLimit, compare};
use crate::scenes;
use crate::thresholds::pages::{PAGED_LIGHT, PAGED_MATTER, PAGED_STRETCHED};

/// Volumes in memory that stand for the levels of a file.
#[derive(Debug)]
struct VolumeLevels {
    levels: FinerLevels,
    volumes: Vec<Volume>,
}

impl PageSource for VolumeLevels {
    fn levels(&self) -> &FinerLevels {
        &self.levels
    }

    fn read(&self, level: usize, region: &[Range<usize>; 3]) -> Result<Vec<f32>, LoadError> {
        let volume = &self.volumes[level];
        let [xs, ys, zs] = region.clone();
        let width = volume.dims()[0];
        Ok(zs
            .flat_map(|z| {
                let slice = volume.slice_densities(z);
                let rows = ys.clone().map(|y| slice[width * y..][xs.clone()].to_vec());
                rows.flatten().collect::<Vec<_>>()
            })
            .collect())
    }
}

/// Fine volume, the dataset of its means over blocks of `block`³ voxels, and a source of the levels between.
fn levels(fine: &Volume, block: usize) -> (Dataset, VolumeLevels) {
    let level = |edge: usize| {
        let averaged = fine.clone().block_averaged([edge; 3]).expect("means");
        averaged.with_ranges(fine.ranges()).with_density_mapping(fine.density_mapping())
    };
    let coarse = Dataset::new(level(block));
    let edges = std::iter::successors(Some(1), |edge| Some(2 * edge)).take_while(|edge| *edge < block);
    let volumes: Vec<Volume> = edges.map(level).collect();
    let offers = volumes.iter().enumerate().map(|(at, volume)| (volume.dims(), at.to_string()));
    let levels = FinerLevels::of_volume(coarse.volume().dims(), offers);
    (coarse, VolumeLevels { levels, volumes })
}

/// Dataset with the pages that a picture wants, read in an order.
fn with_pages(
    coarse: &Dataset,
    source: &VolumeLevels,
    settings: &Settings,
    size: [u32; 2],
    order: impl Fn(&mut Vec<PageAddress>),
) -> Dataset {
    let scene = coarse.volume().scene();
    let view = PagedView::new(&source.levels, settings, &scene, size).expect("pixels are finer than voxels");
    let mut wanted = view.wanted_pages(&source.levels, settings, &scene, size, |_| true);
    order(&mut wanted);
    let mut pages = ResidentPages::new(
        source.levels.clone(),
        coarse.volume().density_mapping(),
        Arc::clone(coarse.bricks()),
        usize::MAX,
    );
    pages.insert(
        wanted.into_iter().map(|address| {
            (address, Arc::new(Page::from_source(source, address, |_| true).expect("a page")))
        }),
    );
    coarse.clone().with_pages(Some(Arc::new(pages)))
}

fn look() -> Settings {
    let mut settings = scenes::look().with_opacity_unit(OpacityLength::Extent(1.0 / 128.0));
    settings.sky.intensity = 0.0;
    settings.camera.distance = 3.0;
    settings
}

/// Look without light from volumes, which are those of the coarse level.
fn unlit() -> Settings {
    let shadows = ShadowSettings { algorithm: ShadowAlgorithm::Off, ..look().shadows };
    Settings { shadows, ..look() }
}

const SIZE: [u32; 2] = [260, 200];

/// Compares pictures as they are displayed, before they are rounded to bytes.
fn check(
    what: &str,
    paged: &RenderedPicture,
    wanted: &RenderedPicture,
    limit: ErrorLimit,
) -> Result<(), String> {
    let brightest = wanted.linear.iter().map(|texel| texel[0]).fold(0.0, f32::max);
    assert!(brightest > 0.1, "{what} shows something");
    let values = |picture: &RenderedPicture| -> Vec<f64> {
        let shown = |light: &f32| chiaroscuro_scene::srgb_from_linear(f64::from(*light));
        picture.linear.iter().flatten().map(shown).collect()
    };
    compare(what, &values(paged), &values(wanted), limit).map(drop)
}

#[test]
fn a_picture_through_pages_is_that_of_the_fine_volume() {
    let fine = scenes::creature(128, DVec3::ONE);
    let whole = Dataset::new(fine.clone());
    let (coarse, source) = levels(&fine, 2);
    for quality in [QualityPreset::Fast, QualityPreset::Standard, QualityPreset::Fine] {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let mut settings = unlit();
            quality.apply(&mut settings);
            settings.sampling.kernel = ReconstructionKernel::Prefiltered;
            settings.camera.projection = projection;
            // In 32 bits: pages are more precise than the pyramid of a volume.
            let wanted = render(&mut full_precision_renderer(), &whole, &settings, SIZE);
            let alone = render(&mut new_renderer(), &coarse, &settings, SIZE);
            let dataset = with_pages(&coarse, &source, &settings, SIZE, |_| ());
            let paged = render(&mut new_renderer(), &dataset, &settings, SIZE);
            let what = format!("{quality:?}, {projection:?}");
            check(&what, &paged, &wanted, PAGED_MATTER).unwrap();
            assert!(check(&what, &alone, &wanted, PAGED_MATTER).is_err(), "{what}: pages change nothing");
        }
    }
}

/// Pages of two levels, at distances where both are read and mixed.
#[test]
fn stretched_kernels_read_pages_of_coarser_levels() {
    let fine = scenes::creature(128, DVec3::ONE);
    let whole = Dataset::new(fine.clone());
    let (coarse, source) = levels(&fine, 4);
    let mut settings = unlit();
    settings.sampling.kernel = ReconstructionKernel::Prefiltered;
    // Near the object, and at a wide angle, so that its far side is half as large as its near side.
    settings.camera.distance = 1.6;
    settings.camera.fov_y_deg = 75.0;
    let size = [150, 120];
    let wanted = render(&mut full_precision_renderer(), &whole, &settings, size);
    let dataset = with_pages(&coarse, &source, &settings, size, |_| ());
    let used: std::collections::BTreeSet<_> =
        dataset.pages().expect("pages").pages().keys().map(|page| page.level).collect();
    assert_eq!(used.into_iter().collect::<Vec<_>>(), [0, 1]);
    let paged = render(&mut new_renderer(), &dataset, &settings, size);
    check("two levels", &paged, &wanted, PAGED_STRETCHED).unwrap();
}

#[test]
fn the_order_of_arrival_changes_nothing() {
    let fine = scenes::creature(128, DVec3::ONE);
    let (coarse, source) = levels(&fine, 2);
    let settings = look();
    let pictures = (0..20_u64).map(|seed| {
        let shuffle = |pages: &mut Vec<PageAddress>| {
            let mut state = seed;
            pages.sort_by_cached_key(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(seed + 1);
                state >> 33
            });
        };
        let dataset = with_pages(&coarse, &source, &settings, [100, 80], shuffle);
        render(&mut new_renderer(), &dataset, &settings, [100, 80]).display
    });
    let pictures: std::collections::BTreeSet<_> = pictures.collect();
    assert_eq!(pictures.len(), 1);
}

/// Pages that come and go, in one renderer, as when a camera moves.
#[test]
fn a_renderer_that_had_other_pages_draws_the_same() {
    let fine = scenes::creature(128, DVec3::ONE);
    let (coarse, source) = levels(&fine, 2);
    let mut renderer = new_renderer();
    for azimuth_deg in [20.0, 110.0, 200.0, 20.0] {
        let mut settings = look();
        settings.camera.azimuth_deg = azimuth_deg;
        settings.camera.distance = 1.5;
        let dataset = with_pages(&coarse, &source, &settings, SIZE, |_| ());
        let fresh = render(&mut new_renderer(), &dataset, &settings, SIZE);
        assert!(render(&mut renderer, &dataset, &settings, SIZE) == fresh, "{azimuth_deg}");
        let alone = render(&mut new_renderer(), &coarse, &settings, SIZE);
        assert!(render(&mut renderer, &coarse, &settings, SIZE) == alone && alone != fresh);
    }
}

/// A picture in parts whose pages fit into memory one after another: the same bytes as with all pages at hand.
#[test]
fn parts_that_read_their_own_pages_make_the_same_picture() {
    let fine = scenes::creature(256, DVec3::ONE);
    let (coarse, source) = levels(&fine, 4);
    let mut settings = look();
    QualityPreset::Standard.apply(&mut settings);
    settings.camera.distance = 1.6;
    let size = [360, 280];
    let spec = ImageSpec { depth: PixelFormat::Linear, ..ImageSpec::new(size) };
    let view = PagedView::new(&source.levels, &settings, &coarse.volume().scene(), size);
    assert_eq!(view.map(|view| view.first), Some(0));
    let dataset = with_pages(&coarse, &source, &settings, size, |_| ());
    let is_visible = density_visibility(&coarse, &settings);
    let pages = dataset.pages().expect("pages");
    let count = pages.ranges().values().filter(|range| Page::has_texels(**range, &is_visible)).count();
    assert!(count < pages.ranges().len(), "some pages show nothing");
    let drawn = |renderer: &mut Renderer, dataset: &Dataset, pages: Option<PartPages<'_>>| {
        renderer.bands(dataset, &settings, &spec).with_pages(pages).all()
    };
    let source: Arc<dyn PageSource> = Arc::new(source);
    let cache = |capacity: usize| {
        let mapping = coarse.volume().density_mapping();
        PageCache::new(
            Arc::clone(&source),
            mapping,
            Arc::clone(coarse.bricks()),
            PoolLayout::for_pages(capacity, 2048).bytes(),
        )
    };
    let distance = |a: &PixelRows, b: &PixelRows| match (a, b) {
        (PixelRows::Floats(a), PixelRows::Floats(b)) => {
            a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
        }
        _ => f32::INFINITY,
    };
    let whole =
        drawn(&mut new_renderer(), &coarse, Some(PartPages::new(&mut cache(count), |_| true))).unwrap();
    let capacity = cache(27).resident().capacity();
    assert!(capacity < count, "{count} pages fit at once");
    let parts = drawn(&mut new_renderer(), &coarse, Some(PartPages::new(&mut cache(27), |_| true))).unwrap();
    assert!(parts == whole, "{capacity} of {count} pages at once: {}", distance(&parts, &whole));
    // Pages that show nothing have no texels, and no influence beyond the interpolation between levels.
    let all = drawn(&mut new_renderer(), &dataset, None).unwrap();
    let apart = distance(&all, &whole);
    assert!(apart < 1.0 / 255.0, "{apart}");
    let alone = drawn(&mut new_renderer(), &coarse, None).unwrap();
    assert!(alone != whole, "pages change nothing");
    let refused = drawn(&mut new_renderer(), &coarse, Some(PartPages::new(&mut cache(1), |_| true)));
    assert!(matches!(refused, Err(BandError::PoolTooSmall { .. })), "{refused:?}");
    // Parts are halved in pixels, however many samples each has.
    let many = ImageSpec { samples: 16, ..ImageSpec::new([40, 30]) };
    let mut cache_of_one = cache(1);
    let mut renderer = new_renderer();
    let bands = renderer.bands(&coarse, &settings, &many);
    let refused = bands.with_pages(Some(PartPages::new(&mut cache_of_one, |_| true))).all();
    assert!(matches!(refused, Err(BandError::PoolTooSmall { .. })), "{refused:?}");
    let cancelled = drawn(&mut new_renderer(), &coarse, Some(PartPages::new(&mut cache(27), |_| false)));
    assert!(matches!(cancelled, Err(BandError::Pages(LoadError::Cancelled))), "{cancelled:?}");
}

/// Fine voxels in cells that the means of the coarse level show as empty are found by their bounds.
#[test]
fn no_skipped_cell_hides_fine_matter() {
    let edge = 96;
    let values = (0..edge * edge * edge)
        .map(|at: usize| {
            let [x, y, z] = [at % edge, at / edge % edge, at / (edge * edge)];
            // Single voxels, whose mean over blocks of 4³ is below what the curve shows.
            if [x, y, z].iter().all(|c| c % 17 == 8) { 255 } else { 0 }
        })
        .collect();
    let samples = chiaroscuro_volume::Samples::U8(values);
    let fine = Volume::with_spacing("dots", [edge; 3], DVec3::ONE, samples).expect("a volume");
    let whole = Dataset::new(fine.clone());
    let (coarse, source) = levels(&fine, 4);
    let mut settings = unlit();
    settings.sampling.kernel = ReconstructionKernel::Prefiltered;
    settings.shading.ambient = 1.0;
    settings.camera.distance = 2.0;
    let size = [500, 400];
    let view = PagedView::new(&source.levels, &settings, &coarse.volume().scene(), size);
    assert_eq!(view.map(|view| view.first), Some(0));
    let wanted = render(&mut full_precision_renderer(), &whole, &settings, size);
    let dataset = with_pages(&coarse, &source, &settings, size, |_| ());
    let paged = render(&mut new_renderer(), &dataset, &settings, size);
    check("dots", &paged, &wanted, PAGED_MATTER).unwrap();
    assert!(
        check("dots", &render(&mut new_renderer(), &coarse, &settings, size), &wanted, PAGED_MATTER).is_err()
    );
}

/// Shadows are those of the coarse volume, with a near field of the fine one.
#[test]
fn shadows_are_near_those_of_the_fine_volume() {
    let fine = scenes::creature(128, DVec3::ONE);
    let whole = Dataset::new(fine.clone());
    let (coarse, source) = levels(&fine, 2);
    let mut settings = look();
    QualityPreset::Standard.apply(&mut settings);
    let wanted = render(&mut new_renderer(), &whole, &settings, SIZE);
    let alone = render(&mut new_renderer(), &coarse, &settings, SIZE);
    let dataset = with_pages(&coarse, &source, &settings, SIZE, |_| ());
    let paged = render(&mut new_renderer(), &dataset, &settings, SIZE);
    check("shadows", &paged, &wanted, PAGED_LIGHT).unwrap();
    assert!(check("shadows without pages", &alone, &wanted, PAGED_LIGHT).is_err());
}

#[test]
fn a_wrong_slot_or_border_is_noticed() {
    let fine = scenes::creature(128, DVec3::ONE);
    let (coarse, source) = levels(&fine, 2);
    let settings = unlit();
    let dataset = with_pages(&coarse, &source, &settings, SIZE, |_| ());
    let right = render(&mut new_renderer(), &dataset, &settings, SIZE);
    for (from, to) in [
        ("const PAGE_BORDER = 3.0;", "const PAGE_BORDER = 2.0;"),
        ("entry >> 8u & 0xffu", "entry >> 9u & 0xffu"),
        ("return (p + 0.5) * pages.coarse - 0.5;", "return p * pages.coarse - 40.0;"),
    ] {
        let wrong = render(&mut damaged_renderer(from, to), &dataset, &settings, SIZE);
        assert!(check(from, &wrong, &right, PAGED_MATTER).is_err(), "{from}");
    }
}
