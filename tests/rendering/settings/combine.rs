//! Combined lights: several lights in one volume of colours (P §4).

use crate::common::{Dataset, new_renderer, render};
use crate::compare::{channels_f32, compare, difference};
use crate::scenes::{self, make_isotropic};
use crate::thresholds::{COMBINED, COMBINED_NORMALS};
use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{LightGeometry, LightSettings, LightStorage, NearFieldRay, Settings};
use glam::DVec3;

const SIZE: [u32; 2] = [96, 80];

/// Look with three lights that cast shadows, and one that does not; no highlights.
fn look() -> Settings {
    let mut settings = scenes::look();
    let colored = |position, color, kind| LightSettings { color, ..scenes::light(kind, position) };
    settings.lights = vec![
        colored([1.3, -0.8, 1.7], [1.0, 0.7, 0.4], LightGeometry::Parallel),
        colored([-1.8, 1.2, 1.9], [0.3, 0.5, 1.0], LightGeometry::Perspective),
        LightSettings {
            casts_shadows: false,
            ..colored([0.2, 2.0, 0.4], [0.2, 0.4, 0.2], LightGeometry::Parallel)
        },
        colored([0.4, 0.3, -2.0], [0.8, 0.2, 0.6], LightGeometry::Parallel),
    ];
    settings.shading.specular = 0.0;
    settings.shadows.gain = 1.4;
    settings.shadows.bias_voxels = 0.5;
    settings.shadows.storage = LightStorage::PerLight;
    // A combined volume does not support near-field rays.
    settings.shadows.near_field = NearFieldRay::Off;
    settings
}

/// No. 14: For isotropic material, combined light is the sum of all lights; otherwise the angle to the light is
/// interpolated, too.
#[test]
fn combined_light_is_the_sum_of_the_lights() {
    let loaded = Dataset::new(scenes::creature(48, DVec3::new(1.0, 1.2, 1.5)));
    let mut renderer = new_renderer();
    let mut settings = look();
    let surfaces = |storage: LightStorage, even: bool, settings: &mut Settings| {
        settings.shadows.storage = storage;
        if even {
            let shading = settings.shading.clone();
            make_isotropic(settings);
            settings.shading.ambient = shading.ambient;
        }
    };
    surfaces(LightStorage::PerLight, true, &mut settings);
    let apart = render(&mut renderer, &loaded, &settings, SIZE);
    settings.shadows.storage = LightStorage::Combined;
    let together = render(&mut renderer, &loaded, &settings, SIZE);
    compare("combined", &channels_f32(&together.linear), &channels_f32(&apart.linear), COMBINED)
        .unwrap_or_else(|err| panic!("{err}"));
    // With normals: the difference is reported, and must exist, or the test would be meaningless.
    let mut settings = look();
    let apart = render(&mut renderer, &loaded, &settings, SIZE);
    settings.shadows.storage = LightStorage::Combined;
    let together = render(&mut renderer, &loaded, &settings, SIZE);
    let found = difference(&channels_f32(&together.linear), &channels_f32(&apart.linear));
    println!("combined with normals: RMSE {:.2e}, largest {:.2e}", found.rmse, found.max);
    assert!(
        found.rmse > 0.0 && found.rmse < COMBINED_NORMALS,
        "interpolated normals differ a little: {}",
        found.rmse
    );
}

/// One volume is kept instead of one per light, until a light changes.
#[test]
fn a_combined_volume_is_kept_until_a_light_changes() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut renderer = new_renderer();
    let mut settings = look();
    render(&mut renderer, &loaded, &settings, SIZE);
    let voxels = loaded.volume().voxel_count() as u64;
    assert_eq!(renderer.light_bytes(), 3 * 2 * voxels, "three lights cast shadows");
    settings.shadows.storage = LightStorage::Combined;
    let first = render(&mut renderer, &loaded, &settings, SIZE);
    assert_eq!(renderer.light_bytes(), 8 * voxels, "four 16-bit numbers, and the lights' own are gone");
    let fills = |renderer: &Renderer| renderer.light_rebuilds().iter().sum::<u64>();
    let before = fills(&renderer);
    settings.camera.azimuth_deg += 30.0;
    settings.shading.ambient = 0.4;
    settings.shading.diffuse = 0.5;
    render(&mut renderer, &loaded, &settings, SIZE);
    assert_eq!(
        fills(&renderer),
        before,
        "the camera and what the picture does with the light change nothing"
    );
    settings.camera.azimuth_deg -= 30.0;
    (settings.shading.ambient, settings.shading.diffuse) = (look().shading.ambient, look().shading.diffuse);
    assert!(render(&mut renderer, &loaded, &settings, SIZE).linear == first.linear);
    settings.lights[1].color = [1.0, 0.0, 0.0];
    let recolored = render(&mut renderer, &loaded, &settings, SIZE);
    assert_eq!(fills(&renderer), before + 3, "all lights are filled again");
    assert!(recolored.linear != first.linear);
    // The automatic choice combines lights only where that costs nothing.
    settings.shadows.storage = LightStorage::Auto;
    assert!(!settings.combines_lights(), "three volumes take less than one of colours");
    settings.lights.extend(vec![settings.lights[0].clone(); 3]);
    assert!(settings.combines_lights());
    settings.shading.specular = 0.1;
    assert!(!settings.combines_lights(), "highlights would be lost");
}
