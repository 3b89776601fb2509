//! Tests of changes to layers: curves of their own for light, and materials.

use super::{ChangeEffect, effect_of, request};
use chiaroscuro_scene::{MaterialBox, SkyMode};

#[test]
fn an_unlinked_lighting_curve_frees_the_eye() {
    let mut before = request();
    before.settings.layer_mut().lighting.linked = false;
    before.settings.sky.mode = SkyMode::Off;
    assert_eq!(effect_of(&before, "transfer.points.1.opacity", "0.4"), ChangeEffect::Eye);
    // Shadow rays use the lighting curve in the eye pass itself.
    before.settings.shadows.algorithm = chiaroscuro_scene::ShadowAlgorithm::Direct;
    assert_eq!(effect_of(&before, "lighting.scale", "0.4"), ChangeEffect::Eye);
    // Sky light has a volume, regardless of the shadow algorithm of lights.
    before.settings.sky.mode = SkyMode::White;
    assert_eq!(effect_of(&before, "lighting.scale", "0.4"), ChangeEffect::Sky);
}

#[test]
fn colours_of_materials_leave_light() {
    let mut before = request();
    before.settings.sky.mode = SkyMode::Off;
    before.settings.scattering.bounces = 0;
    let material = MaterialBox { values: [0.2, 0.8], changes: [0.0, 0.1], ..MaterialBox::default() };
    before.settings.layer_mut().materials = vec![material, MaterialBox { opacity: 0.9, ..material }];
    assert_eq!(effect_of(&before, "materials.0.color", "[1,0,0]"), ChangeEffect::Eye);
    for (path, value) in
        [("opacity", "0.1"), ("values", "[0.2, 0.9]"), ("changes", "[0, 1]"), ("softness", "1")]
    {
        assert_eq!(
            effect_of(&before, &format!("materials.0.{path}"), value),
            ChangeEffect::AllLights,
            "{path}"
        );
    }
    before.settings.shadows.transmission = 0.5;
    assert_eq!(effect_of(&before, "materials.0.color", "[1,0,0]"), ChangeEffect::AllLights);
}
