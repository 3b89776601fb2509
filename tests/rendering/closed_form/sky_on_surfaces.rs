//! Sky light on opaque bodies, in pictures: open surfaces are white under a white sky wherever they lie, and hollows
//! as dark as in closed form.

use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{
    ControlPoint, DensityRange, LightVolumeResolution, OpacityLength, SceneAxis, Settings, SkyMode,
    SkySettings, SlabMode, TransferFunction,
};
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::DVec3;

use crate::common::{damaged_renderer, new_renderer, render};
use crate::scenes::{self, axis_camera};
use crate::thresholds::{
    BOX_UNDER_SKY, CONVEX_BODY_UNDER_SKY, GROOVE_UNDER_SKY, OPEN_PLATE_UNDER_SKY, SKY_AT_HALF_OF_FULL,
    WELL_UNDER_SKY, WELLS_UNDER_SKY,
};

/// Edge of pictures, in pixels: so many that a pixel is smaller than a voxel.
const SIZE: usize = 220;

const RESOLUTIONS: [LightVolumeResolution; 2] = [LightVolumeResolution::Half, LightVolumeResolution::Full];

/// Body with its voxels, seen from a direction.
struct Scene<'a> {
    dims: [usize; 3],
    /// Signed distance to the surface in voxels, positive inside.
    depth: &'a dyn Fn(DVec3) -> f64,
    /// Azimuth and elevation of the camera.
    view: [f64; 2],
}

