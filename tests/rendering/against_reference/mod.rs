//! Tests of the GPU against the independent f64 reference, and proof that the comparison detects mistakes.

use chiaroscuro_reference::{Reference, ReferenceOptions, Rounding};
use chiaroscuro_scene::{LightShape, Settings, ShadowAlgorithm};
use chiaroscuro_volume::Volume;
use glam::DVec3;

use crate::common::{Dataset, full_attenuation, new_renderer, render};
use crate::compare::{channels_f32, channels_f64, compare, to_f64};
use crate::scenes;
use crate::thresholds::SAME_WEIGHTS;

mod area_lights;
mod colored_shadows;
mod gather;
mod labels;
mod layers;
mod limit;
mod multiple_scattering;
pub(crate) mod mutations;
mod preintegrated;
mod presence;
mod scatter;
mod scatter_mutations;
mod shape_cuts;
mod sky;

const SIZE: [u32; 2] = [96, 80];

fn round_to_f16(value: f32) -> f32 {
    half::f16::from_f32(value).to_f32()
}

/// Compares sheets, light volumes and picture of one look at one size with the reference, with densities rounded by
/// `rounding`.
pub(crate) fn check_against(
    name: &str,
    n: usize,
    spacing_mm: DVec3,
    settings: &Settings,
    rounding: Option<Rounding>,
) {
    check_volume(name, scenes::creature(n, spacing_mm), settings, rounding);
}

/// Compares sheets, light volumes and picture of any volume with the reference.
pub(crate) fn check_volume(name: &str, volume: Volume, settings: &Settings, rounding: Option<Rounding>) {
    let loaded = Dataset::new(volume);
    let options = ReferenceOptions { rounding, ..ReferenceOptions::default() };
    let drawn = settings.resolved_for(loaded.volume());
    check_with(name, &loaded, settings, &Reference::new(loaded.volume(), &drawn, options));
}

/// Compares sheets, light volumes and picture of a dataset with a reference of it.
fn check_with(name: &str, loaded: &Dataset, settings: &Settings, reference: &Reference<'_>) {
    let mut renderer = new_renderer();
    let mut failures = Vec::new();
    for light in (0..settings.lights.len()).filter(|&light| settings.lights[light].needs_volume()) {
        if !settings.shadows.algorithm.has_volume() {
            continue;
        }
        // Sheets are compared for point lights only.
        let is_point = settings.lights[light].shape == LightShape::Point;
        let splats = settings.shadows.algorithm == ShadowAlgorithm::Splat && is_point;
        let sheets = if splats { reference.light_sheets(light) } else { Vec::new() };
        for (view, expected) in sheets.iter().enumerate() {
            let found = renderer.light_sheets(loaded, settings, light, view).expect("sheets are read back");
            let what = format!("{name}: sheets of light {light}, view {view}");
            failures.extend(compare(&what, &to_f64(&found), &expected.deposits.concat(), SAME_WEIGHTS).err());
        }
        let found = full_attenuation(&mut renderer, loaded, settings, light);
        let expected = reference.attenuation(light);
        let what = format!("{name}: light volume {light}");
        failures.extend(compare(&what, &to_f64(&found), &expected.values, SAME_WEIGHTS).err());
    }
    let found = render(&mut renderer, loaded, settings, SIZE);
    let expected = reference.picture(SIZE, &reference.attenuations());
    failures.extend(
        compare(
            &format!("{name}: picture"),
            &channels_f32(&found.linear),
            &channels_f64(&expected),
            SAME_WEIGHTS,
        )
        .err(),
    );
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
