//! Mutation tests: deliberate mistakes in a shader or in the reference, each of which the comparison must detect.

use chiaroscuro_reference::{Reference, ReferenceFault, ReferenceOptions};
use chiaroscuro_render::ShaderLibrary;
use chiaroscuro_scene::{
    Camera, ControlPoint, GradientSource, LightGeometry, ReconstructionKernel, RenderEngine, Settings,
    ShadowAlgorithm, SlabMode,
};
use chiaroscuro_volume::Volume;
use glam::DVec3;

use super::presence::{thin_waves, two_lobes, waves};
use crate::common::{Dataset, damaged_renderer, full_attenuation, render};
use crate::compare::{channels_f32, channels_f64, compare, to_f64};
use crate::scenes;
use crate::thresholds::SAME_WEIGHTS;

const SIZE: [u32; 2] = [64, 64];

/// Look in which every mistake is visible: steep opacities, a wide angle, a near light, highlights, a kernel whose
/// weights do not sum to one.
pub(super) fn look() -> Settings {
    let mut settings = scenes::look();
    settings.camera = Camera { distance: 2.2, fov_y_deg: 80.0, ..settings.camera };
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.4, -1.1, 1.8])];
    settings.layer_mut().transfer = scenes::linear_extinction(0.6);
    settings.sampling.kernel = ReconstructionKernel::Gaussian { sigma: 0.6 };
    settings.shadows.kernel = ReconstructionKernel::Gaussian { sigma: 0.6 };
    settings.shading.specular = 0.8;
    settings
}

/// Returns true if light volume and picture of a damaged GPU path differ from those of a damaged reference.
fn differs(from: &str, to: &str, fault: ReferenceFault) -> bool {
    differs_with_engine(RenderEngine::Gather, from, to, fault)
}

/// Compares a damaged GPU path with a damaged reference, for one of the engines.
pub(super) fn differs_with_engine(engine: RenderEngine, from: &str, to: &str, fault: ReferenceFault) -> bool {
    let mut settings = look();
    settings.sampling.engine = engine;
    differs_in_look(&settings, if engine == RenderEngine::Scatter { 28 } else { 40 }, from, to, fault)
}

/// Compares a damaged GPU path with a damaged reference, for a given look and a creature of n³ voxels.
pub(super) fn differs_in_look(
    settings: &Settings,
    n: usize,
    from: &str,
    to: &str,
    fault: ReferenceFault,
) -> bool {
    differs_in_volume(scenes::creature(n, DVec3::ONE), settings, from, to, fault)
}

/// Compares a damaged GPU path with a damaged reference, for a given look and volume.
pub(super) fn differs_in_volume(
    volume: Volume,
    settings: &Settings,
    from: &str,
    to: &str,
    fault: ReferenceFault,
) -> bool {
    let loaded = Dataset::new(volume);
    let rounding: fn(f32) -> f32 = |value| half::f16::from_f32(value).to_f32();
    let options = ReferenceOptions { fault, rounding: Some(rounding), ..ReferenceOptions::default() };
    let drawn = settings.resolved_for(loaded.volume());
    differs_with(&loaded, settings, &Reference::new(loaded.volume(), &drawn, options), (from, to))
}

/// Compares a damaged GPU path with a reference of a dataset.
pub(super) fn differs_with(
    loaded: &Dataset,
    settings: &Settings,
    reference: &Reference<'_>,
    (from, to): (&str, &str),
) -> bool {
    let mut renderer = damaged_renderer(from, to);
    let expected = reference.attenuations();
    let found = full_attenuation(&mut renderer, loaded, settings, 0);
    let values = &expected[0].as_ref().expect("the light casts shadows").values;
    let light = compare("light volume", &to_f64(&found), values, SAME_WEIGHTS);
    let found = render(&mut renderer, loaded, settings, SIZE);
    let picture = compare(
        "picture",
        &channels_f32(&found.linear),
        &channels_f64(&reference.picture(SIZE, &expected)),
        SAME_WEIGHTS,
    );
    [&light, &picture]
        .into_iter()
        .filter_map(|result| result.as_ref().err())
        .for_each(|err| println!("{err}"));
    light.is_err() || picture.is_err()
}

/// Fails if a mutation's text is not in its shader: a replacement of missing text proves nothing.
pub(crate) fn assert_in_shader(shader: &str, from: &str) {
    let source = ShaderLibrary::source(shader, wgpu::TextureFormat::R16Float, wgpu::TextureFormat::R16Float)
        .expect("the shader is there");
    assert!(source.contains(from), "{shader} no longer contains {from:?}");
}

#[test]
fn undamaged_sides_agree() {
    assert!(!differs("\u{0}", "", ReferenceFault::None));
}

macro_rules! gpu_mutation {
    ($name:ident, $shader:literal, $from:literal, $to:literal) => {
        #[test]
        fn $name() {
            assert_in_shader($shader, $from);
            assert!(differs($from, $to, ReferenceFault::None), "the comparison does not notice");
        }
    };
}

