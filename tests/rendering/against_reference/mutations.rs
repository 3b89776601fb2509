//! Mutation tests: deliberate mistakes in a shader or in the reference, each of which the comparison must detect.

use chiaroscuro::data::Volume;
use chiaroscuro::gpu::ShaderLibrary;
use chiaroscuro::model::{
    Camera, ControlPoint, Engine, Gradients, Kernel, LightKind, Settings, ShadowAlgorithm, Slabs,
};
use chiaroscuro::reference::{Fault, Options, Reference};
use glam::DVec3;

use super::presence::{thin_waves, two_lobes, waves};
use crate::common::{Dataset, attenuation, damaged, render};
use crate::compare::{compare, flat32, flat64, wide};
use crate::scenes;
use crate::thresholds::SAME_WEIGHTS;

const SIZE: [u32; 2] = [64, 64];

/// Look in which every mistake is visible: steep opacities, a wide angle, a near light, highlights, a kernel whose
/// weights do not sum to one.
fn look() -> Settings {
    let mut settings = scenes::look();
    settings.camera = Camera { distance: 2.2, fov_y_deg: 80.0, ..settings.camera };
    settings.lights = vec![scenes::light(LightKind::Perspective, [1.4, -1.1, 1.8])];
    settings.transfer = scenes::linear_extinction(0.6);
    settings.sampling.kernel = Kernel::Gaussian { sigma: 0.6 };
    settings.shadows.kernel = Kernel::Gaussian { sigma: 0.6 };
    settings.shading.specular = 0.8;
    settings
}

/// Returns true if light volume and picture of a damaged GPU path differ from those of a damaged reference.
fn disagree(from: &str, to: &str, fault: Fault) -> bool {
    disagree_with(Engine::Gather, from, to, fault)
}

/// Compares a damaged GPU path with a damaged reference, for one of the engines.
fn disagree_with(engine: Engine, from: &str, to: &str, fault: Fault) -> bool {
    let mut settings = look();
    settings.sampling.engine = engine;
    disagree_in(&settings, if engine == Engine::Scatter { 28 } else { 40 }, from, to, fault)
}

/// Compares a damaged GPU path with a damaged reference, for a given look and a creature of n³ voxels.
pub(super) fn disagree_in(settings: &Settings, n: usize, from: &str, to: &str, fault: Fault) -> bool {
    disagree_about(scenes::creature(n, DVec3::ONE), settings, from, to, fault)
}

/// Compares a damaged GPU path with a damaged reference, for a given look and volume.
fn disagree_about(volume: Volume, settings: &Settings, from: &str, to: &str, fault: Fault) -> bool {
    let loaded = Dataset::new(volume);
    let mut renderer = damaged(from, to);
    let rounding: fn(f32) -> f32 = |value| half::f16::from_f32(value).to_f32();
    let options = Options { fault, rounding: Some(rounding), ..Options::default() };
    let reference = Reference::new(loaded.volume(), settings, options);
    let expected = reference.attenuations();
    let found = attenuation(&mut renderer, &loaded, settings, 0);
    let values = &expected[0].as_ref().expect("the light casts shadows").values;
    let light = compare("light volume", &wide(&found), values, SAME_WEIGHTS);
    let found = render(&mut renderer, &loaded, settings, SIZE);
    let picture =
        compare("picture", &flat32(&found.light), &flat64(&reference.picture(SIZE, &expected)), SAME_WEIGHTS);
    light.is_err() || picture.is_err()
}

/// Fails if a mutation's text is not in its shader: a replacement of missing text proves nothing.
pub(crate) fn in_shader(shader: &str, from: &str) {
    let source = ShaderLibrary::source(shader, wgpu::TextureFormat::R16Float, wgpu::TextureFormat::R16Float)
        .expect("the shader is there");
    assert!(source.contains(from), "{shader} no longer contains {from:?}");
}

#[test]
fn undamaged_sides_agree() {
    assert!(!disagree("\u{0}", "", Fault::None));
}

macro_rules! gpu_mutation {
    ($name:ident, $shader:literal, $from:literal, $to:literal) => {
        #[test]
        fn $name() {
            in_shader($shader, $from);
            assert!(disagree($from, $to, Fault::None), "the comparison does not notice");
        }
    };
}

#[test]
fn rays_that_end_a_step_before_the_light() {
    let (from, to) = ("depth += ray_extinction(frame, ray, 0.0) * share * frame.slab * scale;", "");
    in_shader("light/raycast.wgsl", from);
    let mut settings = look();
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    settings.lights[0].position = [0.11, -0.12, 0.2];
    assert!(!disagree_in(&settings, 40, "\u{0}", "", Fault::None));
    assert!(disagree_in(&settings, 40, from, to, Fault::None), "the comparison does not notice");
}

/// Look of the paper, with light splatted back by the kernel of the light pass, whose sums differ from 1 more than a
/// tent's.
fn paper_look() -> Settings {
    let mut settings = look();
    scenes::paper(&mut settings);
    settings
}

