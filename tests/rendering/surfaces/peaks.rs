//! Thin shells: peaks of the curve that a slab may step over, against closed forms.

use chiaroscuro_render::Renderer;
use chiaroscuro_scene::{
    ControlPoint, DensityRange, OpacityLength, QualityPreset, SceneAxis, TransferFunction,
};
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::DVec3;

use crate::common::{damaged_renderer, new_renderer, render};
use crate::scenes::{self, axis_camera};
use crate::thresholds::NARROW_PEAKS;

/// Number of voxels along the axis in which densities rise, and along the other two.
const HEIGHT: usize = 40;
const WIDTH: usize = 24;

/// Densities of a slope from 0 to 1 over a number of voxels in the middle of the grid.
fn slope_volume(length: f64) -> Dataset {
    let density = |z: usize| ((z as f64 - HEIGHT as f64 / 2.0) / length + 0.5).clamp(0.0, 1.0) as f32;
    let values = (0..WIDTH * WIDTH * HEIGHT).map(|at| density(at / (WIDTH * WIDTH))).collect();
    let volume = Volume::with_spacing("slope", [WIDTH, WIDTH, HEIGHT], DVec3::ONE, Samples::F32(values));
    Dataset::new(volume.expect("a volume"))
}

/// Relative error of the opacity of a peak with a half width in densities, on a slope over `length` voxels, seen at
/// an angle: worst of the means over the picture's middle.
fn peak_error(
    renderer: &mut Renderer,
    half_width: f64,
    length: f64,
    angle_deg: f64,
    quality: QualityPreset,
) -> f64 {
    // Extinction rises to its peak and falls linearly; a B-spline leaves a linear slope as it is.
    let peak = 0.4;
    // Extinctions above some eight per voxel cannot be set.
    let per_voxel = (0.8 / (half_width * length)).min(4.0);
    let optical_depth = per_voxel * half_width * length / angle_deg.to_radians().cos();
    let points = [(peak - half_width, 0.0), (peak, 1.0 - (-per_voxel).exp()), (peak + half_width, 0.0)];
    let transfer = TransferFunction {
        points: points.iter().map(|&(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity)).collect(),
        interpolation: chiaroscuro_scene::OpacityInterpolation::Extinction,
        ..TransferFunction::default()
    };
    let mut settings = scenes::look()
        .with_transfer(transfer)
        .with_opacity_unit(OpacityLength::Voxels(1.0))
        .with_range(DensityRange::Full);
    quality.apply(&mut settings);
    settings.camera = axis_camera(20.0, 90.0 - angle_deg);
    settings.camera.up = SceneAxis::PlusZ;
    settings.camera.fov_y_deg = 12.0;
    let size = 96;
    let picture = render(renderer, &slope_volume(length), &settings, [size as u32; 2]);
    let middle = size * 2 / 5..size * 3 / 5;
    let pixels: Vec<f64> = middle
        .clone()
        .flat_map(|y| middle.clone().map(move |x| y * size + x))
        .map(|at| f64::from(picture.linear[at][3]))
        .collect();
    let mean = pixels.iter().sum::<f64>() / pixels.len() as f64;
    mean / (1.0 - (-optical_depth).exp()) - 1.0
}

/// Half widths of peaks with the limits of their opacity: ± 4 of 255, and ± 0.2 % of the range, which is a fraction of
/// a voxel even on slopes over ten.
const PEAKS: [(f64, f64); 2] = [(4.0 / 255.0, NARROW_PEAKS[0]), (0.002, NARROW_PEAKS[1])];

#[test]
fn narrow_peaks_keep_their_opacity() {
    let mut renderer = new_renderer();
    let mut failures = Vec::new();
    for (half_width, limit) in PEAKS {
        for length in [5.0, 24.0] {
            for angle_deg in [0.0, 33.0] {
                for quality in [QualityPreset::Standard, QualityPreset::Fine, QualityPreset::Exact] {
                    let error = peak_error(&mut renderer, half_width, length, angle_deg, quality);
                    println!(
                        "peak ± {half_width:.4}, slope over {length}, {angle_deg}°, {quality:?}: {error:+.4}"
                    );
                    if error.abs() > limit {
                        failures
                            .push(format!("± {half_width:.4}, {length}, {angle_deg}°, {quality:?}: {error}"));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn missed_peaks_are_noticed() {
    let mut renderer = damaged_renderer(
        "return select((b.integral - a.integral) / select(distance, 1.0, is_near), 0.5 * (a.mean + b.mean), is_near);",
        "return extinction_of(Field(0.5 * (a.position + b.position) / f32(TABLE_SIZE - 1u)));",
    );
    for (half_width, limit) in PEAKS {
        let error = peak_error(&mut renderer, half_width, 5.0, 7.0, QualityPreset::Standard);
        assert!(error.abs() > limit, "± {half_width}: {error}");
    }
}
