//! Antialiasing: coverage of pixels against its closed form, the pass against the reference, and its parts against
//! the whole.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_render::plan::picture_frame;
use chiaroscuro_render::{PictureOptions, RenderOptions, Renderer};
use chiaroscuro_scene::{
    Camera, ControlPoint, CropBox, FloorSettings, ImageSpec, PixelFormat, Projection, QualityPreset,
    RenderEngine, Settings, SlabMode,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use crate::against_reference::mutations::assert_in_shader;
use crate::common::{Dataset, damaged_renderer, new_renderer, render};
use crate::compare::{channels_f32, channels_f64, compare};
use crate::scenes;
use crate::thresholds::{
    COVERAGE_ROUNDING, EDGES_OF_MANY_SAMPLES, EIGHT_BITS, GRAIN_OF_SHIFTED_SLABS, HALF_STEP, SAME_WEIGHTS,
};

/// Size of the pictures: no multiple of a tile.
const SIZE: [u32; 2] = [61, 54];

/// Voxels along each edge of the volumes.
const N: usize = 24;

fn with_rays(rays: u32) -> RenderOptions {
    PictureOptions { rays, ..PictureOptions::default() }.into()
}

/// Solid half space seen along its face, whose edge crosses the picture at an angle: its look, the volume, and the
/// share of each pixel that it covers, where the grid does not end.
fn half_space(degrees: f64) -> (Settings, Dataset, Vec<Option<f64>>) {
    let opaque = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let mut settings = scenes::look();
    settings.camera = Camera { projection: Projection::Orthographic, ..scenes::look().camera };
    // The narrowest step that the table of 1024 entries has, between 0 and 255: a fortieth of a voxel.
    settings.layer_mut().transfer.points =
        vec![opaque(0.0, 0.0), opaque(127.4, 0.0), opaque(127.6, 0.99), opaque(255.0, 0.99)];
    // Voxels near the faces of the grid, where the kernel of a plane is no plane, are cut away.
    settings.cuts.crop = CropBox { on: true, low: [0.2; 3], high: [0.8; 3], ..CropBox::default() };
    let scene = scenes::block(N, |_| true).scene();
    let frame = picture_frame(&settings, &scene, SIZE);
    let (sin, cos) = degrees.to_radians().sin_cos();
    let normal = (frame.origin.per_i * cos + frame.origin.per_j * sin).normalize();
    let middle = DVec3::splat((N - 1) as f64 / 2.0);
    // A plane's B-spline is the plane.
    let value = |p: DVec3| 127.5 + 255.0 * (p - middle).dot(normal) / N as f64;
    let voxel = |at: usize| DVec3::new((at % N) as f64, (at / N % N) as f64, (at / N / N) as f64);
    let values = (0..N * N * N).map(|at| value(voxel(at)) as f32).collect();
    let volume = Volume::with_spacing("half space", [N; 3], DVec3::ONE, Samples::F32(values));
    let covered = |pixel: u32| {
        let (i, j) = (f64::from(pixel % SIZE[0]), f64::from(pixel / SIZE[0]));
        let is_inside = (frame.point(i, j, 0.0) - middle).abs().max_element() < (0.3 * N as f64 - 2.0);
        // Means over 32² places, within 1/64 of the area.
        let place = |k: u32| (f64::from(k) + 0.5) / 32.0 - 0.5;
        let hit = |k: u32| value(frame.point(i + place(k % 32), j + place(k / 32), 0.0)) > 127.5;
        is_inside.then(|| f64::from((0..1024).filter(|&k| hit(k)).count() as u32) / 1024.0)
    };
    let shares = (0..SIZE[0] * SIZE[1]).map(covered).collect();
    (settings, Dataset::new(volume.expect("a valid volume")), shares)
}

/// Errors of coverage at an edge.
struct EdgeErrors {
    largest: f64,
    /// Largest error of pixels that the edge does not cross.
    beside: f64,
    /// Number of different coverages, in steps of rounding.
    levels: usize,
}

fn edge_errors(renderer: &mut Renderer, degrees: f64, rays: u32) -> EdgeErrors {
    let (settings, loaded, shares) = half_space(degrees);
    let found = renderer.render(&loaded, &settings, SIZE, &with_rays(rays)).expect("a picture").linear;
    let mut errors = EdgeErrors { largest: 0.0, beside: 0.0, levels: 0 };
    let mut levels = Vec::new();
    let mut crossed = 0;
    for (texel, share) in found.iter().zip(&shares) {
        let Some(share) = *share else { continue };
        let error = (f64::from(texel[3]) - share).abs();
        errors.largest = errors.largest.max(error);
        if share == 0.0 || share == 1.0 {
            errors.beside = errors.beside.max(error);
        } else {
            crossed += 1;
        }
        levels.push((f64::from(texel[3]) / COVERAGE_ROUNDING).round() as i64);
    }
    assert!(crossed > 8, "the edge crosses the picture: {crossed}");
    levels.sort_unstable();
    levels.dedup();
    errors.levels = levels.len();
    errors
}

#[test]
fn edges_are_one_pixel_wide_ramps_of_what_they_cover() {
    let mut renderer = new_renderer();
    for degrees in [5.0, 33.0, 80.0] {
        let jagged = edge_errors(&mut renderer, degrees, 1);
        assert!(jagged.largest > 0.4 && jagged.levels <= 4, "{degrees}: {}", jagged.largest);
        for rays in [4, 8, 16] {
            let EdgeErrors { largest, beside, levels } = edge_errors(&mut renderer, degrees, rays);
            println!("{degrees}° with {rays} rays: {largest:.3}, beside {beside:.4}, {levels} levels");
            // Projected on the normal of an edge, gaps between places are up to one and a half times those of even
            // places; and a fortieth of a voxel is not hard.
            assert!(largest < 1.5 / f64::from(rays) + 0.02, "{degrees}° {rays}: {largest}");
            assert!(beside < COVERAGE_ROUNDING, "{degrees}° {rays}: wider than a pixel, {beside}");
            // The edge crosses too few pixels for all sixteen.
            assert!(levels >= rays.min(12) as usize, "{degrees}° {rays}: {levels}");
        }
    }
}

#[test]
fn coverage_grows_along_each_row() {
    let mut renderer = new_renderer();
    let (settings, loaded, shares) = half_space(12.0);
    let found = renderer.render(&loaded, &settings, SIZE, &with_rays(8)).expect("a picture").linear;
    let row = |j: usize| j * SIZE[0] as usize..(j + 1) * SIZE[0] as usize;
    for j in 0..SIZE[1] as usize {
        let inside: Vec<f32> =
            row(j).filter(|&pixel| shares[pixel].is_some()).map(|pixel| found[pixel][3]).collect();
        assert!(
            inside.windows(2).all(|pair| f64::from(pair[1]) >= f64::from(pair[0]) - COVERAGE_ROUNDING),
            "{inside:?}"
        );
    }
}

#[test]
fn the_pass_is_that_of_the_reference_and_damage_is_noticed() {
    let loaded = Dataset::new(scenes::creature(30, DVec3::new(1.0, 0.8, 1.6)));
    let differs = |settings: &Settings, from: &str, to: &str| {
        let mut renderer = damaged_renderer(from, to);
        let rounding: fn(f32) -> f32 = |value| half::f16::from_f32(value).to_f32();
        let options = ReferenceOptions { rounding: Some(rounding), ..ReferenceOptions::default() };
        let reference = Reference::new(loaded.volume(), settings, options);
        let expected = reference.antialiased_picture(SIZE, &reference.attenuations(), 4);
        let found = renderer.render(&loaded, settings, SIZE, &with_rays(4)).expect("a picture");
        let result = compare("picture", &channels_f32(&found.linear), &channels_f64(&expected), SAME_WEIGHTS);
        result.err()
    };
    let mut even = scenes::look();
    // Thick slabs, so that their phases show.
    (even.sampling.slabs, even.sampling.slab) = (SlabMode::Even, 2.0);
    let mut orthographic = scenes::look();
    orthographic.camera.projection = Projection::Orthographic;
    for settings in [&scenes::look(), &orthographic, &even] {
        assert_eq!(differs(settings, "\u{0}", ""), None);
    }
    for (shader, from, to) in [
        // Rays that all go through the middle.
        ("eye/eye_pass.wgsl", "vec2f(pixel) + pixel_ray.place.xy", "vec2f(pixel)"),
        // Slabs that all begin at one depth.
        ("eye/eye_pass.wgsl", "first_depth += pixel_ray.place.z", "first_depth += 0.0"),
        // A weight that is not that of the rays.
        ("eye/eye_pass.wgsl", "textureLoad(earlier, pixel, 0)", "0.95 * textureLoad(earlier, pixel, 0)"),
        // Edges that are not found.
        ("eye/edges.wgsl", "|| is_edge(at, vec2i(0, 1))", ""),
        // Pixels beside those with edges.
        (
            "eye/eye_pass.wgsl",
            "vec2u(packed & 0xffffu, packed >> 16u)",
            "vec2u(packed >> 16u, packed & 0xffffu)",
        ),
    ] {
        assert_in_shader(shader, from);
        assert!(differs(&even, from, to).is_some(), "the comparison does not notice {to:?}");
    }
}

/// Root mean square of the difference of display values, where the pictures differ from the background.
fn display_rms(a: &[u8], b: &[u8]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
    (squares / a.len() as f64).sqrt()
}

#[test]
fn edges_are_those_of_many_samples() {
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut with_floor = scenes::look();
    with_floor.floor = FloorSettings { on: true, height: -0.9, ..FloorSettings::default() };
    for settings in [scenes::look(), with_floor] {
        let mut shown = |rays, samples| {
            let options = RenderOptions::from(PictureOptions { rays, samples, ..PictureOptions::default() });
            renderer.render_display(&loaded, &settings, SIZE, &options).expect("a picture")
        };
        let many = shown(1, 4);
        let [one, four, sixteen] = [1, 4, 16].map(|rays| display_rms(&shown(rays, 1), &many));
        println!("one ray {one:.2}, four {four:.2}, sixteen {sixteen:.2} of 255");
        assert!(four < EDGES_OF_MANY_SAMPLES[0] * one, "{one} {four}");
        assert!(sixteen < EDGES_OF_MANY_SAMPLES[1] * one, "{one} {sixteen}");
    }
}

/// Grain of a plate that is seen obliquely: standard deviation of its light around a plane through it, relative.
fn plate_grain(renderer: &mut Renderer, settings: &Settings, rays: u32) -> f64 {
    let volume = scenes::block(48, |[x, y, z]| {
        let edge = 4..44;
        edge.contains(&x) && edge.contains(&y) && (20..28).contains(&z)
    });
    let loaded = Dataset::new(volume);
    let found = renderer.render(&loaded, settings, [96; 2], &with_rays(rays)).expect("a picture").linear;
    let inner = (40..56).flat_map(|j| (36..60).map(move |i| (i, j)));
    let light: Vec<f64> = inner.map(|(i, j)| f64::from(found[i + 96 * j][1])).collect();
    let mean = light.iter().sum::<f64>() / light.len() as f64;
    // Lamps are far, and the eye sees all of the plate under about one angle: what varies is grain.
    (light.iter().map(|l| (l / mean - 1.0).powi(2)).sum::<f64>() / light.len() as f64).sqrt()
}

#[test]
fn shifted_slabs_leave_less_grain() {
    let mut renderer = new_renderer();
    let mut settings = scenes::look();
    QualityPreset::Fast.apply(&mut settings);
    (settings.sampling.slabs, settings.sampling.slab) = (SlabMode::Even, 2.0);
    settings.camera = Camera {
        projection: Projection::Orthographic,
        azimuth_deg: 20.0,
        elevation_deg: 50.0,
        distance: 2.5,
        ..Camera::default()
    };
    settings.layer_mut().transfer = scenes::linear_extinction(4.0);
    let [one, four, more] = [1, 4, 16].map(|rays| plate_grain(&mut renderer, &settings, rays));
    println!("grain {one:.4} with one ray, {four:.4} with four, {more:.4} with sixteen");
    assert!(one > 0.005, "there is grain to lose: {one}");
    assert!(more < GRAIN_OF_SHIFTED_SLABS * one, "{one} {more}");
    let mut alike = damaged_renderer("first_depth += pixel_ray.place.z", "first_depth += 0.0");
    let alike = plate_grain(&mut alike, &settings, 16);
    println!("grain {alike:.4} with slabs at one depth");
    assert!(alike > GRAIN_OF_SHIFTED_SLABS * one, "slabs at one depth are noticed: {alike}");
}

#[test]
fn parts_are_the_whole_antialiased_picture() {
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut settings = scenes::look();
    settings.floor = FloorSettings { on: true, height: -0.9, ..FloorSettings::default() };
    for depth in [PixelFormat::Eight, PixelFormat::Sixteen] {
        let image_spec = ImageSpec { depth, ..ImageSpec::new(SIZE) };
        let mut picture = |settings: &Settings, edge, samples| {
            let mut bands = renderer.bands_with_limits(&loaded, settings, &image_spec, edge, samples);
            bands.all().expect("a picture").values()
        };
        let whole = picture(&settings, 4096, 1 << 20);
        let largest = |found: &[f32]| {
            whole.iter().zip(found).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max)
        };
        for (edge, samples) in [(4096, 61 * 16), (24, 1 << 20), (17, 17 * 9)] {
            let apart = largest(&picture(&settings, edge, samples));
            println!("{depth:?} {edge}: {apart:.2e}");
            // A pixel at the threshold of bending may be drawn either way, which no display shows.
            let limit = if depth == PixelFormat::Eight { EIGHT_BITS } else { HALF_STEP };
            assert!(apart <= limit, "{depth:?} {edge} {samples}: {apart}");
        }
        let mut jagged = settings.clone();
        jagged.output.antialiasing = 1;
        assert!(largest(&picture(&jagged, 4096, 1 << 20)) > 4.0 * EIGHT_BITS, "edges are drawn");
    }
}

