//! Label interpolation: label numbers are never mixed, so that there is no shell of labels 4 to 8 between labels 3
//! and 9.

use chiaroscuro_scene::{
    ClassificationOrder, ControlPoint, LabelLook, LabelTable, NearFieldRay, ReconstructionKernel,
    RenderEngine, Settings, ShadowAlgorithm, TransferFunction,
};
use chiaroscuro_volume::{Samples, Volume};
use glam::DVec3;

use super::{base, renderer, with_both_engines};
use crate::common::{Dataset, render};
use crate::thresholds::MAX_CRISP_EDGE_SHARE;

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

/// Label map of an opaque cube, and of a single voxel beside it.
fn cube_and_voxel() -> Dataset {
    let label = |at: usize| {
        let voxel = [at % N, at / N % N, at / N / N];
        u8::from(voxel.iter().all(|c| (6..20).contains(c)) || voxel == [26, 16, 16])
    };
    let values = (0..N * N * N).map(label).collect();
    Dataset::new(Volume::with_spacing("cube", [N; 3], DVec3::ONE, Samples::U8(values)).expect("a volume"))
}

/// Returns the opacities along the row of pixels through the middle of the picture.
fn middle_row(classification: ClassificationOrder) -> Vec<f32> {
    const SIDE: u32 = 384;
    let mut labels = LabelTable::default();
    *labels.entry_mut(1) = LabelLook { opacity: 0.95, visible: true, ..LabelLook::default_for(1) };
    let mut settings = base(RenderEngine::Gather, 0.1).with_labels(labels);
    settings.sampling.classification = classification;
    let picture = render(&mut renderer(), &cube_and_voxel(), &settings, [SIDE; 2]);
    let row = (SIDE / 2 * SIDE) as usize;
    picture.linear[row..row + SIDE as usize].iter().map(|texel| texel[3]).collect()
}

/// Outlines of labels, which a picture that shows each voxel many pixels wide blurs most.
#[test]
fn crisp_labels_have_narrow_outlines_and_lose_no_voxel() {
    let [wide, crisp] = [ClassificationOrder::Pre, ClassificationOrder::PreCrisp].map(middle_row);
    let partly = |row: &[f32]| row.iter().filter(|alpha| (0.05..0.95).contains(*alpha)).count();
    let most = |row: &[f32]| row.iter().copied().fold(0.0, f32::max);
    assert!(most(&wide) > 0.99 && most(&crisp) > 0.99);
    // The single voxel is the last run of opacity.
    let of_voxel = |row: &[f32]| {
        let runs: Vec<&[f32]> = row.chunk_by(|a, b| (*a > 0.02) == (*b > 0.02)).collect();
        most(runs.iter().rev().find(|run| run[0] > 0.02).copied().unwrap_or_default())
    };
    let cube = |row: &[f32]| partly(row.split_at(row.len() * 2 / 3).0);
    let share = cube(&crisp) as f64 / cube(&wide) as f64;
    assert!(share <= MAX_CRISP_EDGE_SHARE, "{} of {} pixels", cube(&crisp), cube(&wide));
    assert!(of_voxel(&crisp) > 0.9 * of_voxel(&wide), "{} {}", of_voxel(&crisp), of_voxel(&wide));
}
