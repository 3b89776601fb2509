//! A first look at a volume that needs no touch: transfer function, camera and lights from the
//! values alone.
//!
//! What is around the object is recognised by the volume's own border: most scans have a margin.
//! The opacity ramp starts above it, at the value that best splits the volume in two (Otsu 1979).

use glam::DVec3;

use super::{
    ControlPoint, FRAME_ASPECT, Fit, Interpolation, Length, Quality, Rig, Settings, Shadows, TransferFunction,
};
use crate::data::{HISTOGRAM_BINS, Histogram, Volume};

/// Share of the frame's height, or of its width, that the object fills: whichever it reaches first.
const FILL: f64 = 0.8;

/// Where the object begins, between its surroundings (0) and Otsu's split (1): thin shells and legs,
/// blurred by the scanner, do not reach the split.
const TOWARDS_SPLIT: f64 = 0.65;

/// Settings for a volume that nobody has touched yet.
pub fn first_settings(volume: &Volume, histogram: &Histogram) -> Settings {
    let mut settings = Settings {
        transfer: transfer(volume, histogram),
        opacity_unit: volume.unit_mm().map_or_else(|| Length::Voxels(voxels_of_file(volume)), Length::Mm),
        lights: Vec::new(),
        // A look that nobody has made by hand stays as bright as without shadows.
        shadows: Shadows { keep_balanced: true, ..Shadows::default() },
        ..Settings::default()
    };
    Quality::Standard.apply(&mut settings);
    frame_object(&mut settings, volume);
    settings.lights = Rig::KeyAndFill.lights(&settings.camera);
    settings
}

/// The edge of a voxel of the file, in voxels: averaged voxels look like those that they stand for.
fn voxels_of_file(volume: &Volume) -> f64 {
    let count = |dims: [usize; 3]| dims.iter().map(|&n| n as f64).product::<f64>();
    (count(volume.dims()) / count(volume.file_dims())).cbrt()
}

/// A transfer function that shows the object and hides what is around it.
pub fn transfer(volume: &Volume, histogram: &Histogram) -> TransferFunction {
    let start = object_threshold(volume, histogram);
    let above = |fraction: f64| percentile_above(histogram, start, fraction);
    // The bulk of the object lies below `bulk`; its brightest part is worth a colour of its own.
    let bulk = above(0.6).max(start + 0.04);
    let bright = above(0.97).max(bulk + 0.04);
    // (density, sRGB colour, opacity per unit): warm dark skin, tan flesh, ivory bone. The first
    // step rises quickly, so that surfaces are crisp and shadows fall on something.
    let stops = [
        (start, [0.42, 0.20, 0.14], 0.0),
        (start + 0.35 * (bulk - start), [0.66, 0.36, 0.24], 0.3),
        (bulk, [0.87, 0.62, 0.42], 0.65),
        (bright, [0.96, 0.88, 0.72], 0.88),
        (1.0f64.max(bright + 0.01), [1.0, 0.97, 0.92], 0.96),
    ];
    let points = stops
        .map(|(density, color, opacity)| ControlPoint::new(volume.value_of(density), color, opacity))
        .to_vec();
    TransferFunction { points, interpolation: Interpolation::Opacity, ..TransferFunction::default() }
}

/// The density at which the object begins.
fn object_threshold(volume: &Volume, histogram: &Histogram) -> f64 {
    let split = otsu(histogram);
    let around = border_level(volume);
    // An object that reaches the border on most sides has no margin to learn from.
    let margin = if around < histogram.percentile(0.9) { around } else { 0.0 };
    // The split lies halfway to the object's bulk; its thin parts are dimmer, down to the margin's
    // noise. Never so high that nothing is left.
    let ceiling = histogram.percentile(0.995).max(0.02);
    (margin + TOWARDS_SPLIT * (split - margin)).max(margin + 0.02).min(ceiling)
}

/// The density that splits the histogram into the two most compact classes (Otsu's method).
fn otsu(histogram: &Histogram) -> f64 {
    let bins = histogram.counts.len() as f64;
    let (total, sum) = histogram
        .counts
        .iter()
        .enumerate()
        .fold((0.0, 0.0), |(n, s), (bin, &count)| (n + count as f64, s + bin as f64 * count as f64));
    let (mut below, mut sum_below, mut best, mut best_bin) = (0.0, 0.0, -1.0, 0);
    for (bin, &count) in histogram.counts.iter().enumerate() {
        below += count as f64;
        sum_below += bin as f64 * count as f64;
        let above = total - below;
        if below == 0.0 || above == 0.0 {
            continue;
        }
        let difference = sum_below / below - (sum - sum_below) / above;
        let between = below * above * difference * difference;
        if between > best {
            (best, best_bin) = (between, bin);
        }
    }
    (best_bin as f64 + 1.0) / bins
}

