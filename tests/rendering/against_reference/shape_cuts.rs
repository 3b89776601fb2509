//! Voxels hidden by shapes, against the reference: for both engines, rays, labels, several fields and all light.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_scene::{
    Camera, ClassificationOrder, ClipEffect, ComponentCut, CutAction, CutShape, LightGeometry, NearFieldRay,
    OutlineCut, ReconstructionKernel, RenderEngine, ScatteringSettings, Settings, ShadowAlgorithm, ShapeCut,
    SkyMode, SkySettings, SphereCut, VolumeLayer,
};
use chiaroscuro_volume::ValueRange;
use glam::DVec3;

use super::mutations::differs_with;
use super::presence::{two_lobes, waves};
use super::{check_volume, check_with, round_to_f16};
use crate::common::Dataset;
use crate::scenes;

/// Cuts of every kind: behind an outline, all but a ball, a part of that again, and what is connected.
fn all_shapes() -> Vec<ShapeCut> {
    let cut = |action, shape| ShapeCut { action, shape, ..ShapeCut::default() };
    let sphere = |center, radius, action| cut(action, CutShape::Sphere(SphereCut { center, radius }));
    let outline = OutlineCut {
        camera: Camera { azimuth_deg: 70.0, elevation_deg: 20.0, ..Camera::default() },
        aspect: 1.5,
        points: vec![[0.4, 0.2], [0.55, 0.3], [0.5, 0.7], [0.42, 0.6]],
        ..OutlineCut::default()
    };
    vec![
        cut(CutAction::Hide, CutShape::Outline(outline)),
        sphere([0.1, 0.0, -0.1], 0.62, CutAction::Keep),
        sphere([0.4, -0.3, 0.3], 0.3, CutAction::Restore),
        cut(
            CutAction::Hide,
            CutShape::Component(ComponentCut { seed: [0.2; 3], values: ValueRange::new(110.0, 255.0) }),
        ),
        ShapeCut { on: false, ..sphere([0.0; 3], 2.0, CutAction::Hide) },
    ]
}

fn look() -> Settings {
    let mut settings = two_lobes();
    settings.cuts.shapes = all_shapes();
    settings
}

/// Look with the cuts of [`look`], of which some hide from the eye alone and others from light alone.
fn look_by_observer() -> Settings {
    let mut settings = look();
    let effects = [ClipEffect::Hidden, ClipEffect::Shadowless, ClipEffect::Removed, ClipEffect::Hidden];
    for (cut, effect) in settings.cuts.shapes.iter_mut().zip(effects) {
        cut.effect = effect;
    }
    settings
}

#[test]
fn eye_and_light_see_different_voxels() {
    let mut settings = look_by_observer();
    settings.sky = SkySettings { mode: SkyMode::White, directions: 12, ..SkySettings::default() };
    check_volume("effects", waves(18, DVec3::ONE, true), &settings, Some(round_to_f16));
    settings.scattering = ScatteringSettings { bounces: 2, directions: 12, ..ScatteringSettings::default() };
    settings.sampling.classification = ClassificationOrder::Pre;
    check_volume("effects, classified", waves(16, DVec3::ONE, false), &settings, Some(round_to_f16));
    let mut settings = look_by_observer();
    settings.shadows.near_field = NearFieldRay::Long;
    settings.camera.distance = 9.0;
    check_volume("effects, near", waves(16, DVec3::ONE, false), &settings, Some(round_to_f16));
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    check_volume("effects, direct", waves(12, DVec3::ONE, false), &settings, Some(round_to_f16));
    settings = look_by_observer();
    settings.sampling.engine = RenderEngine::Scatter;
    check_volume("scattered effects", waves(16, DVec3::ONE, false), &settings, None);
}

#[test]
fn hidden_voxels_have_no_matter() {
    check_volume("cuts", waves(20, DVec3::ONE, false), &look(), Some(round_to_f16));
    check_volume("cuts and holes", waves(18, DVec3::ONE, true), &look(), None);
    let mut settings = look();
    settings.camera.distance = 9.0;
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.6, -1.2, 2.2])];
    settings.shadows.near_field = NearFieldRay::Long;
    settings.shadows.kernel = ReconstructionKernel::Prefiltered;
    check_volume(
        "cuts, stretched",
        waves(20, DVec3::new(1.0, 0.8, 1.6), false),
        &settings,
        Some(round_to_f16),
    );
    settings.sampling.classification = ClassificationOrder::Pre;
    check_volume("cuts, classified", waves(18, DVec3::ONE, false), &settings, Some(round_to_f16));
}

