//! Crop box and clip plane: against the reference, against closed forms, and without side effects.

use chiaroscuro_reference::{Reference, ReferenceFault, ReferenceOptions};
use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{
    ClassificationOrder, ClipEffect, ClipPlane, Clipping, CropBox, GradientSource, LightGeometry,
    LightStorage, NearFieldRay, OpacityLength, RenderEngine, Settings, ShadowAlgorithm, SheetOrder,
};
use glam::DVec3;

use crate::against_reference::check_against;
use crate::common::{Dataset, full_precision_renderer, new_renderer, render};
use crate::compare::{channels_f32, channels_f64, compare};
use crate::scenes::{self, axis_camera, linear_extinction, make_isotropic};
use crate::thresholds::{CHORD_OPACITY, CUT_COMBINED, CUT_LIGHT, CUT_ORDERS, SAME_WEIGHTS, SUMMATION_ORDER};

const SIZE: [u32; 2] = [64, 56];

/// Faces across all axes and one oblique, some of them through the middle of slabs and voxels.
fn cuts(crop: ClipEffect, plane: ClipEffect) -> Clipping {
    Clipping {
        crop: CropBox { on: true, low: [0.21, 0.0, 0.13], high: [1.0, 0.73, 0.9], effect: crop },
        shapes: Vec::new(),
        plane: ClipPlane { on: true, normal: [0.6, -1.0, 0.7], offset: 0.17, effect: plane },
    }
}

fn look(crop: ClipEffect, plane: ClipEffect) -> Settings {
    Settings { cuts: cuts(crop, plane), ..scenes::look() }
}

fn check(name: &str, spacing_mm: DVec3, settings: &Settings) {
    check_against(name, 40, spacing_mm, settings, Some(|value| half::f16::from_f32(value).to_f32()));
}

#[test]
fn removed_parallel_and_perspective() {
    let mut settings = look(ClipEffect::Removed, ClipEffect::Removed);
    check("removed", DVec3::ONE, &settings);
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.6, -1.2, 2.2])];
    check("removed, anisotropic", DVec3::new(1.0, 0.8, 1.6), &settings);
}

#[test]
fn each_effect_for_each_of_them() {
    check("hidden, shadowless", DVec3::ONE, &look(ClipEffect::Hidden, ClipEffect::Shadowless));
    check("shadowless, hidden", DVec3::ONE, &look(ClipEffect::Shadowless, ClipEffect::Hidden));
}

#[test]
fn by_rays() {
    let mut settings = look(ClipEffect::Removed, ClipEffect::Removed);
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    check("rays from voxels", DVec3::ONE, &settings);
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    check("rays from samples", DVec3::ONE, &settings);
    settings.cuts.crop.effect = ClipEffect::Shadowless;
    settings.cuts.plane.effect = ClipEffect::Shadowless;
    check("rays that only the light knows", DVec3::ONE, &settings);
}

#[test]
fn classified_before_and_gradients_of_sheets() {
    let mut settings = look(ClipEffect::Removed, ClipEffect::Hidden);
    settings.sampling.classification = ClassificationOrder::Pre;
    settings.sampling.gradients = GradientSource::Sheets;
    settings.sampling.slab = 0.5;
    check("pre-classified", DVec3::ONE, &settings);
}

#[test]
fn stretched_kernels() {
    let mut settings = look(ClipEffect::Removed, ClipEffect::Removed);
    settings.camera.distance *= 4.0;
    check("from afar", DVec3::ONE, &settings);
}

#[test]
fn scattered() {
    let mut settings = look(ClipEffect::Removed, ClipEffect::Shadowless);
    settings.sampling.engine = RenderEngine::Scatter;
    check_against("scattered", 28, DVec3::new(1.0, 1.2, 1.6), &settings, None);
}

#[test]
fn the_comparison_notices_whole_slabs() {
    let mut settings = look(ClipEffect::Removed, ClipEffect::Removed);
    settings.sampling.slab = 2.0;
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let rounding: fn(f32) -> f32 = |value| half::f16::from_f32(value).to_f32();
    let options = ReferenceOptions {
        fault: ReferenceFault::WholeSlabs,
        rounding: Some(rounding),
        ..ReferenceOptions::default()
    };
    let reference = Reference::new(loaded.volume(), &settings, options);
    let mut renderer = new_renderer();
    let found = render(&mut renderer, &loaded, &settings, SIZE);
    let expected = reference.picture(SIZE, &reference.attenuations());
    assert!(
        compare("whole slabs", &channels_f32(&found.linear), &channels_f64(&expected), SAME_WEIGHTS).is_err()
    );
}

