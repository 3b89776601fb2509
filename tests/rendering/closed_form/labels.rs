//! Label interpolation: label numbers are never mixed, so that there is no shell of labels 4 to 8 between labels 3
//! and 9.

use chiaroscuro_scene::{
    ClassificationOrder, ControlPoint, NearFieldRay, ReconstructionKernel, RenderEngine, Settings,
    ShadowAlgorithm, TransferFunction,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use super::{base, renderer, with_both_engines};
use crate::common::{Dataset, render};

with_both_engines! {
    labels_between_are_not_seen
}

/// Number of voxels along an edge.
const N: usize = 32;

/// Ball of label 9 within one of label 3, in empty space.
fn nested_balls() -> Dataset {
    let label = |at: usize| {
        let p = DVec3::new((at % N) as f64, (at / N % N) as f64, (at / N / N) as f64);
        match p.distance(DVec3::splat(0.5 * (N - 1) as f64)) {
            d if d < 7.0 => 9,
            d if d < 13.0 => 3,
            _ => 0,
        }
    };
    let values = (0..N * N * N).map(label).collect();
    Dataset::new(Volume::with_spacing("balls", [N; 3], DVec3::ONE, Samples::U8(values)).expect("a volume"))
}

/// Look in which label 3 is blue and faint, label 9 red, and all others green.
fn look(engine: RenderEngine) -> Settings {
    let steps = [
        (0.5, [0.0, 1.0, 0.0], 0.0),
        (2.5, [0.0, 1.0, 0.0], 0.9),
        (3.5, [0.0, 0.0, 1.0], 0.05),
        (8.5, [0.0, 1.0, 0.0], 0.9),
        (9.5, [1.0, 0.0, 0.0], 0.6),
    ];
    let mut from = -0.5;
    let mut points = Vec::new();
    for (to, color, opacity) in steps {
        points.extend([from + 1e-3, to - 1e-3].map(|value| ControlPoint::new(value, color, opacity)));
        from = to;
    }
    let transfer = TransferFunction { points, ..TransferFunction::default() };
    let mut settings = base(engine, 0.1).with_transfer(transfer);
    settings.sampling.classification = ClassificationOrder::Pre;
    settings.shading.specular = 0.0;
    settings
}

fn labels_between_are_not_seen(engine: RenderEngine) {
    let loaded = nested_balls();
    let mut renderer = renderer();
    let mut brightest = |settings: &Settings| {
        let picture = render(&mut renderer, &loaded, settings, [72, 72]);
        let most = |channel: usize| picture.linear.iter().map(|texel| texel[channel]).fold(0.0, f32::max);
        [0, 1, 2].map(most)
    };
    for kernel in [ReconstructionKernel::BSpline, ReconstructionKernel::Prefiltered] {
        for distance in [3.0, 16.0] {
            let mut settings = look(engine);
            settings.sampling.kernel = kernel;
            settings.camera.distance = distance;
            let [red, green, blue] = brightest(&settings);
            assert!(red > 0.1 && blue > 0.02, "{kernel:?} from {distance}: {red} {blue}");
            assert!(green == 0.0, "{kernel:?} from {distance}: {green}");
            // Classified after interpolation, the shells appear.
            settings.sampling.classification = ClassificationOrder::Post;
            let [_, green, _] = brightest(&settings);
            assert!(green > 0.02, "{kernel:?} from {distance}: {green}");
        }
    }
    // Light meets none of them either: in its own table only green attenuates it.
    let mut settings = look(engine);
    settings.layer_mut().lighting.linked = false;
    settings.layer_mut().lighting.curve = TransferFunction {
        points: settings
            .layer()
            .transfer
            .points
            .iter()
            .map(|point| {
                let is_green = point.color[1] > 0.5;
                ControlPoint::new(point.value, [1.0; 3], if is_green { point.opacity } else { 0.0 })
            })
            .collect(),
        ..TransferFunction::default()
    };
    for near_field in [NearFieldRay::Off, NearFieldRay::Long] {
        settings.shadows.near_field = near_field;
        settings.shadows.algorithm = ShadowAlgorithm::Splat;
        let shadowed = brightest(&settings);
        settings.shadows.algorithm = ShadowAlgorithm::Off;
        let unshadowed = brightest(&settings);
        for (a, b) in shadowed.into_iter().zip(unshadowed) {
            assert!((a - b).abs() < 1e-3 * b.max(0.1), "{near_field:?}: {shadowed:?} {unshadowed:?}");
        }
    }
}
