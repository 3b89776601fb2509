//! Presence in closed form: material ends with the grid, and where voxels are missing, whatever the transfer
//! function.

use chiaroscuro_reference::{cubic_b_spline, tent};
use chiaroscuro_scene::{
    Camera, ClassificationOrder, ClipEffect, ControlPoint, CutAction, CutShape, LightGeometry,
    OpacityInterpolation, OutlineCut, Projection, ReconstructionKernel, RenderEngine, ShapeCut,
    TransferFunction,
};
use chiaroscuro_volume::{Samples, Volume, math::SceneSpace};
use glam::DVec3;

use super::{base, renderer, with_both_engines};
use crate::common::{Dataset, full_attenuation, render};
use crate::compare::{compare, to_f64};
use crate::scenes;
use crate::thresholds::{CHORD_OPACITY, EDGE_PROFILE, LOBES};

with_both_engines! {
    a_constant_volume_ends_at_its_faces
    holes_are_empty
    hidden_slabs_are_empty
    slabs_hidden_from_eye_or_light
    lobes_of_either_sign_look_alike
}

/// Number of voxels along an edge.
const EDGE_VOXELS: usize = 24;

/// Transfer function with extinction `per_voxel` at every value.
fn constant_extinction(per_voxel: f64) -> TransferFunction {
    let point = |value| ControlPoint::new(value, [1.0; 3], 1.0 - (-per_voxel).exp());
    TransferFunction {
        points: vec![point(0.0), point(255.0)],
        interpolation: OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    }
}

/// Transfer function whose extinction falls from `per_voxel` at the lowest value to 0 at the highest.
fn falling_extinction(per_voxel: f64) -> TransferFunction {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    TransferFunction {
        points: vec![point(0.0, 1.0 - (-per_voxel).exp()), point(255.0, 0.0)],
        interpolation: OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    }
}

/// Volume of the lowest or the highest value; a voxel in a corner has the other, so that the values span a range.
fn constant_volume(value: u8) -> Dataset {
    let mut values = vec![value; EDGE_VOXELS * EDGE_VOXELS * EDGE_VOXELS];
    values[0] = 255 - value;
    Dataset::new(
        Volume::with_spacing("constant", [EDGE_VOXELS; 3], DVec3::ONE, Samples::U8(values))
            .expect("a volume"),
    )
}

/// Share of a kernel's weights on voxels 0, 1, 2 …, `depth` voxels behind the edge before voxel 0.
fn edge_profile(kernel: ReconstructionKernel, depth: f64) -> f64 {
    let weight = |away: f64| match kernel {
        // [1, 10, 1] / 12, and the tent of a linear fetch.
        ReconstructionKernel::Prefiltered => (10.0 * tent(away) + tent(away - 1.0) + tent(away + 1.0)) / 12.0,
        _ => cubic_b_spline(away),
    };
    (0..4).map(|voxel| weight(depth - 0.5 - f64::from(voxel))).sum()
}

/// Along an axis, the opacity of a constant volume is 1 − e^(−μ·n), times the kernel's edge profile beside it.
fn a_constant_volume_ends_at_its_faces(engine: RenderEngine) {
    let per_voxel = 0.04;
    for classification in [ClassificationOrder::Post, ClassificationOrder::Pre] {
        // At the lowest value, extinction is that of the transfer function.
        for (value, transfer) in [
            (0, constant_extinction(per_voxel)),
            (0, falling_extinction(per_voxel)),
            (255, constant_extinction(per_voxel)),
        ] {
            let mut settings = base(engine, per_voxel).with_transfer(transfer);
            settings.sampling.classification = classification;
            settings.sampling.slab = 0.5;
            let size = [96, 96];
            let loaded = constant_volume(value);
            let picture = render(&mut renderer(), &loaded, &settings, size);
            let scene = loaded.volume().scene();
            let middle = f64::from(picture.linear[48 * 96 + 48][3]);
            let chord = 1.0 - (-per_voxel * EDGE_VOXELS as f64).exp();
            assert!(
                (middle - chord).abs() <= CHORD_OPACITY,
                "{value} {classification:?}: {middle} not {chord}"
            );
            // Across the left face, on the middle row.
            let mut beside = 0;
            for column in 0..48 {
                let (origin, _) = settings.camera.ray_through(f64::from(column) + 0.5, 48.5, 96.0, 96.0);
                let index = scene.index_from_scene.transform_point3(origin);
                // The camera looks along y: x is across.
                let depth = (index.x + 0.5).min(EDGE_VOXELS as f64 - 0.5 - index.x);
                // Gathered voxels that are classified first are spread by the prefiltered kernel.
                let kernel = if engine == RenderEngine::Gather {
                    settings.eye_kernel()
                } else {
                    ReconstructionKernel::BSpline
                };
                let share = if depth > 1.5 { 1.0 } else { edge_profile(kernel, depth.max(-1.5)) };
                let expected = 1.0 - (-per_voxel * EDGE_VOXELS as f64 * share).exp();
                let found = f64::from(picture.linear[48 * 96 + column as usize][3]);
                assert!(
                    (found - expected).abs() <= EDGE_PROFILE,
                    "{value} {classification:?}, {depth} voxels inside: {found} not {expected}"
                );
                beside += usize::from(depth.abs() < 1.5);
            }
            assert!(beside > 4, "{beside} pixels across the edge");
        }
    }
}

