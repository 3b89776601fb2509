//! Automatic transfer functions by the kind of data.

mod box_filling;
mod covering_label;
mod dark_on_bright;
mod distance_field;
mod hounsfield;
mod label_map;
mod label_visibility;
mod mask;
mod masked_field;
mod picture;
mod scalar;
mod signed;
#[cfg(test)]
mod tests;
mod veil;

use super::domain::DataDomain;
use super::histogram_above;
use super::palette::DomainPalette;
use super::threshold::ObjectThreshold;
use crate::{ColorMixing, ControlPoint, LabelTable, OpacityInterpolation, TransferFunction};
use chiaroscuro_volume::{DataKind, Histogram, Volume};

pub(super) use self::covering_label::make_cover_translucent;
pub(super) use self::hounsfield::{SKIN_END_HU, SkinVeil};
pub(super) use self::label_map::{count_lost_labels, label_range as range_of_labels, label_table};
pub(super) use self::picture::axis_across_picture;
pub(super) use self::scalar::{find_scalar, transfer_from_edge};
pub(super) use self::veil::{inner_transfer, opaque_transfer, scale_opacity, veiled_transfer};

/// Transfer function found for a volume, with its domain.
pub(super) struct FirstTransfer {
    pub(super) transfer: TransferFunction,
    /// Label table, for label maps only.
    pub(super) labels: LabelTable,
    pub(super) domain: DataDomain,
    pub(super) style: TransferStyle,
}

/// Style of a transfer function, which decides what is done with it afterwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TransferStyle {
    /// Objects, of which another may be sought, or an inner material revealed.
    Object,
    /// Objects with a part that is too transparent to count as visible, and still has to be framed.
    Veiled,
    /// Object that is known for certain: no other is sought.
    KnownObject,
    /// Picture, all of it opaque: it has no relief, and no object is sought in it.
    Picture,
}

impl FirstTransfer {
    /// Creates a result without labels, for objects.
    fn from_values(transfer: TransferFunction, domain: DataDomain) -> Self {
        Self { transfer, labels: LabelTable::default(), domain, style: TransferStyle::Object }
    }
}

/// Finds the transfer function for a kind of data.
pub(super) fn find_transfer(volume: &Volume, histogram: &Histogram, kind: DataKind) -> FirstTransfer {
    if let Some(picture) = picture::find_picture(volume, kind) {
        return picture;
    }
    // Distances are of either sign, or brighter around than within.
    let may_be_distance = matches!(kind, DataKind::Signed | DataKind::Scalar | DataKind::DarkOnBright);
    if may_be_distance && let Some(distances) = distance_field::find_distance_field(volume) {
        return distances;
    }
    match kind {
        DataKind::Mask => {
            FirstTransfer::from_values(mask::mask_transfer(volume, histogram), DataDomain::Unknown)
        }
        DataKind::LabelMap { .. } => FirstTransfer {
            transfer: label_map::label_transfer(volume),
            labels: label_visibility::with_report(label_map::label_table(volume), volume),
            domain: DataDomain::Unknown,
            style: TransferStyle::Object,
        },
        DataKind::Signed => {
            signed::find_signed(volume).unwrap_or_else(|| scalar::find_scalar(volume, histogram))
        }
        DataKind::HounsfieldCt { water } => {
            hounsfield::find_bone(volume, water).unwrap_or_else(|| scalar::find_scalar(volume, histogram))
        }
        DataKind::DarkOnBright => dark_on_bright::find_dark_on_bright(volume, histogram),
        DataKind::Scalar => scalar::find_scalar(volume, histogram),
    }
}

/// Control point before its colour is known: value, position in the palette, and opacity.
struct PaletteStop {
    value: f64,
    place: f64,
    opacity: f64,
}

/// Length of the first opacity ramp as a share of the way to the bulk: minimum and maximum.
const FIRST_RAMP_SHARE: (f64, f64) = (0.15, 0.8);

/// Returns the opacity ramp of an object that begins at `start`, with values on a scale of 0 … 1 that `histogram`
/// counts.
fn opacity_ramp(
    histogram: &Histogram,
    ObjectThreshold { start, slope }: ObjectThreshold,
) -> [PaletteStop; 5] {
    let object = histogram_above(histogram, start);
    // The bulk of the object lies below `bulk`; its densest part gets a colour of its own. Each takes a twenty-fifth
    // of the scale at least, ten steps of 8-bit data, so that surfaces do not end as abruptly as voxels.
    let bulk = object.percentile(0.6).max(start + 0.04);
    let dense = object.percentile(0.97).max(bulk + 0.04);
    // The first ramp rises within a voxel of the boundary, as steep as the data are there: surfaces are crisp enough
    // to receive shadows, and not so abrupt that voxels show. Material there hides half of the background within two
    // units. The ramp ends well before the bulk, and begins no more abruptly than noise would show.
    let (least, most) = FIRST_RAMP_SHARE;
    let rise = slope.clamp(least * (bulk - start), most * (bulk - start));
    [
        PaletteStop { value: start, place: 0.0, opacity: 0.0 },
        PaletteStop { value: start + rise, place: 0.2, opacity: 0.3 },
        PaletteStop { value: bulk, place: 0.5, opacity: 0.65 },
        PaletteStop { value: dense, place: 0.85, opacity: 0.88 },
        PaletteStop { value: 1.0f64.max(dense + 0.01), place: 1.0, opacity: 0.96 },
    ]
}

/// Builds a transfer function through stops in any order; colours are mixed in Oklab.
fn transfer_through_stops(
    stops: impl IntoIterator<Item = PaletteStop>,
    palette: &DomainPalette,
) -> TransferFunction {
    let points = stops
        .into_iter()
        .map(|stop| ControlPoint::new(stop.value, palette.color_at(stop.place), stop.opacity));
    transfer_from_points(points.collect())
}

fn transfer_from_points(points: Vec<ControlPoint>) -> TransferFunction {
    let mut function =
        TransferFunction { points, interpolation: OpacityInterpolation::Opacity, mixing: ColorMixing::Seen };
    function.sort();
    function
}

/// Returns a sorted sample of a volume's values, without missing voxels: all voxels, or every n-th one of a large
/// volume.
fn sample_values(volume: &Volume, keep: impl FnMut(f64) -> Option<f64>) -> Vec<f64> {
    // Quantiles of two million values are accurate to a thousandth.
    let step = volume.voxel_count().div_ceil(1 << 21).max(1);
    let samples = volume.samples();
    let is_there = |voxel: &usize| volume.missing().is_none_or(|missing| !missing.contains(*voxel));
    let found = (0..samples.len()).step_by(step).filter(is_there).map(|voxel| samples.value(voxel));
    let mut values: Vec<f64> = found.filter_map(keep).collect();
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// Returns the quantile of sorted values; 0 if there are none.
fn quantile(values: &[f64], share: f64) -> f64 {
    let at = (share * values.len() as f64) as usize;
    values.get(at.min(values.len().saturating_sub(1))).copied().unwrap_or(0.0)
}
