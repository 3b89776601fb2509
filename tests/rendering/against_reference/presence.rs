//! Presence against the reference: no material outside the grid, nor where voxels are missing.

use chiaroscuro_scene::{
    Camera, ClassificationOrder, ClipEffect, ControlPoint, CropBox, GradientSource, LightGeometry, LightLock,
    NearFieldRay, OpacityInterpolation, ReconstructionKernel, RenderEngine, Settings, ShadowAlgorithm,
    SlabQuadrature, TransferFunction,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use super::{check_volume, round_to_f16};
use crate::scenes;

/// Waves from −1 to 1 that reach all faces, as 8-bit values; or as floats of which those in a ball, and some others,
/// are missing.
pub(super) fn waves(n: usize, spacing_mm: DVec3, has_missing: bool) -> Volume {
    let value = |at: usize| {
        let p = DVec3::new((at % n) as f64, (at / n % n) as f64, (at / n / n) as f64) / n as f64;
        (9.0 * p.x + 3.0 * p.y).sin() * (7.0 * p.y - 2.0 * p.z).cos() * (5.0 * p.z + 4.0 * p.x * p.y).cos()
    };
    // Eight bits, so that both engines store the same values.
    let step = |at: usize| (127.5 + 127.5 * value(at)).round();
    if !has_missing {
        let values = (0..n * n * n).map(|at| step(at) as u8).collect();
        return Volume::with_spacing("waves", [n; 3], spacing_mm, Samples::U8(values)).expect("a volume");
    }
    let is_missing = |at: usize| {
        let p = DVec3::new((at % n) as f64, (at / n % n) as f64, (at / n / n) as f64) / n as f64;
        p.distance(DVec3::new(0.6, 0.3, 0.7)) < 0.25 || at.is_multiple_of(97)
    };
    let values = (0..n * n * n).map(|at| if is_missing(at) { f32::NAN } else { step(at) as f32 }).collect();
    Volume::with_spacing("waves", [n; 3], spacing_mm, Samples::F32(values)).expect("a volume")
}

/// First slice of the waves, thinner than a kernel.
pub(super) fn thin_waves() -> Volume {
    let Samples::U8(values) = waves(20, DVec3::ONE, false).samples().clone() else { panic!("eight bits") };
    let thin = Samples::U8(values[..20 * 20].to_vec());
    Volume::with_spacing("thin waves", [20, 20, 1], DVec3::ONE, thin).expect("a volume")
}

/// Look that shows both lobes of a signed field, and nothing between them: the lowest value is opaque.
pub(super) fn two_lobes() -> Settings {
    let point = |value, color, opacity| ControlPoint::new(value, color, opacity);
    let transfer = TransferFunction {
        points: vec![
            point(0.0, [0.2, 0.4, 0.9], 0.6),
            point(60.0, [0.5, 0.6, 0.9], 0.3),
            point(100.0, [0.9, 0.9, 0.9], 0.0),
            point(150.0, [0.9, 0.9, 0.9], 0.0),
            point(200.0, [0.9, 0.6, 0.5], 0.3),
            point(255.0, [0.9, 0.3, 0.2], 0.6),
        ],
        interpolation: OpacityInterpolation::Opacity,
        ..TransferFunction::default()
    };
    scenes::look().with_transfer(transfer)
}

fn gathering_look() -> Settings {
    two_lobes()
}

fn scattering_look() -> Settings {
    let mut settings = two_lobes();
    settings.sampling.engine = RenderEngine::Scatter;
    settings
}

#[test]
fn waves_end_with_the_grid() {
    check_volume("waves", waves(20, DVec3::ONE, false), &gathering_look(), Some(round_to_f16));
    check_volume("thin waves", thin_waves(), &gathering_look(), Some(round_to_f16));
    let mut settings = gathering_look();
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.6, -1.2, 2.2])];
    settings.sampling.kernel = ReconstructionKernel::Gaussian { sigma: 0.6 };
    settings.shadows.kernel = ReconstructionKernel::Prefiltered;
    settings.sampling.quadrature = SlabQuadrature::Two;
    let spacing_mm = DVec3::new(1.0, 0.8, 1.6);
    check_volume("waves, kernels", waves(18, spacing_mm, false), &settings, Some(round_to_f16));
    settings.cuts.crop =
        CropBox { on: true, low: [0.3, 0.0, 0.0], high: [1.0, 0.6, 1.0], effect: ClipEffect::Removed };
    settings.sampling.gradients = GradientSource::Kernel;
    settings.sampling.kernel = ReconstructionKernel::BSpline;
    check_volume("waves, cut", waves(18, DVec3::ONE, false), &settings, Some(round_to_f16));
}

