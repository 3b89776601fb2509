//! Fallbacks for an empty first look: if the best guess shows nothing, the next one is used.

use glam::DVec3;

use super::data_kind_override::find_transfer_as_kind;
use super::isosurfaces::IsosurfaceStatistics;
use super::object::VisibleObject;
use super::threshold::{self, ObjectThreshold};
use super::{choose_view_and_lights, transfer};
use crate::{
    ControlPoint, DensityRange, FRAME_ASPECT, LabelTable, LightingTransfer, OpacityInterpolation, Settings,
    TransferFunction,
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

/// Returns the settings with a transfer function that certainly shows something: see [`densest_transfer`], or for
/// projections an opacity that rises over the whole range, as means and smallest values are anywhere in it.
pub fn with_visible_transfer(settings: &Settings, volume: &Volume) -> Settings {
    let transfer = if settings.ray_projection().is_some() {
        stretched_ramp(&settings.layer().transfer, volume.ranges().robust)
    } else {
        densest_transfer(volume)
    };
    settings
        .clone()
        .with_range(DensityRange::Robust)
        .with_labels(LabelTable::default())
        .with_transfer(transfer)
        .with_lighting(LightingTransfer::default())
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