/// White material whose opacity rises within a tenth of the range of densities, or over half of it.
fn opacity_curves() -> [(&'static str, TransferFunction); 2] {
    let curve = |points: &[(f64, f64)]| TransferFunction {
        points: points.iter().map(|&(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity)).collect(),
        ..TransferFunction::default()
    };
    [
        ("hard", curve(&[(115.0, 0.0), (140.0, 0.99)])),
        ("soft", curve(&[(80.0, 0.0), (130.0, 0.6), (200.0, 0.95)])),
    ]
}

/// Brightness of a body's picture under a white sky of 1; NaN where it is not opaque.
fn brightness(
    renderer: &mut Renderer,
    scene: &Scene<'_>,
    resolution: LightVolumeResolution,
    curve: &TransferFunction,
) -> Vec<f64> {
    let [nx, ny, nz] = scene.dims;
    let place = |at: usize| DVec3::new((at % nx) as f64, (at / nx % ny) as f64, (at / (nx * ny)) as f64);
    let value = |at: usize| (255.0 * ((scene.depth)(place(at)) + 0.5).clamp(0.0, 1.0)).round() as u8;
    let values: Vec<u8> = (0..nx * ny * nz).map(value).collect();
    let volume = Volume::with_spacing("body", scene.dims, DVec3::ONE, Samples::U8(values)).expect("a volume");
    let sky = SkySettings { mode: SkyMode::White, intensity: 1.0, resolution, ..SkySettings::default() };
    let mut settings = Settings { sky, lights: Vec::new(), ..scenes::look() }
        .with_transfer(curve.clone())
        .with_opacity_unit(OpacityLength::Voxels(1.0))
        .with_range(DensityRange::Full);
    settings.camera = axis_camera(scene.view[0], scene.view[1]);
    settings.camera.up = SceneAxis::PlusZ;
    settings.shading.ambient = 0.0;
    settings.shading.diffuse = 1.0;
    settings.shading.specular = 0.0;
    // As by default in the program: with even slabs, samples lie up to half a voxel inside the material.
    settings.sampling.slabs = SlabMode::ByNeed;
    let picture = render(renderer, &Dataset::new(volume), &settings, [SIZE as u32; 2]);
    let of = |texel: &[f32; 4]| if texel[3] > 0.99 { f64::from(texel[1] / texel[3]) } else { f64::NAN };
    picture.linear.iter().map(of).collect()
}

/// Mean, standard deviation, minimum and maximum of the opaque pixels in the middle `share` of a picture.
fn statistics(picture: &[f64], share: f64) -> [f64; 4] {
    let is_inside = |at: usize| (at as f64 + 0.5 - SIZE as f64 / 2.0).abs() <= share * SIZE as f64 / 2.0;
    let pixels: Vec<f64> = (0..SIZE * SIZE)
        .filter(|at| is_inside(at % SIZE) && is_inside(at / SIZE))
        .map(|at| picture[at])
        .filter(|value| !value.is_nan())
        .collect();
    assert!(pixels.len() > 20, "only {} pixels are opaque", pixels.len());
    let mean = pixels.iter().sum::<f64>() / pixels.len() as f64;
    let variance = pixels.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / pixels.len() as f64;
    let least = pixels.iter().copied().fold(f64::MAX, f64::min);
    [mean, variance.sqrt(), least, pixels.iter().copied().fold(f64::MIN, f64::max)]
}

/// Calls a check with pictures of a scene, for both curves and resolutions.
fn for_all_looks(what: &str, scene: &Scene<'_>, mut check: impl FnMut(&str, &[f64])) {
    let mut renderer = new_renderer();
    for (name, curve) in opacity_curves() {
        for resolution in RESOLUTIONS {
            let picture = brightness(&mut renderer, scene, resolution, &curve);
            check(&format!("{what}, {name}, {resolution:?}"), &picture);
        }
    }
}

fn plate(height: f64, tilt_deg: f64) -> impl Fn(DVec3) -> f64 {
    let (sin, cos) = tilt_deg.to_radians().sin_cos();
    move |p: DVec3| (height - p.z) * cos + (p.x - 23.5) * sin
}

#[test]
fn open_plates_are_white_wherever_they_lie() {
    let places = [
        (16.0, 0.0),
        (16.25, 0.0),
        (16.5, 0.0),
        (17.0, 0.0),
        (17.5, 0.0),
        (18.25, 4.3),
        (28.0, 20.0),
        (34.0, 45.0),
    ];
    for (height, tilt) in places {
        let scene = Scene { dims: [48, 48, 64], depth: &plate(height, tilt), view: [0.0, 90.0] };
        for_all_looks(&format!("plate at {height}, {tilt}°"), &scene, |what, picture| {
            let [mean, ..] = statistics(picture, 0.3);
            println!("{what}: {mean:.4}");
            assert!((mean - 1.0).abs() <= OPEN_PLATE_UNDER_SKY, "{what}: {mean}");
        });
    }
}

#[test]
fn convex_balls_are_evenly_white() {
    for (edge, radius) in [(64, 24.0), (48, 15.3)] {
        let middle = DVec3::splat((f64::from(edge) - 1.0) / 2.0);
        let depth = |p: DVec3| radius - p.distance(middle);
        let scene = Scene { dims: [edge as usize; 3], depth: &depth, view: [-55.0, 24.0] };
        for_all_looks(&format!("ball of radius {radius}"), &scene, |what, picture| {
            let [mean, deviation, least, most] = statistics(picture, 1.0);
            println!("{what}: {mean:.4} ± {deviation:.4}, {least:.4} … {most:.4}");
            assert!((mean - 1.0).abs() <= CONVEX_BODY_UNDER_SKY, "{what}: {mean}");
            assert!(deviation <= CONVEX_BODY_UNDER_SKY, "{what}: deviation {deviation}");
        });
    }
}

#[test]
fn faces_and_edges_of_a_box_are_white() {
    let depth = |p: DVec3| 14.0 - (p - 23.5).abs().max_element();
    let scene = Scene { dims: [48; 3], depth: &depth, view: [-35.0, 30.0] };
    for_all_looks("box", &scene, |what, picture| {
        let [mean, _, least, most] = statistics(picture, 1.0);
        println!("{what}: {mean:.4}, {least:.4} … {most:.4}");
        assert!(least >= 1.0 - BOX_UNDER_SKY && most <= 1.0 + BOX_UNDER_SKY, "{what}: {least} … {most}");
    });
}

/// Light on a side of a long right-angled groove, x across from its bottom, under a sky that its other side hides
/// below the rim at the height h: E/π = ½ (1 + x / √(x² + h²)).
fn groove_light(x: f64, height: f64) -> f64 {
    0.5 * (1.0 + x / (x * x + height * height).sqrt())
}

#[test]
fn a_groove_darkens_towards_its_bottom() {
    const DEPTH: f64 = 16.0;
    // Closed by the ends of the grid at 72 voxels to either side, which few directions reach.
    let depth = |p: DVec3| (26.0 - p.z).min(((p.x - 31.5).abs() + 26.0 - DEPTH - p.z) / 2f64.sqrt());
    let scene = Scene { dims: [64, 144, 32], depth: &depth, view: [0.0, 90.0] };
    for_all_looks("groove", &scene, |what, picture| {
        let middle = SIZE / 2;
        // From above with x down or to the right, the groove is where the picture is darker in one direction.
        let across: Vec<f64> = (0..SIZE).map(|at| picture[at * SIZE + middle]).collect();
        let along: Vec<f64> = (0..SIZE).map(|at| picture[middle * SIZE + at]).collect();
        let is_opaque = |line: &[f64]| line.iter().filter(|value| !value.is_nan()).count();
        let line = if is_opaque(&across) < is_opaque(&along) { across } else { along };
        let opaque: Vec<f64> = line.into_iter().filter(|value| !value.is_nan()).collect();
        let voxel = opaque.len() as f64 / 64.0;
        for x in [6.0, 9.0, 12.0] {
            let at = |side: f64| opaque[(opaque.len() as f64 / 2.0 + side * x * voxel) as usize];
            let (found, right) = (0.5 * (at(-1.0) + at(1.0)), groove_light(x, DEPTH));
            println!("{what}, {x} from the bottom: {found:.4}, {right:.4} in closed form");
            let limit = GROOVE_UNDER_SKY[usize::from(what.ends_with("Full"))];
            assert!((found / right - 1.0).abs() <= limit, "{what}: {found}, not {right}");
        }
    });
}

/// Light at a position on the floor of a rectangular well with its middle at 0, under a sky that only its opening
/// shows: the sum over the quarters of a rectangle parallel to the floor.
fn well_light(edge: f64, depth: f64, x: f64, y: f64) -> f64 {
    let quarter = |a: f64, b: f64| {
        let (a, b) = (a / depth, b / depth);
        let length = |a: f64| (a * a + 1.0).sqrt();
        let part = |a: f64, b: f64| a / length(a) * (b / length(a)).atan();
        (part(a, b) + part(b, a)) / std::f64::consts::TAU
    };
    let half = edge / 2.0;
    [half - x, half + x].iter().flat_map(|a| [half - y, half + y].map(|b| quarter(*a, b))).sum()
}

/// The floor of a well is compared without the two voxels beside its walls, because places on it see the sky in whole
/// directions: of its middle alone, one more or less would be a tenth.
#[test]
fn a_well_is_dark_at_its_floor() {
    const EDGE: f64 = 24.0;
    const FLOOR: f64 = 9.5;
    assert!((well_light(EDGE, EDGE, 0.0, 0.0) - 0.239).abs() < 1e-3);
    let places: Vec<f64> = (0..40).map(|at| 0.5 * f64::from(at) - 9.75).collect();
    let of_place = |x: &f64| places.iter().map(|y| well_light(EDGE, EDGE, *x, *y)).sum::<f64>();
    let right = places.iter().map(of_place).sum::<f64>() / (places.len() * places.len()) as f64;
    let mut all: [Vec<f64>; 2] = Default::default();
    // Walls, floor and rim lie between blocks, between voxels, and in the middle of either.
    for shift in [0.0, 0.5, 1.0, 1.5] {
        let depth = |p: DVec3| {
            let (across, height) = ((p - 19.5 - shift).abs(), p.z - FLOOR - shift);
            (EDGE - height).min((-height).max(across.x.max(across.y) - EDGE / 2.0))
        };
        // With the well in its middle, which the picture shows in its own.
        let edge = 40 + (2.0 * shift) as usize;
        let scene = Scene { dims: [edge, edge, 40], depth: &depth, view: [0.0, 90.0] };
        for_all_looks(&format!("well moved by {shift}"), &scene, |what, picture| {
            let top: Vec<bool> = (0..SIZE).map(|at| !picture[SIZE / 2 * SIZE + at].is_nan()).collect();
            let voxel = top.iter().filter(|is_opaque| **is_opaque).count() as f64 / edge as f64;
            let [found, ..] = statistics(picture, 20.0 * voxel / SIZE as f64);
            println!("{what}: {found:.4}, {right:.4} in closed form, {voxel:.2} pixels per voxel");
            let is_full = usize::from(what.ends_with("Full"));
            assert!((found / right - 1.0).abs() <= WELL_UNDER_SKY[is_full], "{what}: {found}, not {right}");
            all[is_full].push(found / right);
        });
    }
    for relative in all {
        let mean = relative.iter().sum::<f64>() / relative.len() as f64;
        println!("mean of wells: {mean:.4} of the closed form");
        assert!((mean - 1.0).abs() <= WELLS_UNDER_SKY, "{mean}");
    }
}

#[test]
fn resolutions_agree_on_a_ball_over_a_plane() {
    let ball = DVec3::new(27.5, 27.5, 22.0);
    let depth = |p: DVec3| (7.3 - p.z).max(10.0 - p.distance(ball));
    let scene = Scene { dims: [56, 56, 40], depth: &depth, view: [-55.0, 35.0] };
    let mut renderer = new_renderer();
    for (name, curve) in opacity_curves() {
        let [half, full] = RESOLUTIONS
            .map(|resolution| statistics(&brightness(&mut renderer, &scene, resolution, &curve), 1.0)[0]);
        println!("{name}: {half:.4} at half resolution, {full:.4} at full");
        assert!((half / full - 1.0).abs() <= SKY_AT_HALF_OF_FULL, "{name}: {half} and {full}");
    }
}

/// Mistakes in the start of rays and in their weights change the level of an open ball.
#[test]
fn mistakes_on_surfaces_are_noticed() {
    let depth = |p: DVec3| 15.3 - p.distance(DVec3::splat(23.5));
    let scene = Scene { dims: [48; 3], depth: &depth, view: [-55.0, 24.0] };
    let mistakes = [
        ("return dot(abs(normal)", "return -1.0 + dot(abs(normal)"),
        ("surface.scale.y * 4.0", "surface.scale.y * 3.8"),
        ("height - surface.height", "height - surface.height - 1.5"),
        ("surface.share *= f32(geometry.has_surfaces)", "surface.share *= 0.0"),
    ];
    let [(_, curve), _] = opacity_curves();
    for (from, to) in mistakes {
        let mut renderer = damaged_renderer(from, to);
        let picture = brightness(&mut renderer, &scene, LightVolumeResolution::Half, &curve);
        let [mean, deviation, ..] = statistics(&picture, 1.0);
        println!("{to}: {mean:.4} ± {deviation:.4}");
        let is_noticed = (mean - 1.0).abs() > CONVEX_BODY_UNDER_SKY || deviation > CONVEX_BODY_UNDER_SKY;
        assert!(is_noticed, "{to:?} is not noticed: {mean} ± {deviation}");
    }
}