/// Homogeneous block of 32³ voxels in the middle of 48³, seen along z, with extinction ln 2 per 16 voxels.
fn block() -> (Dataset, Settings) {
    let per_voxel = 2.0_f64.ln() / 16.0;
    let mut settings = Settings {
        lights: vec![scenes::light(LightGeometry::Parallel, [0.0, 0.0, 1.0])],
        camera: axis_camera(-90.0, 90.0),
        ..Settings::default()
    }
    .with_transfer(linear_extinction(per_voxel))
    .with_opacity_unit(OpacityLength::Voxels(1.0));
    make_isotropic(&mut settings);
    let inside = |at: [usize; 3]| at.iter().all(|c| (8..40).contains(c));
    (Dataset::new(scenes::block(48, inside)), settings)
}

/// Position of a share of the block's edge, as a share of the grid's.
fn grid_share_of_block(share: f64) -> f64 {
    (8.0 + 32.0 * share) / 48.0
}

/// Opacity and brightness at the centre of the picture.
fn center_alpha_and_red(renderer: &mut Renderer, loaded: &Dataset, settings: &Settings) -> (f64, f64) {
    let picture = render(renderer, loaded, settings, [33, 33]);
    let [red, .., alpha] = picture.linear[16 * 33 + 16].map(f64::from);
    (alpha, red)
}

#[test]
fn a_chord_is_as_opaque_as_what_remains_of_it() {
    let (loaded, mut settings) = block();
    let mut renderer = full_precision_renderer();
    let mut opacity = |settings: &Settings| center_alpha_and_red(&mut renderer, &loaded, settings).0;
    let close = |found: f64, chord: f64| {
        let wanted = 1.0 - (-chord * 2.0_f64.ln() / 16.0).exp();
        assert!((found - wanted).abs() < CHORD_OPACITY, "{found}, {wanted} for {chord} voxels");
    };
    close(opacity(&settings), 32.0);
    for slab in [0.4, 1.0, 1.7] {
        settings.sampling.slab = slab;
        settings.cuts = Clipping::default();
        settings.cuts.crop =
            CropBox { on: true, low: [0.0, 0.0, grid_share_of_block(0.3)], ..CropBox::default() };
        close(opacity(&settings), 32.0 * 0.7);
        settings.cuts.crop.high[2] = grid_share_of_block(0.42);
        close(opacity(&settings), 32.0 * 0.12);
        // Thinner than a slab.
        settings.cuts.crop.high[2] = grid_share_of_block(0.31);
        close(opacity(&settings), 32.0 * 0.01);
        // There are 24 voxels to a scene unit. The middle pixel looks through its centre.
        settings.cuts.plane =
            ClipPlane { on: true, normal: [0.0, 0.0, 3.0], offset: 0.25, ..Default::default() };
        settings.cuts.crop.on = false;
        close(opacity(&settings), 16.0 + 6.0);
        settings.cuts.plane.normal = [0.0, 0.0, -1.0];
        close(opacity(&settings), 16.0 + 6.0);
        settings.cuts.plane.offset = -1.5;
        close(opacity(&settings), 0.0);
        settings.cuts.plane.offset = 1.5;
        close(opacity(&settings), 32.0);
    }
}

/// Removed material does not attenuate light; hidden material does. The light comes from the eye.
#[test]
fn effects_tell_eye_and_light_apart() {
    let (loaded, mut settings) = block();
    let mut renderer = new_renderer();
    settings.cuts.crop = CropBox { on: true, high: [1.0, 1.0, 0.5], ..CropBox::default() };
    let mut with = |effect: ClipEffect| {
        settings.cuts.crop.effect = effect;
        center_alpha_and_red(&mut renderer, &loaded, &settings)
    };
    let (removed, hidden, shadowless) =
        (with(ClipEffect::Removed), with(ClipEffect::Hidden), with(ClipEffect::Shadowless));
    // 16 voxels halve the light; half of it remains in each case but the last.
    assert!(
        (removed.0 - 0.5).abs() < CUT_LIGHT && (hidden.0 - 0.5).abs() < CUT_LIGHT,
        "{removed:?} {hidden:?}"
    );
    assert!((shadowless.0 - 0.75).abs() < CUT_LIGHT, "{shadowless:?}");
    // Below the face a voxel's worth of material lets light pass.
    let wanted = 0.5 * 2.0_f64.powf(-1.0 / 16.0);
    assert!((hidden.1 / removed.1 - wanted).abs() < CUT_LIGHT, "{removed:?} {hidden:?}, wanted {wanted}");
    assert!(shadowless.1 > removed.1, "the front is seen in full light: {removed:?} {shadowless:?}");
}