#[test]
fn gpu_weights_not_divided() {
    let (from, to) = ("sum / weights", "sum");
    in_shader("light/backproject.wgsl", from);
    assert!(disagree_in(&paper_look(), 40, from, to, Fault::None), "the comparison does not notice");
}

#[test]
fn reference_weights_not_divided() {
    assert!(disagree_in(&paper_look(), 40, "\u{0}", "", Fault::NoDivision), "the comparison does not notice");
}

/// Material that continues behind the faces of the grid, and through missing voxels; normals that ignore these faces.
#[test]
fn ends_of_data_that_are_not_seen() {
    let presence = "return presence_at(ray.origin + ray.direction * depth, kernel_level(frame, depth));";
    let faces = "let faces = face_gradient(eye.faces, p, level);";
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
            disagree_about(volume, &look, from, to, Fault::None),
            "the comparison does not notice {to:?} for {from:?}"
        );
    }
    // Two faces within the radius of one kernel, of which only one is tested.
    let both = "max(shares_inside(before / width) + shares_inside(behind / width) - 1.0, vec3f(0.0))";
    for (from, is_noticed) in [(both, true), ("\u{0}", false)] {
        let nearer = "shares_inside(min(before, behind) / width)";
        assert_eq!(disagree_about(thin_waves(), &look, from, nearer, Fault::None), is_noticed);
    }
    for has_missing in [false, true] {
        assert!(!disagree_about(waves(20, DVec3::ONE, has_missing), &look, "\u{0}", "", Fault::None));
    }
}

/// Look with opacity that rises with density and falls again, so that surfaces have two sides; with a distant light,
/// whose sheets have the resolution of voxels.
fn sided_look() -> Settings {
    let point = |value, opacity| ControlPoint::new(value, [0.9, 0.7, 0.5], opacity);
    let mut settings = look();
    settings.transfer.points = vec![point(0.0, 0.0), point(40.0, 0.0), point(90.0, 0.5), point(160.0, 0.05)];
    settings.lights = vec![scenes::light(LightKind::Parallel, [1.4, -1.1, 1.8])];
    settings.lights[0].density_scale = 0.6;
    settings
}

#[test]
fn undamaged_sides_of_surfaces_agree() {
    assert!(!disagree_in(&sided_look(), 40, "\u{0}", "", Fault::None));
}

macro_rules! sided_mutation {
    ($name:ident, $shader:literal, $from:literal, $to:literal) => {
        #[test]
        fn $name() {
            in_shader($shader, $from);
            assert!(
                disagree_in(&sided_look(), 40, $from, $to, Fault::None),
                "the comparison does not notice"
            );
        }
    };
}

sided_mutation!(
    light_on_the_wrong_side,
    "eye/gather.wgsl",
    "outer * max(risen.facing, 0.0)",
    "outer * max(-risen.facing, 0.0)"
);
sided_mutation!(
    highlights_on_the_wrong_side,
    "eye/gather.wgsl",
    "select(1.0, -1.0, ONE_SIDED && surface.side < 0.0)",
    "1.0"
);
sided_mutation!(
    rays_nearby_sampled_at_the_ends_of_steps,
    "eye/gather.wgsl",
    "way + 0.5 * length",
    "way + length"
);
sided_mutation!(
    rays_nearby_through_the_eyes_material,
    "eye/gather.wgsl",
    "exp(-depth * light.extinction_scale)",
    "exp(-depth)"
);
sided_mutation!(
    light_looked_up_where_rays_end,
    "eye/gather.wgsl",
    "select(0.0, light.near_ahead, step + 1u == light.near_steps)",
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
        (Gradients::Volume, "volume/gradients.wgsl", "(8.0 * near - far) / 12.0", "0.5 * near"),
        (Gradients::Kernel, "eye/gather.wgsl", "g * (2.0 - 1.5 * g)", "g * (2.0 - 1.4 * g)"),
        (Gradients::Kernel, "eye/gather.wgsl", "weighed(cell, wx, wy, kernel_slopes(f.z))", "0.0"),
    ];
    for (gradients, shader, from, to) in damages {
        settings.sampling.gradients = gradients;
        in_shader(shader, from);
        assert!(!disagree_in(&settings, 40, "\u{0}", "", Fault::None));
        assert!(disagree_in(&settings, 40, from, to, Fault::None), "the comparison does not notice {to:?}");
    }
}

/// Look with slabs by need, which are subdivided adaptively.
fn look_by_need() -> Settings {
    let mut settings = look();
    settings.sampling.slabs = Slabs::ByNeed;
    settings
}

#[test]
fn undamaged_slabs_by_need_agree() {
    assert!(!disagree_in(&look_by_need(), 40, "\u{0}", "", Fault::None));
}

#[test]
fn damaged_slabs_by_need_are_noticed() {
    let damages = [
        // As dense as thin slabs.
        ("found.material.a * f32(width)", "found.material.a"),
        // Sampled at their front.
        ("f32(start) + 0.5 * f32(width - 1)", "f32(start)"),
        // Subdivided behind occluding material.
        ("var share = t * (1.0 - exp", "var share = (1.0 - exp"),
        ("const MUCH = 0.125", "const MUCH = 0.25"),
        ("const CURVED = 1.25", "const CURVED = 0.5"),
        // Ignoring material between this sample and a denser one.
        ("found.density - change, found.density + change", "found.density, found.density"),
    ];
    for (from, to) in damages {
        in_shader("eye/gather.wgsl", from);
        assert!(
            disagree_in(&look_by_need(), 40, from, to, Fault::None),
            "the comparison does not notice {to:?}"
        );
    }
}