#[test]
fn one_ray_is_the_picture_as_it_was_and_more_rays_reuse_it() {
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut settings = scenes::look();
    let one = render(&mut renderer, &loaded, &settings, SIZE);
    let fills = renderer.light_rebuilds().to_vec();
    let four = renderer.render(&loaded, &settings, SIZE, &with_rays(4)).expect("a picture");
    let counts = renderer.report().step_counts;
    assert_eq!((counts.eye, counts.display), (0, 1), "the first rays are not cast again");
    assert!(counts.antialiasing > 0 && one.linear != four.linear);
    assert_eq!(renderer.light_rebuilds(), fills, "light is shared");
    // A change of the display redraws neither, and one ray is still the same picture.
    settings.output.exposure = 1.5;
    renderer.render(&loaded, &settings, SIZE, &with_rays(4)).expect("a picture");
    let counts = renderer.report().step_counts;
    assert_eq!((counts.eye, counts.antialiasing, counts.display), (0, 0, 1));
    settings.output.exposure = 1.0;
    assert_eq!(render(&mut renderer, &loaded, &settings, SIZE), one);
    let mut fresh = new_renderer();
    let again = fresh.render(&loaded, &settings, SIZE, &with_rays(4)).expect("a picture");
    assert_eq!(again, four, "the same bytes, whatever was drawn before");
    // Other numbers are served by the nearest, and the scattering engine by one ray.
    let five = fresh.render(&loaded, &settings, SIZE, &with_rays(5)).expect("a picture");
    assert_eq!(five, four);
    settings.sampling.engine = RenderEngine::Scatter;
    let scattered = render(&mut fresh, &loaded, &settings, SIZE);
    let more = fresh.render(&loaded, &settings, SIZE, &with_rays(4)).expect("a picture");
    assert_eq!(scattered, more);
}
