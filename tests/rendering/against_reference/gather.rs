//! The gathering engine against the independent f64 reference: stage by stage with the same weights, and against the
//! paper's literal footprints.

use super::{SIZE, check_against, round_to_f16};
use crate::common::{Dataset, context, full_attenuation, new_renderer, render};
use crate::compare::{channels_f32, channels_f64, compare, to_f64};
use crate::scenes;
use crate::thresholds::{BYTE_STEP, BYTES, LITERAL, SAME_WEIGHTS};
use chiaroscuro_reference::{Reference, ReferenceOptions, ReferenceWeights};
use chiaroscuro_render::{Renderer, stored_density};
use chiaroscuro_scene::{
    Camera, ClassificationOrder, ClipPlane, DepositMode, FovReference, GradientSource, LightGeometry,
    LightLock, LightVolumePrecision, LightVolumeResolution, Projection, ReconstructionKernel, Settings,
    ShadowAlgorithm, SlabMode, SlabQuadrature,
};
use glam::DVec3;

/// Compares sheets, light volumes and picture of one look with the reference.
fn check(name: &str, spacing_mm: DVec3, settings: &Settings) {
    let loaded = Dataset::new(scenes::creature(8, spacing_mm));
    assert_eq!(
        stored_density(&context(), loaded.volume(), 0.3),
        round_to_f16(0.3),
        "8-bit data are stored as f16"
    );
    check_against(name, 48, spacing_mm, settings, Some(round_to_f16));
}

#[test]
fn parallel_light_and_turned_perspective_camera() {
    check("parallel", DVec3::ONE, &scenes::look());
}

#[test]
fn perspective_light_and_orthographic_camera() {
    let mut settings = scenes::look();
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.6, -1.2, 2.2])];
    settings.camera = Camera { projection: Projection::Orthographic, ..settings.camera };
    check("perspective light", DVec3::ONE, &settings);
}

#[test]
fn anisotropic_voxels() {
    let mut settings = scenes::look();
    settings.lights = vec![
        scenes::light(LightGeometry::Perspective, [-2.0, 1.2, 1.9]),
        scenes::light(LightGeometry::Parallel, [0.3, -1.0, 0.9]),
    ];
    check("anisotropic", DVec3::new(1.0, 0.8, 1.6), &settings);
}

#[test]
fn a_light_inside_the_volume() {
    let mut settings = scenes::look();
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [-0.45, -0.35, 0.4])];
    check("light inside", DVec3::ONE, &settings);
}

/// Compares slabs of a kind unchanged, with stretched kernels, and cut by a plane.
fn check_slabs(name: &str, mut settings: Settings) {
    check(name, DVec3::ONE, &settings);
    settings.sampling.slab = 1.6;
    settings.camera.distance = 9.0;
    check(&format!("{name}, stretched"), DVec3::new(1.0, 0.8, 1.6), &settings);
    settings.camera = scenes::look().camera;
    settings.cuts.plane =
        ClipPlane { on: true, normal: [0.6, -1.0, 0.7], offset: 0.17, ..ClipPlane::default() };
    check(&format!("{name}, cut"), DVec3::ONE, &settings);
}

#[test]
fn slabs_by_need() {
    let mut settings = scenes::look();
    settings.sampling.slabs = SlabMode::ByNeed;
    check_slabs("slabs by need", settings);
}

#[test]
fn preintegrated_slabs() {
    let mut settings = scenes::look();
    settings.sampling.slabs = SlabMode::Preintegrated;
    settings.sampling.kernel = ReconstructionKernel::Prefiltered;
    check_slabs("pre-integrated slabs", settings);
}

#[test]
fn gaussian_kernel_thin_slabs_two_points() {
    let mut settings = scenes::look();
    settings.sampling.kernel = ReconstructionKernel::Gaussian { sigma: 0.6 };
    settings.sampling.slab = 0.5;
    settings.sampling.quadrature = SlabQuadrature::Two;
    settings.shadows.kernel = ReconstructionKernel::Gaussian { sigma: 0.55 };
    settings.shadows.slab = 0.5;
    settings.shadows.quadrature = SlabQuadrature::Two;
    check("gaussian", DVec3::ONE, &settings);
}

#[test]
fn prefiltered_kernel_and_literal_deposit() {
    let mut settings = scenes::look();
    settings.sampling.kernel = ReconstructionKernel::Prefiltered;
    settings.shadows.kernel = ReconstructionKernel::Prefiltered;
    settings.shadows.deposit = DepositMode::Front;
    check("prefiltered", DVec3::ONE, &settings);
}

#[test]
fn first_touch() {
    let mut settings = scenes::look();
    settings.shadows.first_touch = true;
    check("first touch", DVec3::ONE, &settings);
}

#[test]
fn light_volume_at_half_resolution() {
    let mut settings = scenes::look();
    settings.shadows.resolution = LightVolumeResolution::Half;
    check("half resolution", DVec3::ONE, &settings);
}

