//! Fallbacks for an empty first look: if the best guess shows nothing, the next one is used.

use glam::DVec3;

use super::data_kind_override::find_transfer_as_kind;
use super::isosurfaces::IsosurfaceStatistics;
use super::object::VisibleObject;
use super::threshold::{self, ObjectThreshold};
use super::{choose_view_and_lights, transfer};
use crate::{
    ControlPoint, DensityRange, FRAME_ASPECT, LabelTable, LightingTransfer, OpacityInterpolation,
    RayProjection, Settings, TransferFunction,
};
use chiaroscuro_volume::{Histogram, KindName, ValueRange, Volume};

/// Size in pixels of the frame in which the object is searched.
const FRAME_PIXELS: [f64; 2] = [48.0 * FRAME_ASPECT, 48.0];

/// Share of the frame's pixels that the object must cover: a thin line through a tenth of it.
const MIN_COVERAGE: f64 = 0.005;

/// Share of visible cells above which the volume's box is shown rather than an object.
const MAX_OCCUPANCY: f64 = 0.95;

/// Share of the voxels that [`densest_transfer`] shows.
const DENSEST_SHARE: f64 = 0.05;

/// Returns the first look, or if it shows nothing, or only the volume's box, a fallback that shows something.
pub(super) fn with_fallback(
    first: Settings,
    volume: &Volume,
    histogram: &Histogram,
    treated_as: Option<KindName>,
) -> Settings {
    let found = visible_content(&first, volume);
    if found == VisibleContent::Object {
        return first;
    }
    let robust = |transfer: TransferFunction| first.clone().with_transfer(transfer);
    let isosurfaces = || IsosurfaceStatistics::measure(volume);
    let beginning_at = |start: f64| {
        let edge = ObjectThreshold { start, slope: isosurfaces().slope(start).unwrap_or_default() };
        robust(transfer::transfer_from_edge(volume, histogram, edge))
    };
    let others: [&dyn Fn() -> Settings; 4] = [
        &|| beginning_at(threshold::otsu_threshold(histogram)),
        &|| beginning_at(isosurfaces().best_threshold().unwrap_or(0.5)),
        &|| {
            let all = volume.with_density_mapping(volume.value_range());
            let transfer = find_transfer_as_kind(&all, &Histogram::from_volume(&all), treated_as).transfer;
            first.clone().with_range(DensityRange::Full).with_transfer(transfer)
        },
        &|| robust(densest_transfer(volume)),
    ];
    let mut next = None;
    for other in others {
        let mut settings = other();
        choose_view_and_lights(&mut settings, volume);
        match visible_content(&settings, volume) {
            VisibleContent::Object => return settings,
            VisibleContent::Box if found == VisibleContent::Nothing && next.is_none() => {
                next = Some(settings);
            }
            _ => {}
        }
    }
    next.unwrap_or(first)
}

/// Content of the image that a look produces.
#[derive(Debug, PartialEq)]
pub(super) enum VisibleContent {
    Nothing,
    Object,
    Box,
}

pub(super) fn visible_content(settings: &Settings, volume: &Volume) -> VisibleContent {
    let object = VisibleObject::from_visible(settings, volume);
    let count = object.occupied_cells().count();
    if count as f64 > MAX_OCCUPANCY * object.cells.iter().product::<usize>() as f64 {
        return VisibleContent::Box;
    }
    let scene_from_index = volume.scene().scene_from_index;
    let [width, height] = FRAME_PIXELS;
    let reach = object.half_edge(&volume.scene()) / settings.camera.pixel_at_target(width, height);
    let mut pixels = vec![false; (width * height) as usize];
    for cell in object.occupied_cells() {
        let point: DVec3 = scene_from_index.transform_point3(object.cell_centre(cell));
        let Some((x, y, _)) = settings.camera.pixel_from_scene(point, width, height) else { continue };
        // Pixels that a cell covers, at least one, clipped to the border.
        let covered = |at: f64, size: f64| {
            let [first, last] = [at - reach, at + reach].map(|end| end.floor().clamp(-1.0, size));
            (first as i64).max(0)..=(last as i64).min(size as i64 - 1)
        };
        for y in covered(y, height) {
            for x in covered(x, width) {
                pixels[y as usize * width as usize + x as usize] = true;
            }
        }
    }
    let seen = pixels.iter().filter(|pixel| **pixel).count();
    if seen as f64 >= MIN_COVERAGE * pixels.len() as f64 {
        VisibleContent::Object
    } else {
        VisibleContent::Nothing
    }
}

/// Returns a transfer function that shows the twentieth of the voxels with the highest values; everything in a volume
/// with only one value.
pub fn densest_transfer(volume: &Volume) -> TransferFunction {
    let ValueRange { low, high } = volume.ranges().robust;
    let point = |value: f64, lightness: f32, opacity: f64| {
        ControlPoint::new(value, [lightness, lightness * 0.97, lightness * 0.92], opacity)
    };
    let points = if low == high {
        vec![point(low, 0.9, 0.9)]
    } else {
        // If one value has more voxels than that, everything above the midpoint of the range.
        let found = volume.quantile(1.0 - DENSEST_SHARE);
        let start = if found >= high { f64::midpoint(low, high) } else { found.max(low) };
        let at = |share: f64| start + share * (high - start);
        vec![point(start, 0.5, 0.0), point(at(0.1), 0.6, 0.5), point(high, 1.0, 0.95)]
    };
    TransferFunction { points, interpolation: OpacityInterpolation::Opacity, ..TransferFunction::default() }
}

