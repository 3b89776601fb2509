//! A first look at a volume that needs no touch: transfer function, camera and lights from the
//! values alone.
//!
//! What is around the object is recognised by the volume's own border: most scans have a margin.
//! The opacity ramp starts above it, at the value that best splits the volume in two (Otsu 1979).

mod frame;
mod isosurfaces;
mod object;
#[cfg(test)]
mod robustness;
mod threshold;
mod view;
mod visible;

use self::object::Object;
use self::threshold::object_threshold;
pub use self::visible::{densest, show_something};
use super::{ControlPoint, Interpolation, Length, Quality, Rig, Settings, Shadows, TransferFunction};
use crate::data::{Histogram, Volume};

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
    aim(&mut settings, volume);
    visible::or_another(settings, volume, histogram)
}

/// Points camera and lights at what settings show.
fn aim(settings: &mut Settings, volume: &Volume) {
    let object = Object::shown_by(settings, volume);
    view::choose(&mut settings.camera, volume, &object);
    frame::frame(settings, volume, &object);
    settings.lights = Rig::KeyAndFill.lights(&settings.camera);
}

/// The share of what settings show of a volume's surface that is not where material ends, but where the data do.
pub fn blockness(settings: &Settings, volume: &Volume) -> f64 {
    Object::of_shown(settings, volume).blockness()
}

/// The edge of a voxel of the file, in voxels: averaged voxels look like those that they stand for.
fn voxels_of_file(volume: &Volume) -> f64 {
    let count = |dims: [usize; 3]| dims.iter().map(|&n| n as f64).product::<f64>();
    (count(volume.dims()) / count(volume.file_dims())).cbrt()
}

/// A transfer function that shows the object and hides what is around it.
pub fn transfer(volume: &Volume, histogram: &Histogram) -> TransferFunction {
    ramp(volume, histogram, object_threshold(volume, histogram))
}

/// A transfer function that shows what begins at the density `start`.
fn ramp(volume: &Volume, histogram: &Histogram, start: f64) -> TransferFunction {
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
        // Beyond the range there is nothing else.
        .map(|(density, color, opacity)| ControlPoint::new(volume.value_of(density.min(1.0)), color, opacity))
        .to_vec();
    TransferFunction { points, interpolation: Interpolation::Opacity, ..TransferFunction::default() }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Samples;
    use glam::DVec3;

    /// A ball of the given value in a margin of another, with a ripple on both.
    pub(super) fn ball(inside: f32, outside: f32) -> Volume {
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
}
