//! Area lights against the reference: light volumes, near-field rays, and the floor below.

use chiaroscuro_reference::{Reference, ReferenceFault, ReferenceOptions};
use chiaroscuro_scene::{
    LightGeometry, LightSettings, LightShape, LightStorage, LightVolumeResolution, NearFieldRay,
    RenderEngine, Settings, ShadowAlgorithm, Spotlight,
};
use glam::DVec3;

use super::mutations::{assert_in_shader, differs_in_look};
use super::{SIZE, check_volume};
use crate::common::{Dataset, damaged_renderer, new_renderer, render};
use crate::compare::{ErrorLimit, channels_f32, channels_f64, compare};
use crate::scenes;
use crate::thresholds::{COMBINED_NORMALS, SAME_WEIGHTS};

const N: usize = 22;

/// Look with a distant disc, a rectangle, and a ball close by.
fn look() -> Settings {
    let mut settings = scenes::look();
    let light = |kind, position| scenes::light(kind, position);
    settings.lights = vec![
        LightSettings {
            shape: LightShape::Disc,
            angle_deg: 30.0,
            ..light(LightGeometry::Parallel, [1.3, -0.8, 1.7])
        },
        LightSettings {
            shape: LightShape::Rectangle,
            size: 1.4,
            aspect: 0.6,
            turn_deg: 25.0,
            ..light(LightGeometry::Perspective, [-2.2, 1.8, 2.4])
        },
        LightSettings {
            shape: LightShape::Ball,
            size: 0.7,
            ..light(LightGeometry::Perspective, [1.1, 1.2, -0.4])
        },
    ];
    settings.shadows.area.samples = 4;
    settings
}

fn check(what: &str, settings: &Settings) {
    check_volume(what, scenes::creature(N, DVec3::new(1.0, 1.0, 1.4)), settings, None);
}

#[test]
fn three_shapes() {
    let mut settings = look();
    check("half resolution", &settings);
    settings.shadows.area.resolution = LightVolumeResolution::Full;
    settings.shadows.area.samples = 1;
    settings.lights[1].hood = Spotlight { on: true, half_angle_deg: 22.0, rim_deg: 9.0 };
    check("one point each, a hood", &settings);
    settings.shadows.area.samples = 3;
    check("finely", &settings);
}

#[test]
fn by_rays() {
    let mut settings = look();
    settings.shadows.area.samples = 3;
    settings.lights[1].hood = Spotlight { on: true, half_angle_deg: 22.0, rim_deg: 9.0 };
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    check("rays from voxels", &settings);
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    settings.shadows.bias_voxels = 0.6;
    check("rays from samples", &settings);
}

#[test]
fn scattered() {
    let mut settings = look();
    settings.shadows.area.samples = 2;
    settings.lights.truncate(2);
    settings.sampling.engine = RenderEngine::Scatter;
    check("scattered", &settings);
}