/// What the volume's border looks like: of the six faces, the median of their 98th percentiles. One
/// face that cuts through the object, or two, do not matter.
fn border_level(volume: &Volume) -> f64 {
    let [nx, ny, nz] = volume.dims();
    let face = |u: usize, v: usize, at: &dyn Fn(usize, usize) -> [usize; 3]| {
        // At most 128² voxels of a face tell enough.
        let (du, dv) = (u.div_ceil(128), v.div_ceil(128));
        let mut densities: Vec<f64> = (0..u)
            .step_by(du)
            .flat_map(|i| (0..v).step_by(dv).map(move |j| (i, j)))
            .map(|(i, j)| {
                let [x, y, z] = at(i, j);
                volume.density_of(volume.value(x, y, z))
            })
            .collect();
        densities.sort_by(f64::total_cmp);
        densities[(densities.len() - 1) * 98 / 100]
    };
    let mut levels = [
        face(ny, nz, &|i, j| [0, i, j]),
        face(ny, nz, &|i, j| [nx - 1, i, j]),
        face(nx, nz, &|i, j| [i, 0, j]),
        face(nx, nz, &|i, j| [i, ny - 1, j]),
        face(nx, ny, &|i, j| [i, j, 0]),
        face(nx, ny, &|i, j| [i, j, nz - 1]),
    ];
    levels.sort_by(f64::total_cmp);
    f64::midpoint(levels[2], levels[3])
}

/// The density below which a share of the voxels above `start` lies.
fn percentile_above(histogram: &Histogram, start: f64, fraction: f64) -> f64 {
    let first = ((start * histogram.counts.len() as f64) as usize).min(histogram.counts.len() - 1);
    let counts: Vec<u64> = histogram
        .counts
        .iter()
        .enumerate()
        .map(|(bin, &count)| if bin < first { 0 } else { count })
        .collect();
    let total = counts.iter().sum();
    Histogram { counts, total }.percentile(fraction)
}

/// Opacity per voxel from which a voxel counts as shown.
const SHOWN: f64 = 0.05;

/// First and last shown voxel of every row, in scene space.
fn outline(settings: &Settings, volume: &Volume) -> Vec<DVec3> {
    use rayon::prelude::*;
    let scene = volume.scene();
    let [nx, ny, nz] = volume.dims();
    // Whether each of many densities is shown: a look-up per voxel.
    let shown: Vec<bool> = (0..=HISTOGRAM_BINS)
        .map(|bin| settings.transfer.opacity_at(volume.value_of(bin as f64 / HISTOGRAM_BINS as f64)) > SHOWN)
        .collect();
    let is_shown = |density: &f32| shown[(density * HISTOGRAM_BINS as f32) as usize];
    (0..nz)
        .into_par_iter()
        .flat_map_iter(|z| {
            let densities = volume.slice_densities(z);
            let mut ends = Vec::new();
            for y in 0..ny {
                let row = &densities[y * nx..(y + 1) * nx];
                let first = row.iter().position(is_shown);
                let last = row.iter().rposition(is_shown);
                for x in [first, last].into_iter().flatten() {
                    let index = DVec3::new(x as f64, y as f64, z as f64);
                    ends.push(scene.scene_from_index.transform_point3(index));
                }
            }
            ends
        })
        .collect()
}

/// Share of the outline that may lie below the floor: single voxels of noise.
const BELOW_FLOOR: f64 = 0.001;

/// The z below which next to nothing of an outline lies.
fn floor_under(outline: &[DVec3]) -> f64 {
    let mut heights: Vec<f64> = outline.iter().map(|point| point.z).collect();
    let at = (heights.len() as f64 * BELOW_FLOOR) as usize;
    *heights.select_nth_unstable_by(at, f64::total_cmp).1
}