#[test]
fn waves_end_with_the_grid_where_kernels_are_stretched() {
    let mut settings = gathering_look();
    settings.camera.distance = 9.0;
    settings.shadows.near_field = NearFieldRay::Long;
    check_volume("waves, stretched", waves(20, DVec3::ONE, false), &settings, Some(round_to_f16));
    settings.sampling.classification = ClassificationOrder::Pre;
    check_volume("waves, classified", waves(20, DVec3::ONE, false), &settings, Some(round_to_f16));
}

#[test]
fn waves_end_with_the_grid_for_rays() {
    let mut settings = gathering_look();
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    check_volume("waves, rays", waves(14, DVec3::ONE, false), &settings, Some(round_to_f16));
    settings.shadows.algorithm = ShadowAlgorithm::Direct;
    check_volume("waves, direct", waves(12, DVec3::ONE, false), &settings, Some(round_to_f16));
}

#[test]
fn scattered_waves_end_with_the_grid() {
    check_volume("scattered waves", waves(18, DVec3::ONE, false), &scattering_look(), None);
    let mut settings = scattering_look();
    settings.lights = vec![scenes::light(LightGeometry::Perspective, [1.9, -1.4, 2.0])];
    settings.sampling.gradients = GradientSource::Sheets;
    settings.sampling.quadrature = SlabQuadrature::Two;
    settings.shadows.kernel = ReconstructionKernel::Prefiltered;
    check_volume("scattered waves, kernels", waves(18, DVec3::new(1.0, 1.2, 1.6), false), &settings, None);
    settings.sampling.classification = ClassificationOrder::Pre;
    check_volume("scattered waves, classified", waves(18, DVec3::ONE, false), &settings, None);
}

#[test]
fn waves_have_holes() {
    check_volume("holes", waves(20, DVec3::ONE, true), &gathering_look(), None);
    let mut settings = gathering_look();
    settings.camera.distance = 9.0;
    settings.shadows.near_field = NearFieldRay::Short;
    settings.shadows.kernel = ReconstructionKernel::Prefiltered;
    check_volume("holes, stretched", waves(18, DVec3::new(1.0, 0.8, 1.6), true), &settings, None);
    settings.sampling.classification = ClassificationOrder::Pre;
    check_volume("holes, classified", waves(18, DVec3::ONE, true), &settings, None);
    settings = gathering_look();
    settings.shadows.algorithm = ShadowAlgorithm::Raycast;
    check_volume("holes, rays", waves(14, DVec3::ONE, true), &settings, None);
}

#[test]
fn scattered_waves_have_holes() {
    check_volume("scattered holes", waves(18, DVec3::ONE, true), &scattering_look(), None);
    let mut settings = scattering_look();
    settings.camera = Camera { distance: 9.0, ..settings.camera };
    settings.lights[0].lock = LightLock::Scene;
    check_volume("scattered holes, stretched", waves(18, DVec3::ONE, true), &settings, None);
    settings = scattering_look();
    settings.sampling.classification = ClassificationOrder::Pre;
    check_volume("scattered holes, classified", waves(18, DVec3::ONE, true), &settings, None);
}