#[test]
fn several_lights_and_every_cure_for_darkness() {
    let mut settings = scenes::look();
    settings.lights = vec![
        scenes::light(LightGeometry::Parallel, [1.3, -0.8, 1.7]),
        scenes::light(LightGeometry::Perspective, [-1.8, 1.5, 2.0]),
        scenes::light(LightGeometry::Parallel, [-0.2, -1.0, 0.3]),
    ];
    settings.lights[0].color = [1.0, 0.8, 0.5];
    settings.lights[1].intensity = 0.7;
    settings.lights[2].casts_shadows = false;
    settings.lights[2].color = [0.3, 0.5, 1.0];
    settings.shadows.ambient_offset = 0.1;
    settings.shadows.gain = 1.6;
    settings.shadows.strength = 0.85;
    settings.shadows.bias_voxels = 1.2;
    settings.shadows.balance = 1.3;
    settings.shading.specular = 0.6;
    settings.shading.emission = 0.05;
    settings.layer_mut().lighting.scale = 0.6;
    check("several lights", DVec3::ONE, &settings);
}

#[test]
fn kernels_stretched_by_small_pictures_and_near_lights() {
    let mut settings = scenes::look();
    // Distant: pixels are two to three voxels wide.
    settings.camera.distance = 14.0;
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.9, -1.5, 1.4])];
    check("stretched", DVec3::ONE, &settings);
}

#[test]
fn an_eye_inside_the_volume() {
    let mut settings = scenes::look();
    settings.camera = Camera { distance: 0.35, fov_y_deg: 70.0, target: [0.4, 0.3, 0.2], ..settings.camera };
    check("eye inside", DVec3::ONE, &settings);
}

/// A frame of 4:3 in a narrow picture, which shows more above and below.
#[test]
fn a_frame_in_a_narrow_picture() {
    let mut settings = scenes::look();
    settings.shadows.algorithm = ShadowAlgorithm::Off;
    let loaded = Dataset::new(scenes::creature(40, DVec3::ONE));
    let mut renderer = new_renderer();
    let size = [48, 128];
    for projection in [Projection::Perspective, Projection::Orthographic] {
        settings.camera = Camera { projection, fit: FovReference::Frame, ..settings.camera };
        let options = ReferenceOptions { rounding: Some(round_to_f16), ..ReferenceOptions::default() };
        let reference = Reference::new(loaded.volume(), &settings, options);
        let expected = channels_f64(&reference.picture(size, &reference.attenuations()));
        let found = channels_f32(&render(&mut renderer, &loaded, &settings, size).linear);
        compare(&format!("{projection:?}"), &found, &expected, SAME_WEIGHTS)
            .unwrap_or_else(|err| panic!("{err}"));
        // The picture differs from that of a field of view over the height.
        settings.camera.fit = FovReference::Height;
        let cut_off = channels_f32(&render(&mut renderer, &loaded, &settings, size).linear);
        assert!(compare("cut off", &cut_off, &expected, SAME_WEIGHTS).is_err(), "{projection:?}");
    }
}

/// Look with lights of both kinds, one of them close, and anisotropic voxels.
fn rays(algorithm: ShadowAlgorithm) -> Settings {
    let mut settings = scenes::look();
    settings.shadows.algorithm = algorithm;
    settings.lights = vec![
        scenes::light(LightGeometry::Parallel, [1.3, -0.8, 1.7]),
        scenes::light(LightGeometry::Perspective, [-1.1, 0.9, 1.2]),
    ];
    settings.lights[1].density_scale = 0.5;
    settings
}

#[test]
fn a_light_volume_by_rays() {
    let mut settings = rays(ShadowAlgorithm::Raycast);
    check("raycast", DVec3::ONE, &settings);
    settings.shadows.deposit = DepositMode::Front;
    settings.shadows.resolution = LightVolumeResolution::Half;
    settings.shadows.quadrature = SlabQuadrature::Two;
    check("raycast, literal", DVec3::new(1.0, 0.8, 1.6), &settings);
}

#[test]
fn rays_from_every_sample() {
    let mut settings = rays(ShadowAlgorithm::Direct);
    check("direct", DVec3::new(1.0, 0.8, 1.6), &settings);
    settings.shadows.deposit = DepositMode::Front;
    settings.shadows.bias_voxels = 0.7;
    check("direct, literal", DVec3::ONE, &settings);
}

#[test]
fn hoods_cameras_lights_and_densities() {
    for algorithm in [ShadowAlgorithm::Splat, ShadowAlgorithm::Raycast, ShadowAlgorithm::Direct] {
        let mut settings = rays(algorithm);
        settings.lights[0].kind = LightGeometry::Perspective;
        settings.lights[0].position = [-0.6, 0.4, 3.0];
        settings.lights[0].lock = LightLock::Camera;
        for light in &mut settings.lights {
            light.hood.on = true;
            light.hood.half_angle_deg = 18.0;
            light.hood.rim_deg = 6.0;
        }
        settings.shadows.ambient_offset = 0.1;
        check(&format!("hoods, {algorithm:?}"), DVec3::ONE, &settings);
    }
}