/// Largest number of rows of voxels along an edge of a face that are projected, and of voxels in a row: three million
/// voxels in all, which are read in some hundredths of a second.
const MAX_ROWS: usize = 64;
const MAX_ROW_VOXELS: usize = 256;

/// Shares of the rows with smaller values at both ends of the range of a projection.
const ROW_SHARES: [f64; 2] = [0.02, 0.99];

/// Returns the settings with a transfer function that certainly shows something: see [`densest_transfer`], or for
/// projections an opacity that rises over their values along the axes.
pub fn with_visible_transfer(settings: &Settings, volume: &Volume) -> Settings {
    let transfer = match settings.ray_projection() {
        Some(projection) => stretched_ramp(&settings.layer().transfer, projected_range(volume, projection)),
        None => densest_transfer(volume),
    };
    settings
        .clone()
        .with_range(DensityRange::Robust)
        .with_labels(LabelTable::default())
        .with_transfer(transfer)
        .with_lighting(LightingTransfer::default())
}

/// Returns the range of a projection's values along the three axes, from some of the rows of voxels.
fn projected_range(volume: &Volume, projection: RayProjection) -> ValueRange {
    let dims = volume.dims();
    let places = |axis: usize, count: usize| (0..dims[axis]).step_by(dims[axis].div_ceil(count));
    let mut values: Vec<f64> = Vec::new();
    for axis in 0..3 {
        let (across, down) = ((axis + 1) % 3, (axis + 2) % 3);
        for (u, v) in places(across, MAX_ROWS).flat_map(|u| places(down, MAX_ROWS).map(move |v| (u, v))) {
            let row = places(axis, MAX_ROW_VOXELS).filter_map(|along| {
                let mut voxel = [0; 3];
                (voxel[axis], voxel[across], voxel[down]) = (along, u, v);
                let [x, y, z] = voxel;
                let is_missing = |at| volume.missing().is_some_and(|missing| missing.contains(at));
                (!is_missing(x + dims[0] * (y + dims[1] * z))).then(|| volume.value(x, y, z))
            });
            let row: Vec<f64> = row.collect();
            if row.is_empty() {
                continue;
            }
            values.push(match projection {
                RayProjection::Maximum => row.into_iter().fold(f64::MIN, f64::max),
                RayProjection::Minimum => row.into_iter().fold(f64::MAX, f64::min),
                RayProjection::Mean => row.iter().sum::<f64>() / row.len() as f64,
            });
        }
    }
    values.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| values.get((share * values.len() as f64) as usize).copied();
    match ROW_SHARES.map(at) {
        [Some(low), Some(high)] if low < high => ValueRange::new(low, high),
        _ => volume.ranges().robust,
    }
}

/// Returns an opacity that rises linearly over a range of values, with the colours of a function stretched over it.
fn stretched_ramp(colors: &TransferFunction, range: ValueRange) -> TransferFunction {
    let mut ramp = colors.clone();
    let ends = [ramp.points.first(), ramp.points.last()].map(|point| point.map_or(0.0, |point| point.value));
    let [first, last] = ends;
    if ramp.points.len() < 2 || last <= first {
        let point = |value, opacity| ControlPoint::new(value, [1.0; 3], opacity);
        ramp.points = vec![point(range.low, 0.0), point(range.high, 1.0)];
        return ramp;
    }
    for point in &mut ramp.points {
        point.opacity = (point.value - first) / (last - first);
        point.value = range.low + range.span() * point.opacity;
    }
    ramp
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RenderMode;
    use chiaroscuro_volume::Samples;

    /// A bright bar along z in a dark box, whose curve shows only what is brighter than any mean.
    #[test]
    fn projections_that_show_nothing_get_a_curve_over_their_values() {
        let value = |at: usize| if (at % 20, at / 20 % 20) == (9, 7) { 250.0 } else { 10.0 };
        let samples = Samples::F32((0..20 * 20 * 20).map(|at| value(at) as f32).collect());
        let volume = Volume::with_spacing("bar", [20; 3], DVec3::ONE, samples).unwrap();
        let point = |value, red, opacity| ControlPoint::new(value, [red, 0.5, 0.5], opacity);
        let transfer = TransferFunction {
            points: vec![point(200.0, 0.0, 0.0), point(225.0, 0.25, 0.9), point(250.0, 1.0, 1.0)],
            ..TransferFunction::default()
        };
        let mut settings = Settings::default().with_transfer(transfer);
        for (kind, expected) in [
            (RenderMode::Maximum, [10.0, 250.0]),
            (RenderMode::Mean, [10.0, 22.0]),
            (RenderMode::Minimum, [10.0, 10.0]),
        ] {
            settings.mode.kind = kind;
            let visible = with_visible_transfer(&settings, &volume);
            let points = &visible.layer().transfer.points;
            assert_eq!(points.iter().map(|point| point.opacity).collect::<Vec<_>>(), [0.0, 0.5, 1.0]);
            assert_eq!(points[1].color, [0.25, 0.5, 0.5], "colours are stretched");
            // Smallest values are the same everywhere here, which makes no range.
            let ends = [points[0].value, points[2].value];
            let robust = volume.ranges().robust;
            let expected = if kind == RenderMode::Minimum { [robust.low, robust.high] } else { expected };
            assert!(
                (ends[0] - expected[0]).abs() < 1e-6 && (ends[1] - expected[1]).abs() < 1e-6,
                "{kind:?} {ends:?}"
            );
        }
    }
}