/// Points the camera at what the transfer function shows, from three quarters above, near enough
/// that it fills the frame, which lies within pictures of any shape.
fn frame_object(settings: &mut Settings, volume: &Volume) {
    settings.camera.fit = Fit::Frame;
    let corners = outline(settings, volume);
    if corners.is_empty() {
        return;
    }
    settings.floor.height = floor_under(&corners) - volume.scene().smallest_edge() / 2.0;
    let camera = &mut settings.camera;
    let view = camera.scene_from_view();
    let half_angle_tan = camera.half_height_at_target(FRAME_ASPECT) / camera.distance;
    // Two rounds: perspective shifts the middle a little once the distance is known.
    let mut target = DVec3::ZERO;
    for _ in 0..3 {
        let eye = target + view.z_axis * camera.distance;
        let seen: Vec<DVec3> = corners
            .iter()
            .map(|corner| {
                let local = view.transpose() * (*corner - eye);
                DVec3::new(local.x / -local.z, local.y / -local.z, -local.z)
            })
            .filter(|seen| seen.z > 0.0)
            .collect();
        let low = seen.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
        let high = seen.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
        let middle = (low + high) / 2.0;
        target += (view.x_axis * middle.x + view.y_axis * middle.y) * camera.distance;
        let half = (high - low) / 2.0;
        let wanted = FILL * half_angle_tan;
        let factor = (half.y / wanted).max(half.x / (wanted * FRAME_ASPECT));
        camera.distance = (camera.distance * factor).clamp(0.3, 20.0);
    }
    camera.target = target.into();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Samples;
    use crate::data::synthetic::builtin;
    use glam::DVec2;

    /// A ball of the given value in a margin of another, with a ripple on both.
    fn ball(inside: f32, outside: f32) -> Volume {
        let n = 32usize;
        let values = (0..n * n * n)
            .map(|at| {
                let p = [at % n, at / n % n, at / n / n].map(|c| c as f32 - 15.5);
                let base = if p.iter().map(|c| c * c).sum::<f32>() < 100.0 { inside } else { outside };
                base + (at % 7) as f32
            })
            .collect();
        Volume::with_spacing("ball", [n; 3], DVec3::ONE, Samples::F32(values)).unwrap()
    }

    #[test]
    fn the_floor_lies_under_the_object() {
        let volume = ball(200.0, 0.0);
        let settings = first_settings(&volume, &Histogram::of(&volume));
        // The ball's radius is ten of 32 voxels, and a scene unit 16.
        assert!((settings.floor.height + 10.0 / 16.0).abs() < 0.07, "{}", settings.floor.height);
        assert!(!settings.floor.on);
    }

    #[test]
    fn the_object_is_shown_and_its_surroundings_are_not() {
        for (inside, outside) in [(200.0, 0.0), (1200.0, -1000.0), (60.0, 40.0)] {
            let volume = ball(inside, outside);
            let function = transfer(&volume, &Histogram::of(&volume));
            assert_eq!(function.opacity_at(f64::from(outside) + 6.0), 0.0, "{inside} {outside}");
            assert!(function.opacity_at(f64::from(inside) + 6.0) > 0.1, "{inside} {outside}");
        }
    }

    #[test]
    fn points_ascend_even_for_odd_histograms() {
        let constant = Volume::with_spacing("c", [8; 3], DVec3::ONE, Samples::U8(vec![7; 512])).unwrap();
        let one = {
            let mut values = vec![0u8; 512];
            values[100] = 255;
            Volume::with_spacing("one", [8; 3], DVec3::ONE, Samples::U8(values)).unwrap()
        };
        for volume in [constant, one] {
            let function = transfer(&volume, &Histogram::of(&volume));
            assert!(function.points.windows(2).all(|pair| pair[0].value <= pair[1].value), "{function:?}");
        }
    }

    #[test]
    fn the_object_fills_the_picture() {
        let volume = ball(200.0, 0.0);
        let settings = first_settings(&volume, &Histogram::of(&volume));
        let (_, top, _) = settings.camera.pixel_from_scene(DVec3::ZERO, 400.0, 300.0).unwrap();
        assert!((top - 150.0).abs() < 20.0, "the ball's centre is at row {top}");
        assert!(settings.camera.distance > 1.0 && settings.camera.distance < 8.0);
    }

    /// Where the shown voxels of a volume lie in a picture: corners of the box around them, in pixels.
    fn seen_box(settings: &Settings, volume: &Volume, size: DVec2) -> [DVec2; 2] {
        let pixels = outline(settings, volume).into_iter().map(|point| {
            let seen = settings.camera.pixel_from_scene(point, size.x, size.y);
            let (x, y, _) = seen.expect("a point in front of the eye");
            DVec2::new(x, y)
        });
        pixels.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
    }

    #[test]
    fn the_object_is_framed_in_pictures_of_every_shape() {
        for name in ["chair", "cloud", "marschner-lobb"] {
            let volume = builtin(name, Some(48)).unwrap();
            let mut settings = first_settings(&volume, &Histogram::of(&volume));
            let mut parallel = settings.clone();
            parallel.camera.toggle_projection();
            for size in [[1200, 400], [960, 540], [800, 600], [500, 500], [360, 640], [200, 800]] {
                let size = DVec2::from(size.map(f64::from));
                let [low, high] = seen_box(&settings, &volume, size);
                let margin = (low / size).min((size - high) / size).min_element();
                assert!(margin >= 0.05, "{name} in {size}: a margin of {margin}");
                // The largest frame in the picture.
                let height = size.y.min(size.x / FRAME_ASPECT);
                let filled = ((high - low) / DVec2::new(height * FRAME_ASPECT, height)).max_element();
                assert!(filled >= 0.6, "{name} in {size}: fills {filled} of the frame");
                // Parallel rays show what is far away larger: of a whole cube, a little more than the margin.
                let [low, high] = seen_box(&parallel, &volume, size);
                assert!(low.min_element() > 0.0 && (size - high).min_element() > 0.0, "{name} in {size}");
            }
            // With the angle of the height, a narrow picture cuts it off.
            settings.camera.fit = Fit::Height;
            let size = DVec2::new(200.0, 800.0);
            let [low, high] = seen_box(&settings, &volume, size);
            assert!(low.x < 0.0 && high.x > size.x, "{name}: {low} to {high}");
        }
    }
}
