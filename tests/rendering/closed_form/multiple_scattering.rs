//! Multiple scattering in scenes with a known solution, on the reference and on the GPU.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{
    DensityRange, LightGeometry, LightVolumeResolution, ScatteringSettings, Settings, ShadowSettings,
    SkyMode, SkySettings,
};
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::DVec3;

use crate::against_reference::mutations::assert_in_shader;
use crate::common::{damaged_renderer, new_renderer, render};
use crate::scenes::{self, linear_extinction};
use crate::thresholds::{FURNACE, HALF_SPACE, PICTURED_FURNACE, PICTURED_FURNACE_CONVERGED};

/// Volume with densities given by `full`.
fn volume(dims: [usize; 3], full: impl Fn([usize; 3]) -> f64) -> Volume {
    let [nx, ny, nz] = dims;
    let place = |at: usize| [at % nx, at / nx % ny, at / (nx * ny)];
    let values: Vec<u8> = (0..nx * ny * nz).map(|at| (255.0 * full(place(at))).round() as u8).collect();
    Volume::with_spacing("bounces", dims, DVec3::ONE, Samples::U8(values)).expect("a volume")
}

fn scattering_look(per_voxel: f64, (bounces, albedo, directions): (u32, f64, u32)) -> Settings {
    let scattering = ScatteringSettings {
        bounces,
        albedo,
        directions,
        resolution: LightVolumeResolution::Full,
        ..ScatteringSettings::default()
    };
    Settings { scattering, lights: Vec::new(), ..scenes::look() }
        .with_transfer(linear_extinction(per_voxel))
        .with_range(DensityRange::Full)
}

/// Scattered light in the red channel, by the reference and the GPU.
fn scattered_light(volume: &Volume, settings: &Settings) -> [Vec<f64>; 2] {
    let reference = Reference::new(volume, settings, ReferenceOptions::default()).bounced_light();
    let mut renderer = new_renderer();
    let light =
        renderer.scattered_light(&Dataset::new(volume.clone()), settings).expect("light is read back");
    let [red, _, _] = reference.light;
    [red, light.iter().map(|texel| f64::from(texel[0])).collect()]
}

/// White furnace: under a sky of 1 everywhere, material that absorbs nothing is invisible, since it returns all light
/// that it occludes. Scattered light is the complement of sky visibility, whatever the densities.
#[test]
fn what_absorbs_nothing_vanishes_in_a_white_furnace() {
    let dims = [20, 17, 23];
    let volume = volume(dims, |[x, y, z]| if (x / 3 + y / 4 + z / 5) % 3 == 0 { 1.0 } else { 0.25 });
    let mut settings = scattering_look(0.3, (12, 1.0, 24));
    settings.sky = SkySettings {
        mode: SkyMode::White,
        intensity: 1.0,
        directions: 24,
        resolution: LightVolumeResolution::Full,
        ..SkySettings::default()
    };
    let openness = Reference::new(&volume, &settings, ReferenceOptions::default()).sky_visibility();
    for bounced in scattered_light(&volume, &settings) {
        let all = bounced.iter().zip(&openness.mean_transmittance).map(|(bounced, open)| bounced + open);
        let (least, most) =
            all.fold((f64::MAX, f64::MIN), |(least, most), light| (least.min(light), most.max(light)));
        println!("light in a white furnace: {least:.4} to {most:.4}");
        assert!(least >= 1.0 - FURNACE && most <= 1.0 + FURNACE, "{least} to {most}");
    }
}

/// White cube that absorbs nothing, 26 voxels wide, of an optical depth, under a white sky.
fn white_cube(depth: f64, bounces: u32) -> (Dataset, Settings) {
    const BORDER: usize = 3;
    const N: usize = 32;
    let cube =
        volume([N; 3], |at| if at.iter().all(|c| (BORDER..N - BORDER).contains(c)) { 1.0 } else { 0.0 });
    let scattering = ScatteringSettings { bounces, albedo: 1.0, ..ScatteringSettings::default() };
    let mut settings = Settings { scattering, lights: Vec::new(), ..scenes::look() }
        .with_transfer(linear_extinction(depth / (N - 2 * BORDER) as f64))
        .with_range(DensityRange::Full);
    scenes::make_isotropic(&mut settings);
    settings.shadows.least_blocks = ShadowSettings::default().least_blocks;
    settings.sky = SkySettings { mode: SkyMode::White, intensity: 1.0, ..SkySettings::default() };
    (Dataset::new(cube), settings)
}