#[test]
fn cuts_of_nothing_change_no_bit() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut settings = scenes::look();
    let shown = |settings: &Settings| {
        let mut renderer = new_renderer();
        render(&mut renderer, &loaded, settings, SIZE).linear
    };
    let before = shown(&settings);
    settings.cuts.crop = CropBox { on: true, ..CropBox::default() };
    assert!(shown(&settings) == before, "a box around everything");
    settings.cuts.plane = ClipPlane { on: true, offset: 2.0, ..ClipPlane::default() };
    // A compiler adds the steps of near-field rays in another order when each has a factor of 1.
    compare(
        "a plane beyond everything",
        &channels_f32(&shown(&settings)),
        &channels_f32(&before),
        SUMMATION_ORDER,
    )
    .unwrap_or_else(|err| panic!("{err}"));
    settings.shadows.near_field = NearFieldRay::Off;
    let cut = shown(&settings);
    settings.cuts = Clipping::default();
    assert!(shown(&settings) == cut, "a plane beyond everything, without rays nearby");
    settings.cuts.plane.on = true;
    settings.cuts.plane.offset = 0.2;
    assert!(shown(&settings) != cut);
}

#[test]
fn the_light_is_kept_while_only_the_eye_is_concerned() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut settings = look(ClipEffect::Hidden, ClipEffect::Hidden);
    let mut renderer = new_renderer();
    let mut rebuilds = |settings: &Settings| {
        render(&mut renderer, &loaded, settings, SIZE);
        renderer.light_rebuilds()[0]
    };
    assert_eq!(rebuilds(&settings), 1);
    settings.cuts.plane.offset += 0.1;
    settings.cuts.crop.low[0] += 0.1;
    assert_eq!(rebuilds(&settings), 1);
    settings.cuts.plane.effect = ClipEffect::Removed;
    assert_eq!(rebuilds(&settings), 2);
    settings.cuts.crop.low[0] += 0.1;
    assert_eq!(rebuilds(&settings), 2);
}

/// Volume-aligned sheets and single footprints are summed differently; they must be cut at the same place.
#[test]
fn historical_orders_are_cut_too() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut settings = look(ClipEffect::Removed, ClipEffect::Removed);
    settings.sampling.engine = RenderEngine::Scatter;
    let mut renderer = new_renderer();
    let mut alpha = |order: SheetOrder, cut: bool| {
        settings.sampling.order = order;
        (settings.cuts.crop.on, settings.cuts.plane.on) = (cut, cut);
        let picture = render(&mut renderer, &loaded, &settings, SIZE);
        picture.linear.iter().map(|texel| f64::from(texel[3])).sum::<f64>()
    };
    let share = alpha(SheetOrder::ImageAligned, true) / alpha(SheetOrder::ImageAligned, false);
    assert!(share < 0.8, "much is cut away: {share} remains");
    for order in [SheetOrder::VolumeAligned, SheetOrder::EveryFootprint] {
        let found = alpha(order, true) / alpha(order, false);
        assert!((found - share).abs() < CUT_ORDERS, "{order:?}: {found} remains, not {share}");
    }
}

#[test]
fn combined_lights_know_the_faces() {
    let loaded = Dataset::new(scenes::creature(32, DVec3::ONE));
    let mut settings = look(ClipEffect::Removed, ClipEffect::Removed);
    settings.shading.specular = 0.0;
    let mut renderer = new_renderer();
    let mut shown = |storage: LightStorage, settings: &mut Settings| {
        settings.shadows.storage = storage;
        channels_f32(&render(&mut renderer, &loaded, settings, SIZE).linear)
    };
    for offset in [0.17, 0.3] {
        settings.cuts.plane.offset = offset;
        let kept = shown(LightStorage::PerLight, &mut settings);
        let combined = shown(LightStorage::Combined, &mut settings);
        compare("combined", &combined, &kept, CUT_COMBINED).expect("nearly the same");
    }
}