/// A slab of missing voxels in a constant volume is empty.
fn holes_are_empty(engine: RenderEngine) {
    let per_voxel = 0.04;
    let values =
        (0..EDGE_VOXELS * EDGE_VOXELS * EDGE_VOXELS).map(|at| match at / EDGE_VOXELS % EDGE_VOXELS {
            _ if at == 0 => 255.0,
            8..=15 => f32::NAN,
            _ => 0.0,
        });
    let samples = Samples::F32(values.collect());
    let loaded =
        Dataset::new(Volume::with_spacing("holes", [EDGE_VOXELS; 3], DVec3::ONE, samples).expect("a volume"));
    for kernel in [ReconstructionKernel::BSpline, ReconstructionKernel::Prefiltered] {
        let mut settings = base(engine, per_voxel).with_transfer(falling_extinction(per_voxel));
        settings.sampling.kernel = kernel;
        settings.sampling.slab = 0.5;
        let picture = render(&mut renderer(), &loaded, &settings, [64, 64]);
        // The camera looks along y.
        let expected = 1.0 - (-per_voxel * (EDGE_VOXELS - 8) as f64).exp();
        let found = f64::from(picture.linear[32 * 64 + 32][3]);
        assert!((found - expected).abs() <= CHORD_OPACITY, "{kernel:?}: {found} not {expected}");
    }
}

/// Outline around voxels 8 … 15 along y, drawn from the side, with edges between voxels.
fn outlined_slab(scene: &SceneSpace) -> CutShape {
    // The camera looks along x; y is across.
    let side = Camera {
        azimuth_deg: 0.0,
        elevation_deg: 0.0,
        projection: Projection::Orthographic,
        ..Camera::default()
    };
    let place = |y: f64, z: f64| {
        let point = scene.scene_from_index.transform_point3(DVec3::new(12.0, y, z));
        let (x, y, _) = side.pixel_from_scene(point, 1.0, 1.0).expect("in front of the camera");
        [x, y]
    };
    let points = vec![place(7.5, -9.0), place(15.5, -9.0), place(15.5, 33.0), place(7.5, 33.0)];
    CutShape::Outline(OutlineCut { camera: side.clone(), aspect: 1.0, points, ..OutlineCut::default() })
}

/// A slab that is hidden from the eye alone attenuates light, and one that lets light pass is seen.
fn slabs_hidden_from_eye_or_light(engine: RenderEngine) {
    let per_voxel = 0.04;
    let loaded = constant_volume(0);
    let shape = outlined_slab(&loaded.volume().scene());
    for (effect, seen, met) in [
        (ClipEffect::Removed, EDGE_VOXELS - 8, 9),
        (ClipEffect::Hidden, EDGE_VOXELS - 8, 17),
        (ClipEffect::Shadowless, EDGE_VOXELS, 9),
    ] {
        let mut settings = base(engine, per_voxel).with_transfer(falling_extinction(per_voxel));
        settings.sampling.slab = 0.5;
        settings.lights = vec![scenes::light(LightGeometry::Parallel, [0.0, 1.0, 0.0])];
        settings.cuts.shapes = vec![ShapeCut { effect, shape: shape.clone(), ..ShapeCut::default() }];
        let picture = render(&mut renderer(), &loaded, &settings, [64, 64]);
        // The camera looks along y.
        let expected = 1.0 - (-per_voxel * seen as f64).exp();
        let found = f64::from(picture.linear[32 * 64 + 32][3]);
        assert!((found - expected).abs() <= CHORD_OPACITY, "{effect:?}: {found} not {expected}");
        // Light falls along y, too: from one side of the slab to the other.
        let light = full_attenuation(&mut renderer(), &loaded, &settings, 0);
        let [one, other] = [3, 20].map(|y| f64::from(light[12 + EDGE_VOXELS * (y + EDGE_VOXELS * 12)]));
        let expected = (-per_voxel * f64::from(met)).exp();
        let found = one.min(other) / one.max(other);
        assert!((found - expected).abs() <= CHORD_OPACITY, "{effect:?}: {found} of light, not {expected}");
    }
}