/// Combined light has the same resolution as per-light volumes, whatever the resolution of area lights.
#[test]
fn in_one_volume_for_all() {
    let mut settings = look();
    settings.shadows.area.samples = 2;
    settings.shadows.near_field = NearFieldRay::Off;
    settings.shading.specular = 0.0;
    let loaded = Dataset::new(scenes::creature(N, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut picture = |storage, area| {
        settings.shadows.storage = storage;
        settings.shadows.area.resolution = area;
        channels_f32(&render(&mut renderer, &loaded, &settings, SIZE).linear)
    };
    let each = picture(LightStorage::PerLight, LightVolumeResolution::Full);
    let all = picture(LightStorage::Combined, LightVolumeResolution::Half);
    let limit = ErrorLimit { max: f64::INFINITY, rmse: COMBINED_NORMALS };
    compare("one volume for all", &all, &each, limit).unwrap_or_else(|err| panic!("{err}"));
}

#[test]
fn mistakes_in_them_are_noticed() {
    let mut settings = look();
    settings.lights.truncate(1);
    // In two batches.
    settings.shadows.area.samples = 8;
    assert!(!differs_in_look(&settings, N, "\u{0}", "", ReferenceFault::None));
    let volume = "light/area_light.wgsl";
    for (from, to) in [
        ("vec4f(sum * average.share)", "vec4f(sum * average.share * 0.97)"),
        ("!IS_FIRST", "false"),
        ("BATCH_SIZE > 2u", "BATCH_SIZE > 4u"),
        ("textureLoad(point_0, voxel, 0).r", "textureLoad(point_1, voxel, 0).r"),
    ] {
        assert_in_shader(volume, from);
        assert!(
            differs_in_look(&settings, N, from, to, ReferenceFault::None),
            "{to:?} for {from:?} is not noticed"
        );
    }
    for (shader, from, to) in [
        (volume, "dot(slope, average.up) * average.to_top", "dot(slope, average.up) * average.to_right"),
        (volume, "normal / divisor - towards", "-towards"),
        (volume, "smoothstep(0.6666667, 1.0, lowest)", "smoothstep(0.2, 0.3, lowest)"),
        ("light/block_normals.wgsl", "const SPREAD = 1.25;", "const SPREAD = 0.25;"),
        ("light/block_normals.wgsl", "vec3f(MIDDLE_FACTOR)", "vec3f(0.3)"),
        ("light/opacity_blocks.wgsl", "* blocks.edge", "* blocks.edge * 0.1"),
    ] {
        assert_in_shader(shader, from);
        assert!(
            differs_in_look(&settings, N, from, to, ReferenceFault::None),
            "{to:?} for {from:?} is not noticed"
        );
    }
    // A lamp, which voxels beside its axis see aslant.
    let lamp = Settings { lights: vec![look().lights[1].clone()], ..settings.clone() };
    assert!(!differs_in_look(&lamp, N, "\u{0}", "", ReferenceFault::None));
    for (from, to) in [
        ("normal / divisor - towards", "normal / divisor + towards"),
        ("average.perspective * scene_from_index", "0.0 * scene_from_index"),
    ] {
        assert_in_shader(volume, from);
        assert!(
            differs_in_look(&lamp, N, from, to, ReferenceFault::None),
            "{to:?} for {from:?} is not noticed"
        );
    }
    // A single ring, of which half a step is 45°.
    settings.shadows.area.samples = 4;
    settings.lights[0].angle_deg = 80.0;
    // Near-field rays that enter the material below the terminator of the light's centre.
    let (from, to) = ("half_width * weight;", "half_width * 0.0;");
    assert_in_shader("eye/eye_pass.wgsl", from);
    assert!(!differs_in_look(&settings, N, "\u{0}", "", ReferenceFault::None));
    assert!(
        differs_in_look(&settings, N, from, to, ReferenceFault::None),
        "{to:?} for {from:?} is not noticed"
    );
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    settings.shadows.strength = 0.7;
    assert!(!pictures_differ(&settings, "\u{0}", ""));
    for (from, to) in [
        ("* sqrt((first + end) / (2.0 * all)), orbit", "* ((first + end) / (2.0 * all)), orbit"),
        ("- first) + ring;", "- first);"),
        ("1.0 + inner * tangents", "1.0 + 9.0 * inner * tangents"),
        ("light.area_up * across.y", "light.area_up * across.x"),
        ("return sum / weights;", "return sum / (weights + 1.0);"),
        ("shading.shininess * width / 16.0", "shading.shininess * width / 4.0"),
        // The visible part of the light shines as if from the centre; the rest counts where shadows are weak.
        ("disc.y * half_width, disc.x", "max(facing, 0.0), disc.x"),
        ("disc.y * half_width, disc.x", "disc.y * half_width, 1.0"),
        ("root * (2.0 + u * u) / 3.0", "root * (2.0 + u) / 3.0"),
    ] {
        assert_in_shader("eye/eye_pass.wgsl", from);
        assert!(pictures_differ(&settings, from, to), "{to:?} for {from:?} is not noticed");
    }
}

/// Rays from samples to a light that is wide, but above the horizon of most surfaces, with points that count alike.
#[test]
fn equal_weights_of_rays_are_noticed() {
    let mut settings = look();
    settings.lights.truncate(1);
    // So bright that the difference exceeds the limit.
    (settings.lights[0].angle_deg, settings.lights[0].intensity) = (40.0, 4.0);
    settings.shadows.area.samples = 8;
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    let (from, to) = ("let weight = point_weight(slope, centre, way.direction);", "let weight = 1.0;");
    assert_in_shader("eye/eye_pass.wgsl", from);
    assert!(!pictures_differ(&settings, "\u{0}", ""));
    assert!(pictures_differ(&settings, from, to));
}

/// Returns true if the picture of a damaged shader differs from the reference's.
fn pictures_differ(settings: &Settings, from: &str, to: &str) -> bool {
    let loaded = Dataset::new(scenes::creature(N, DVec3::ONE));
    let mut renderer = damaged_renderer(from, to);
    let expected = Reference::new(loaded.volume(), settings, ReferenceOptions::default()).picture(SIZE, &[]);
    let found = render(&mut renderer, &loaded, settings, SIZE);
    compare("picture", &channels_f32(&found.linear), &channels_f64(&expected), SAME_WEIGHTS).is_err()
}
