//! Tests of the reference against closed forms, against itself with other weights, and with faults.

mod closed_forms;
mod controls;
mod weights;

use glam::DVec3;

use super::*;
use chiaroscuro_scene::{
    Camera, ControlPoint, DepositMode, LightGeometry, LightSettings, LightVolumeResolution, LitSides,
    NearFieldRay, OpacityInterpolation, Projection, ReverseKernel, SlabQuadrature, TransferFunction,
};
use chiaroscuro_volume::Samples;

const KERNELS: [ReconstructionKernel; 3] = [
    ReconstructionKernel::BSpline,
    ReconstructionKernel::Gaussian { sigma: 0.6 },
    ReconstructionKernel::Prefiltered,
];

fn volume(dims: [usize; 3], density: impl Fn(DVec3) -> f64) -> Volume {
    volume_with(dims, DVec3::ONE, density)
}

fn volume_with(dims: [usize; 3], spacing: DVec3, density: impl Fn(DVec3) -> f64) -> Volume {
    let [nx, ny, nz] = dims;
    let mut values: Vec<f32> = (0..nx * ny * nz)
        .map(|v| density(DVec3::new((v % nx) as f64, (v / nx % ny) as f64, (v / (nx * ny)) as f64)) as f32)
        .collect();
    // Two voxels far from all tested samples fix the value range at 0 … 1.
    values[0] = 0.0;
    values[1] = 1.0;
    Volume::with_spacing("test", dims, spacing, Samples::F32(values)).unwrap()
}

fn box_of(dims: [usize; 3]) -> Volume {
    volume(dims, |_| 1.0)
}

/// Makes a soft ball with a dense lump of sharp edges in it.
fn ball(dims: [usize; 3], spacing: DVec3) -> Volume {
    let counts = DVec3::from(dims.map(|n| n as f64));
    volume_with(dims, spacing, |p| {
        let away = (p + 0.5) / counts - 0.5;
        let lump = (away - DVec3::new(0.1, 0.1, 0.2)).length();
        if lump < 0.15 { 1.0 } else { (1.0 - 2.5 * away.length()).clamp(0.0, 0.6) }
    })
}

/// Makes settings with extinction linear in density; `depth` is the optical depth of a full voxel. Light is that of
/// the paper: volumes only, splatted back with the kernel of the light pass.
fn settings(depth: f64) -> Settings {
    let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
    let points = vec![point(0.0, 0.0), point(1.0, -(-depth).exp_m1())];
    let mut settings = Settings {
        camera: Camera { distance: 4.0, ..Camera::default() },
        lights: vec![LightSettings { position: [0.0, 0.0, 4.0], ..LightSettings::default() }],
        ..Settings::default()
    }
    .with_transfer(TransferFunction {
        points,
        interpolation: OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    });
    settings.shadows.slab = 1.0;
    settings.shadows.reverse_kernel = ReverseKernel::Forward;
    settings.shadows.near_field = NearFieldRay::Off;
    settings.shading.sides = LitSides::Two;
    settings
}

fn options(weights: ReferenceWeights, fault: ReferenceFault) -> ReferenceOptions {
    ReferenceOptions { weights, fault, ..ReferenceOptions::default() }
}

/// Returns the root mean square of differences.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

/// Makes settings with one light and an eye, at an optical depth of 0.4 per full voxel.
fn scene(kind: LightGeometry, position: [f64; 3], projection: Projection) -> Settings {
    let mut settings = settings(0.4);
    settings.lights[0] = LightSettings { kind, position, ..LightSettings::default() };
    settings.camera.projection = projection;
    settings
}