#[test]
fn rays_that_end_a_step_before_the_light() {
    let (from, to) = ("depth += ray_extinction(frame, ray, 0.0) * share * frame.slab * scale;", "");
    assert_in_shader("light/raycast.wgsl", from);
    let mut settings = look();
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    settings.lights[0].position = [0.11, -0.12, 0.2];
    assert!(!differs_in_look(&settings, 40, "\u{0}", "", ReferenceFault::None));
    assert!(differs_in_look(&settings, 40, from, to, ReferenceFault::None), "the comparison does not notice");
}

/// Look of the paper, with light splatted back by the kernel of the light pass, whose sums differ from 1 more than a
/// tent's.
fn paper_look() -> Settings {
    let mut settings = look();
    scenes::use_paper_shadows(&mut settings);
    settings
}

#[test]
fn gpu_weights_not_divided() {
    let (from, to) = ("sum / weights", "sum");
    assert_in_shader("light/backproject.wgsl", from);
    assert!(
        differs_in_look(&paper_look(), 40, from, to, ReferenceFault::None),
        "the comparison does not notice"
    );
}

#[test]
fn reference_weights_not_divided() {
    assert!(
        differs_in_look(&paper_look(), 40, "\u{0}", "", ReferenceFault::NoDivision),
        "the comparison does not notice"
    );
}

/// Material that continues behind the faces of the grid, and through missing voxels; normals that ignore these faces.
#[test]
fn ignored_faces_are_detected() {
    let presence = "return presence_at(ray.origin + ray.direction * depth, kernel_level(frame, depth));";
    let faces = "let faces = face_gradient(eye.face_cut, p, level);";
    let holes = "+ rising;";
    let look = two_lobes();
    for (has_missing, from, to) in [
        (false, presence, "return 1.0;"),
        (true, presence, "return 1.0;"),
        (false, faces, "let faces = vec3f(0.0);"),
        (true, holes, ";"),
    ] {
        let volume = waves(20, DVec3::ONE, has_missing);
        assert!(
            differs_in_volume(volume, &look, from, to, ReferenceFault::None),
            "the comparison does not notice {to:?} for {from:?}"
        );
    }
    // Two faces within the radius of one kernel, of which only one is tested.
    let both = "max(axis_presence(before / width) + axis_presence(behind / width) - 1.0, vec3f(0.0))";
    for (from, is_noticed) in [(both, true), ("\u{0}", false)] {
        let nearer = "axis_presence(min(before, behind) / width)";
        assert_eq!(differs_in_volume(thin_waves(), &look, from, nearer, ReferenceFault::None), is_noticed);
    }
    for has_missing in [false, true] {
        assert!(!differs_in_volume(
            waves(20, DVec3::ONE, has_missing),
            &look,
            "\u{0}",
            "",
            ReferenceFault::None
        ));
    }
}

/// Look with opacity that rises with density and falls again, so that surfaces have two sides; with a distant light,
/// whose sheets have the resolution of voxels.
fn sided_look() -> Settings {
    let point = |value, opacity| ControlPoint::new(value, [0.9, 0.7, 0.5], opacity);
    let mut settings = look();
    settings.layer_mut().transfer.points =
        vec![point(0.0, 0.0), point(40.0, 0.0), point(90.0, 0.5), point(160.0, 0.05)];
    settings.lights = vec![scenes::light(LightGeometry::Parallel, [1.4, -1.1, 1.8])];
    settings.lights[0].density_scale = 0.6;
    settings
}

#[test]
fn undamaged_sides_of_surfaces_agree() {
    assert!(!differs_in_look(&sided_look(), 40, "\u{0}", "", ReferenceFault::None));
}

macro_rules! sided_mutation {
    ($name:ident, $shader:literal, $from:literal, $to:literal) => {
        #[test]
        fn $name() {
            assert_in_shader($shader, $from);
            assert!(
                differs_in_look(&sided_look(), 40, $from, $to, ReferenceFault::None),
                "the comparison does not notice"
            );
        }
    };
}

sided_mutation!(
    light_on_the_wrong_side,
    "eye/eye_pass.wgsl",
    "outer * max(risen.facing, 0.0)",
    "outer * max(-risen.facing, 0.0)"
);
sided_mutation!(
    highlights_on_the_wrong_side,
    "eye/eye_pass.wgsl",
    "select(1.0, -1.0, ONE_SIDED && surface.side < 0.0)",
    "1.0"
);
sided_mutation!(
    rays_nearby_that_begin_without_a_bend,
    "eye/eye_pass.wgsl",
    "0.4375 * own + 0.625 * end - 0.0625 * behind",
    "own"
);
sided_mutation!(
    rays_nearby_through_the_eyes_material,
    "eye/eye_pass.wgsl",
    "exp(-depth * light.extinction_scale)",
    "exp(-depth)"
);
sided_mutation!(
    light_looked_up_where_rays_end,
    "eye/eye_pass.wgsl",
    "select(0.0, light.last_step_extension, step + 1u == light.near_steps)",
    "0.0"
);
sided_mutation!(
    tent_the_wrong_way_round,
    "light/backproject.wgsl",
    "vec4f(0.0, 1.0 - f.z, f.z, 0.0)",
    "vec4f(0.0, f.z, 1.0 - f.z, 0.0)"
);

