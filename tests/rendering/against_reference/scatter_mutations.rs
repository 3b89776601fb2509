//! Mutation tests of the scattering engine: deliberate mistakes in its shaders that the comparison must detect.

use chiaroscuro_reference::ReferenceFault;
use chiaroscuro_scene::{GradientSource, RenderEngine};

use super::mutations::{assert_in_shader, differs_in_look, differs_with_engine, look};

#[test]
fn undamaged_sides_agree_when_scattered() {
    assert!(!differs_with_engine(RenderEngine::Scatter, "\u{0}", "", ReferenceFault::None));
}

macro_rules! scatter_mutation {
    ($name:ident, $shader:literal, $from:literal, $to:literal) => {
        #[test]
        fn $name() {
            assert_in_shader($shader, $from);
            let noticed = differs_with_engine(RenderEngine::Scatter, $from, $to, ReferenceFault::None);
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
    "select(t * slab_mean_transmittance(tau), t, DEPOSIT_FRONT)",
    "t * exp(-tau)"
);
scatter_mutation!(
    scattered_weights_not_divided,
    "scatter/normalise.wgsl",
    "/ f32(max(weight, 1))",
    "/ FIXED_POINT_ONE"
);
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
    "return near_field_attenuation(light, volume, surface, towards);",
    "return lookup_attenuation(light, volume, biased_point(surface, towards));"
);
scatter_mutation!(
    scattered_with_the_gradient_flipped,
    "scatter/eye.wgsl",
    "gradient_to_scene(eye.space, volume_gradient(p, level))",
    "-gradient_to_scene(eye.space, volume_gradient(p, level))"
);

#[test]
fn scattered_gradient_of_sheets_flipped() {
    let from = "/ (2.0 * f32(slabs) * met.thickness)";
    assert_in_shader("scatter/eye.wgsl", from);
    let mut settings = look();
    settings.sampling.engine = RenderEngine::Scatter;
    settings.sampling.gradients = GradientSource::Sheets;
    assert!(!differs_in_look(&settings, 28, "\u{0}", "", ReferenceFault::None));
    assert!(differs_in_look(
        &settings,
        28,
        from,
        "/ (-2.0 * f32(slabs) * met.thickness)",
        ReferenceFault::None
    ));
}