/// A slab that an outline hides is empty.
fn hidden_slabs_are_empty(engine: RenderEngine) {
    let per_voxel = 0.04;
    let loaded = constant_volume(0);
    let shape = outlined_slab(&loaded.volume().scene());
    for (action, left) in [(CutAction::Hide, EDGE_VOXELS - 8), (CutAction::Keep, 8)] {
        let mut settings = base(engine, per_voxel).with_transfer(falling_extinction(per_voxel));
        settings.sampling.slab = 0.5;
        settings.cuts.shapes = vec![ShapeCut { action, shape: shape.clone(), ..ShapeCut::default() }];
        let picture = render(&mut renderer(), &loaded, &settings, [64, 64]);
        // The camera looks along y.
        let expected = 1.0 - (-per_voxel * left as f64).exp();
        let found = f64::from(picture.linear[32 * 64 + 32][3]);
        assert!((found - expected).abs() <= CHORD_OPACITY, "{action:?}: {found} not {expected}");
    }
}

/// The picture of a signed wave is that of the negative wave with the colours of the lobes exchanged.
fn lobes_of_either_sign_look_alike(engine: RenderEngine) {
    let wave = |sign: f64| {
        let value = |at: usize| {
            let p = DVec3::new(
                (at % EDGE_VOXELS) as f64,
                (at / EDGE_VOXELS % EDGE_VOXELS) as f64,
                (at / EDGE_VOXELS / EDGE_VOXELS) as f64,
            ) / EDGE_VOXELS as f64;
            127.5
                + sign * 127.5 * (11.0 * p.x + 2.0 * p.z).sin() * (9.0 * p.y).cos() * (8.0 * p.z + 1.0).sin()
        };
        // The same steps to either side of the middle.
        let values = (0..EDGE_VOXELS * EDGE_VOXELS * EDGE_VOXELS)
            .map(|at| (value(at) * 2.0).round() / 2.0)
            .map(|value| value as f32);
        let mut values: Vec<f32> = values.collect();
        // Both ends of the range.
        (values[0], values[1]) = (127.5 - sign as f32 * 127.5, 127.5 + sign as f32 * 127.5);
        Dataset::new(
            Volume::with_spacing("wave", [EDGE_VOXELS; 3], DVec3::ONE, Samples::F32(values))
                .expect("a volume"),
        )
    };
    let lobes = |low: [f32; 3], high: [f32; 3]| {
        let point = |value, color, opacity| ControlPoint::new(value, color, opacity);
        let points = vec![
            point(0.0, low, 0.5),
            point(75.0, low, 0.3),
            point(95.0, low, 0.0),
            point(127.5, [1.0; 3], 0.0),
            point(160.0, high, 0.0),
            point(180.0, high, 0.3),
            point(255.0, high, 0.5),
        ];
        TransferFunction {
            points,
            interpolation: OpacityInterpolation::Opacity,
            ..TransferFunction::default()
        }
    };
    let (red, blue) = ([0.9, 0.2, 0.1], [0.1, 0.3, 0.9]);
    let mut settings = base(engine, 0.1);
    settings.camera.azimuth_deg = 20.0;
    settings.camera.elevation_deg = 30.0;
    let picture = |sign: f64, low, high| {
        let settings = settings.clone().with_transfer(lobes(low, high));
        render(&mut renderer(), &wave(sign), &settings, [96, 96]).linear.concat()
    };
    let (one, other) = (picture(1.0, blue, red), picture(-1.0, red, blue));
    let exchanged = picture(1.0, red, blue);
    compare("lobes", &to_f64(&one), &to_f64(&other), LOBES).unwrap_or_else(|err| panic!("{err}"));
    compare("lobes that differ", &to_f64(&exchanged), &to_f64(&other), LOBES)
        .expect_err("colours are exchanged");
}