gpu_mutation!(
    gpu_kernel_five_percent_wider,
    "eye/gather.wgsl",
    "(-0.5 / (SIGMA * SIGMA))",
    "(-0.5 / (1.1025 * SIGMA * SIGMA))"
);
gpu_mutation!(
    gpu_transmittance_behind_the_slab,
    "light/march.wgsl",
    "select(t * slab_mean(tau), t, DEPOSIT_FRONT)",
    "t * exp(-tau)"
);
gpu_mutation!(
    gpu_no_obliquity_for_the_eye,
    "eye/gather.wgsl",
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
    "eye/gather.wgsl",
    "slope * (-1.0 / max(steepness, 1e-9))",
    "slope * (1.0 / max(steepness, 1e-9))"
);
gpu_mutation!(
    gpu_kernel_shifted_by_half_a_voxel,
    "eye/gather.wgsl",
    "let b = (cell + vec3f(wx.w, wy.w, wz.w) / high + 2.5)",
    "let b = (cell + vec3f(wx.w, wy.w, wz.w) / high + 3.0)"
);

#[test]
fn undamaged_sides_agree_when_scattered() {
    assert!(!disagree_with(Engine::Scatter, "\u{0}", "", Fault::None));
}

macro_rules! scatter_mutation {
    ($name:ident, $shader:literal, $from:literal, $to:literal) => {
        #[test]
        fn $name() {
            in_shader($shader, $from);
            let noticed = disagree_with(Engine::Scatter, $from, $to, Fault::None);
            assert!(noticed, "the comparison does not notice");
        }
    };
}

scatter_mutation!(
    scattered_kernel_five_percent_wider,
    "scatter/splat.wgsl",
    "/ (scatter.stretch * scatter.stretch);\n    if (squared >= 4.0) {\n        return 0.0;\n    }\n    let reach",
    "/ (1.1025 * scatter.stretch * scatter.stretch);\n    if (squared >= 4.0) {\n        return 0.0;\n    }\n    let reach"
);
scatter_mutation!(
    scattered_transmittance_behind_the_slab,
    "scatter/light.wgsl",
    "select(t * slab_mean(tau), t, DEPOSIT_FRONT)",
    "t * exp(-tau)"
);
scatter_mutation!(scattered_weights_not_divided, "scatter/normalise.wgsl", "/ f32(max(weight, 1))", "/ UNIT");
scatter_mutation!(
    scattered_without_obliquity_for_the_eye,
    "scatter/eye.wgsl",
    "met.thickness * ray.obliquity",
    "met.thickness"
);
scatter_mutation!(
    scattered_without_obliquity_for_the_light,
    "scatter/light.wgsl",
    "march.frame.slab * ray.obliquity",
    "march.frame.slab"
);
scatter_mutation!(
    scattered_voxels_shifted_by_half,
    "scatter/splat.wgsl",
    "let centre = vec3f(voxel);",
    "let centre = vec3f(voxel) + vec3f(0.5, 0.0, 0.0);"
);
scatter_mutation!(
    scattered_and_lit_without_rays_nearby,
    "scatter/eye.wgsl",
    "return near_light(light, volume, surface, towards);",
    "return looked_up(light, volume, biased(surface, towards));"
);
scatter_mutation!(
    scattered_with_the_gradient_flipped,
    "scatter/eye.wgsl",
    "gradient_to_scene(eye.space, volume_slope(p, level))",
    "-gradient_to_scene(eye.space, volume_slope(p, level))"
);

#[test]
fn scattered_gradient_of_sheets_flipped() {
    let from = "/ (2.0 * f32(slabs) * met.thickness)";
    in_shader("scatter/eye.wgsl", from);
    let mut settings = look();
    settings.sampling.engine = Engine::Scatter;
    settings.sampling.gradients = Gradients::Sheets;
    assert!(!disagree_in(&settings, 28, "\u{0}", "", Fault::None));
    assert!(disagree_in(&settings, 28, from, "/ (-2.0 * f32(slabs) * met.thickness)", Fault::None));
}

macro_rules! reference_mutation {
    ($name:ident, $fault:expr) => {
        #[test]
        fn $name() {
            assert!(disagree("\u{0}", "", $fault), "the comparison does not notice");
        }
    };
}

reference_mutation!(reference_kernel_five_percent_wider, Fault::WiderKernel);
reference_mutation!(reference_transmittance_behind_the_slab, Fault::DepositAfter);
reference_mutation!(reference_no_obliquity, Fault::NoObliquity);
reference_mutation!(reference_normals_flipped, Fault::FlippedNormal);
reference_mutation!(reference_kernel_shifted_by_half_a_voxel, Fault::ShiftedKernel);