#[test]
fn hidden_voxels_block_no_rays() {
    let mut settings = look();
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    check_volume("cuts, rays", waves(14, DVec3::ONE, false), &settings, Some(round_to_f16));
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    check_volume("cuts, direct", waves(12, DVec3::ONE, false), &settings, Some(round_to_f16));
}

#[test]
fn hidden_voxels_are_not_splatted() {
    let mut settings = look();
    settings.sampling.engine = RenderEngine::Scatter;
    check_volume("scattered cuts", waves(18, DVec3::ONE, false), &settings, None);
    settings.sampling.classification = ClassificationOrder::Pre;
    check_volume("scattered cuts, classified", waves(18, DVec3::ONE, false), &settings, None);
}

#[test]
fn all_layers_are_hidden() {
    let first = waves(24, DVec3::ONE, false);
    let dataset = Dataset::from_volumes(first.clone(), [first]);
    let mut settings = look();
    let second = VolumeLayer { edges: 0.05, ..settings.layers.first().clone() };
    settings.layers.push(second);
    let options = ReferenceOptions { rounding: Some(round_to_f16), ..ReferenceOptions::default() };
    let drawn = settings.resolved_for_dataset(&dataset);
    check_with("cuts of layers", &dataset, &settings, &Reference::with_layers(&dataset, &drawn, options));
    settings.cuts = look_by_observer().cuts;
    let drawn = settings.resolved_for_dataset(&dataset);
    check_with("effects on layers", &dataset, &settings, &Reference::with_layers(&dataset, &drawn, options));
}

#[test]
fn mistakes_in_masks_are_noticed() {
    let loaded = Dataset::new(waves(20, DVec3::ONE, false));
    let (settings, options) =
        (look(), ReferenceOptions { rounding: Some(round_to_f16), ..ReferenceOptions::default() });
    let is_noticed = |reference: &Settings, damage| {
        differs_with(&loaded, &settings, &Reference::new(loaded.volume(), reference, options), damage)
    };
    let none = ("", "");
    assert!(!is_noticed(&settings, none), "nothing is damaged");
    // Matter that stays where voxels are hidden, for all passes and for lights alone.
    assert!(is_noticed(&settings, ("return 0.5 * texel.r + 0.5;", "return 1.0;")), "presence is ignored");
    let light_alone = (
        "extinction_of(slab_field(frame, ray, k)) * slab_presence(frame, ray, k)",
        "extinction_of(slab_field(frame, ray, k))",
    );
    assert!(is_noticed(&settings, light_alone), "hidden voxels cast shadows");
    let mut other = settings.clone();
    other.cuts.shapes[0].action = CutAction::Keep;
    assert!(is_noticed(&other, none), "kept instead of hidden");
    other = settings.clone();
    other.cuts.shapes.remove(3);
    assert!(is_noticed(&other, none), "component");
    other = settings.clone();
    let CutShape::Outline(outline) = &mut other.cuts.shapes[0].shape else { panic!("an outline") };
    outline.camera.azimuth_deg += 5.0;
    assert!(is_noticed(&other, none), "camera of an outline");
    for effect in [ClipEffect::Hidden, ClipEffect::Shadowless] {
        other = settings.clone();
        other.cuts.shapes[1].effect = effect;
        assert!(is_noticed(&other, none), "{effect:?} instead of removed");
    }
    // Without the component, which hides what the ball restores.
    let mut plain = settings.clone();
    plain.cuts.shapes.remove(3);
    other = plain.clone();
    other.cuts.shapes.swap(1, 2);
    let reference = Reference::new(loaded.volume(), &other, options);
    assert!(differs_with(&loaded, &plain, &reference, none), "order of cuts");
    // Rays from the eye to lights.
    let mut near = look_by_observer();
    near.shadows.near_field = NearFieldRay::Long;
    let reference = Reference::new(loaded.volume(), &near, options);
    assert!(!differs_with(&loaded, &near, &reference, none), "nothing is damaged");
    let of_eye = ("textureSampleLevel(lighting_presence_texture,", "textureSampleLevel(presence_texture,");
    assert!(differs_with(&loaded, &near, &reference, of_eye), "rays see what the eye sees");
}