#[test]
fn damaged_gradients_are_noticed() {
    let mut settings = scenes::look();
    let damages = [
        // Plain central differences.
        (GradientSource::Volume, "volume/gradients.wgsl", "(8.0 * near - far) / 12.0", "0.5 * near"),
        (GradientSource::Kernel, "eye/eye_pass.wgsl", "g * (2.0 - 1.5 * g)", "g * (2.0 - 1.4 * g)"),
        (
            GradientSource::Kernel,
            "eye/eye_pass.wgsl",
            "weighted_sum(cell, wx, wy, kernel_derivatives(f.z))",
            "0.0",
        ),
    ];
    for (gradients, shader, from, to) in damages {
        settings.sampling.gradients = gradients;
        assert_in_shader(shader, from);
        assert!(!differs_in_look(&settings, 40, "\u{0}", "", ReferenceFault::None));
        assert!(
            differs_in_look(&settings, 40, from, to, ReferenceFault::None),
            "the comparison does not notice {to:?}"
        );
    }
}

/// Look with slabs by need, which are subdivided adaptively.
fn look_by_need() -> Settings {
    let mut settings = look();
    settings.sampling.slabs = SlabMode::ByNeed;
    settings
}

#[test]
fn undamaged_slabs_by_need_agree() {
    assert!(!differs_in_look(&look_by_need(), 40, "\u{0}", "", ReferenceFault::None));
}

#[test]
fn damaged_slabs_by_need_are_noticed() {
    let damages = [
        // Half of the material between two faces.
        ("let present = 0.5 * length", "let present = 0.25 * length"),
        // Light in front of a segment for all of it.
        ("let x = tau + log(near / far)", "let x = tau"),
        // Normals in front of a segment for all of it.
        ("mix(a.slope, b.slope, at)", "a.slope"),
        // Segments that do not hide what lies behind them.
        ("color += t * sum.opacity *", "color += sum.opacity *"),
    ];
    for (from, to) in damages {
        assert_in_shader("eye/eye_pass.wgsl", from);
        assert!(
            differs_in_look(&look_by_need(), 40, from, to, ReferenceFault::None),
            "the comparison does not notice {to:?}"
        );
    }
}

gpu_mutation!(
    gpu_kernel_five_percent_wider,
    "eye/eye_pass.wgsl",
    "(-0.5 / (SIGMA * SIGMA))",
    "(-0.5 / (1.1025 * SIGMA * SIGMA))"
);
gpu_mutation!(
    gpu_transmittance_behind_the_slab,
    "light/march.wgsl",
    "select(t * slab_mean_transmittance(tau), t, DEPOSIT_FRONT)",
    "t * exp(-tau)"
);
gpu_mutation!(
    gpu_no_obliquity_for_the_eye,
    "eye/eye_pass.wgsl",
    "eye.frame.slab * ray.obliquity",
    "eye.frame.slab"
);
gpu_mutation!(
    gpu_no_obliquity_for_the_light,
    "light/march.wgsl",
    "march.frame.slab * ray.obliquity",
    "march.frame.slab"
);
gpu_mutation!(
    gpu_normals_flipped,
    "eye/eye_pass.wgsl",
    "slope * (-1.0 / max(steepness, 1e-9))",
    "slope * (1.0 / max(steepness, 1e-9))"
);
gpu_mutation!(
    gpu_kernel_shifted_by_half_a_voxel,
    "eye/eye_pass.wgsl",
    "let b = (cell + vec3f(wx.w, wy.w, wz.w) / high + 2.5)",
    "let b = (cell + vec3f(wx.w, wy.w, wz.w) / high + 3.0)"
);

macro_rules! reference_mutation {
    ($name:ident, $fault:expr) => {
        #[test]
        fn $name() {
            assert!(differs("\u{0}", "", $fault), "the comparison does not notice");
        }
    };
}

reference_mutation!(reference_kernel_five_percent_wider, ReferenceFault::WiderKernel);
reference_mutation!(reference_transmittance_behind_the_slab, ReferenceFault::DepositAfter);
reference_mutation!(reference_no_obliquity, ReferenceFault::NoObliquity);
reference_mutation!(reference_normals_flipped, ReferenceFault::FlippedNormal);
reference_mutation!(reference_kernel_shifted_by_half_a_voxel, ReferenceFault::ShiftedKernel);