/// Compares the GPU's picture with that of the paper's literal footprints in f64.
fn check_literal(n: usize, kind: LightGeometry, position: [f64; 3]) {
    let mut settings = scenes::look();
    settings.lights = vec![scenes::light(kind, position)];
    settings.sampling.quadrature = SlabQuadrature::Two;
    settings.shadows.quadrature = SlabQuadrature::Two;
    let loaded = Dataset::new(scenes::creature(n, DVec3::ONE));
    let options = ReferenceOptions { weights: ReferenceWeights::Footprint, ..ReferenceOptions::default() };
    let reference = Reference::new(loaded.volume(), &settings, options);
    let expected = reference.picture(SIZE, &reference.attenuations());
    let mut renderer = new_renderer();
    let found = render(&mut renderer, &loaded, &settings, SIZE);
    let what = format!("literal footprints, {kind:?}, {n}³");
    compare(&what, &channels_f32(&found.linear), &channels_f64(&expected), LITERAL)
        .unwrap_or_else(|err| panic!("{err}"));
}

#[test]
fn literal_footprints_parallel() {
    check_literal(40, LightGeometry::Parallel, [1.3, -0.8, 1.7]);
}

#[test]
fn literal_footprints_perspective() {
    check_literal(40, LightGeometry::Perspective, [2.0, -1.3, 2.4]);
}

#[test]
#[ignore = "long: 128³ footprints in f64; script/test --all runs it"]
fn literal_footprints_of_a_large_volume() {
    check_literal(128, LightGeometry::Parallel, [1.3, -0.8, 1.7]);
    check_literal(128, LightGeometry::Perspective, [2.0, -1.3, 2.4]);
}

/// Gradients from neighbouring sheets: thin slabs, perspective, anisotropic voxels.
#[test]
fn gradients_from_neighbouring_sheets() {
    let mut settings = scenes::look();
    settings.sampling.gradients = GradientSource::Sheets;
    settings.sampling.slab = 0.5;
    check("gradients from sheets", DVec3::new(1.0, 1.2, 1.7), &settings);
    settings.camera.projection = Projection::Orthographic;
    settings.camera.distance = 1.2;
    check("gradients from sheets, near", DVec3::ONE, &settings);
}

/// Gradients of the kernel itself, unstretched and stretched by less than, and more than, a voxel.
#[test]
fn gradients_of_the_kernel() {
    let mut settings = scenes::look();
    settings.sampling.gradients = GradientSource::Kernel;
    check("gradients of the kernel", DVec3::new(1.0, 1.2, 1.7), &settings);
    settings.camera.distance = 7.0;
    check("gradients of the kernel, far", DVec3::ONE, &settings);
}

/// Light volumes of a byte per voxel: 256 steps, which filtering smooths.
#[test]
fn light_volumes_of_bytes() {
    let loaded = Dataset::new(scenes::creature(48, DVec3::ONE));
    let context = context();
    assert!(context.has_byte_volumes, "this adapter cannot show it");
    let mut renderer = Renderer::new(&context).expect("a renderer");
    let mut settings = scenes::look();
    let fine = full_attenuation(&mut renderer, &loaded, &settings, 0);
    let picture = render(&mut renderer, &loaded, &settings, SIZE);
    let before = renderer.gpu_bytes();
    settings.shadows.precision = LightVolumePrecision::Byte;
    let bytes = full_attenuation(&mut renderer, &loaded, &settings, 0);
    assert!(bytes.iter().all(|value| (value * 255.0).fract().abs() < BYTE_STEP), "steps of 1/255");
    compare("bytes: light volume", &to_f64(&bytes), &to_f64(&fine), BYTES)
        .unwrap_or_else(|err| panic!("{err}"));
    let found = render(&mut renderer, &loaded, &settings, SIZE);
    compare("bytes: picture", &channels_f32(&found.linear), &channels_f32(&picture.linear), BYTES)
        .unwrap_or_else(|err| panic!("{err}"));
    let voxels = loaded.volume().voxel_count() as u64;
    let added = renderer.gpu_bytes() - before;
    assert_eq!(added, voxels, "the earlier volume is kept, and this one has a byte per voxel");
}

/// Voxels are classified before the kernel spreads them, in both passes; at a distance the blurred volume is
/// classified.
#[test]
fn pre_classified_voxels() {
    let mut settings = scenes::look();
    settings.sampling.classification = ClassificationOrder::Pre;
    settings.sampling.quadrature = SlabQuadrature::Two;
    settings.shadows.kernel = ReconstructionKernel::Gaussian { sigma: 0.5 };
    check("pre-classified", DVec3::new(1.0, 1.2, 1.7), &settings);
    settings.camera.distance = 7.0;
    check("pre-classified, far", DVec3::ONE, &settings);
}