/// Darkest and brightest light of a picture over its opacity, where that is more than a fifth.
fn extremes(renderer: &mut Renderer, (loaded, settings): &(Dataset, Settings)) -> (f64, f64) {
    let picture = render(renderer, loaded, settings, [40, 40]).linear;
    let seen = picture.iter().filter(|texel| texel[3] > 0.2);
    let light = seen.map(|texel| f64::from(texel[0] / texel[3]));
    light.fold((f64::MAX, f64::MIN), |(least, most), light| (least.min(light), most.max(light)))
}

/// However dense it is, and with few bounces: what later ones bring diffuses.
#[test]
fn dense_white_cubes_vanish_in_a_white_furnace() {
    let mut renderer = new_renderer();
    let mut failures = Vec::new();
    for depth in [3.0, 8.0, 18.0, 40.0] {
        for (bounces, limit) in
            [(4, PICTURED_FURNACE), (6, PICTURED_FURNACE), (12, PICTURED_FURNACE_CONVERGED)]
        {
            let (least, most) = extremes(&mut renderer, &white_cube(depth, bounces));
            println!("depth {depth}, {bounces} bounces: {least:.4} to {most:.4}");
            if least < 1.0 - limit || most > 1.0 + limit {
                failures.push(format!("depth {depth}, {bounces} bounces: {least} to {most}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Cycles that go wrong are mended by later ones in part, so that the limit is that of the most bounces.
#[test]
fn mistakes_in_the_furnace_are_noticed() {
    let mistakes = [
        ("scattered_light/source.wgsl", "return change + solution[at].rgb", "return change"),
        (
            "diffusion/relax.wgsl",
            "own.sink + own.faces.x + own.faces.y + own.faces.z",
            "own.sink + own.faces.x",
        ),
        ("diffusion/coarser_stencil.wgsl", "0.5 * stencil.faces", "stencil.faces"),
        ("diffusion/restrict.wgsl", "vec4f(sum / 8.0, 0.0)", "vec4f(0.0)"),
    ];
    for (shader, from, to) in mistakes {
        assert_in_shader(shader, from);
        let (least, most) = extremes(&mut damaged_renderer(from, to), &white_cube(40.0, 4));
        println!("{shader}, {to:?}: {least:.4} to {most:.4}");
        assert!(
            least < 1.0 - PICTURED_FURNACE_CONVERGED || most > 1.0 + PICTURED_FURNACE_CONVERGED,
            "{shader}: {to:?} is not noticed: {least} to {most}"
        );
    }
    let mut renderer = new_renderer();
    let (least, most) = extremes(&mut renderer, &white_cube(40.0, 1));
    assert!(least < 1.0 - PICTURED_FURNACE_CONVERGED, "one bounce alone is not noticed: {least} to {most}");
}

/// Chandrasekhar's H function of isotropic scattering (Radiative Transfer 1950, §39), at μ = 1, by its integral
/// equation: 1/H(μ) = √(1 − ϖ) + ϖ/2 ∫ μ′ H(μ′) / (μ + μ′) dμ′.
fn chandrasekhar(albedo: f64) -> f64 {
    let n = 400;
    let cosine = |i: usize| (i as f64 + 0.5) / n as f64;
    let mut h = vec![1.0; n];
    let inverse = |h: &[f64], cosine_of: f64| {
        let sum: f64 = (0..n).map(|i| cosine(i) * h[i] / (cosine_of + cosine(i))).sum();
        (1.0 - albedo).sqrt() + 0.5 * albedo * sum / n as f64
    };
    for _ in 0..300 {
        h = (0..n).map(|i| 1.0 / inverse(&h, cosine(i))).collect();
    }
    1.0 / inverse(&h, 1.0)
}

/// A half space with isotropic scattering reflects 1 − √(1 − ϖ) H(1) of perpendicular light; the rest is absorbed.
#[test]
fn a_half_space_gives_back_what_chandrasekhar_says() {
    const PER_VOXEL: f64 = 0.6;
    const EMPTY: usize = 2;
    // An optical depth of 15, and to the sides of 10.
    let dims = [33, 33, 27];
    let slab = volume(dims, |[_, _, z]| if z >= EMPTY { 1.0 } else { 0.0 });
    for albedo in [0.8, 0.9] {
        let mut settings = scattering_look(PER_VOXEL, (12, albedo, 24));
        settings.lights = vec![scenes::light(LightGeometry::Parallel, [0.0, 0.0, -1.0])];
        let medium = Reference::new(&slab, &settings, ReferenceOptions::default()).medium();
        let edge = slab.scene().smallest_edge();
        let right = 1.0 - (1.0 - albedo).sqrt() * chandrasekhar(albedo);
        for bounced in scattered_light(&slab, &settings) {
            // Down the middle column: the remaining unscattered light, E/π = 1, and the absorbed share of all light.
            let (mut left, mut absorbed) = (1.0, 0.0);
            for z in 0..dims[2] {
                let at = (z * dims[1] + dims[1] / 2) * dims[0] + dims[0] / 2;
                let depth = medium.extinction[at] * edge;
                let passed = (-depth).exp();
                let mean = if depth > 0.0 { (1.0 - passed) / depth } else { 1.0 };
                absorbed += (1.0 - albedo) * depth * (left * mean + 4.0 * bounced[at]);
                left *= passed;
            }
            println!("albedo {albedo}: {:.4} comes back, {right:.4} in closed form", 1.0 - absorbed);
            assert!((1.0 - absorbed - right).abs() <= HALF_SPACE * right, "{albedo}: {absorbed}");
        }
    }
}

/// Twice the light is twice the scattered light, and two lights give the sum.
#[test]
fn bounced_light_is_linear_in_the_lights() {
    let volume = scenes::noise(14, 5);
    let lit = |lights: Vec<chiaroscuro_scene::LightSettings>| {
        let mut settings = scattering_look(0.4, (1, 0.9, 14));
        settings.lights = lights;
        scattered_light(&volume, &settings)
    };
    let one = scenes::light(LightGeometry::Parallel, [1.0, 0.4, 0.3]);
    let mut other = scenes::light(LightGeometry::Perspective, [-0.5, 1.5, 1.0]);
    other.intensity = 0.7;
    let [a, b, both] = [lit(vec![one.clone()]), lit(vec![other.clone()]), lit(vec![one, other])];
    for engine in 0..2 {
        for at in 0..both[engine].len() {
            let sum = a[engine][at] + b[engine][at];
            assert!((both[engine][at] - sum).abs() <= 1e-3 * sum.max(0.05), "{} {sum}", both[engine][at]);
        }
    }
}

/// Without albedo, bounces or strength nothing is scattered: the same bytes.
#[test]
fn nothing_bounces_where_it_is_off() {
    let dataset = Dataset::new(scenes::noise(20, 7));
    let mut renderer = new_renderer();
    let mut picture = |scattering: ScatteringSettings| {
        let settings = Settings { scattering, ..scenes::look() };
        render(&mut renderer, &dataset, &settings, [64, 48]).linear
    };
    let off = picture(ScatteringSettings::default());
    let on = ScatteringSettings { bounces: 3, ..ScatteringSettings::default() };
    assert_eq!(picture(ScatteringSettings { albedo: 0.0, ..on.clone() }), off);
    assert_eq!(picture(ScatteringSettings { strength: 0.0, ..on.clone() }), off);
    assert_eq!(picture(ScatteringSettings { bounces: 0, density_scale: 0.1, ..on.clone() }), off);
    assert_ne!(picture(on), off);
}
