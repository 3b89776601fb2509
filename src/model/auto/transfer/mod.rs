//! Transfer functions by the kind of data.

mod cover;
mod dark;
mod hounsfield;
mod known_part;
mod labels;
mod mask;
mod scalar;
mod signed;
#[cfg(test)]
mod tests;
mod veil;

use super::above;
use super::domain::Domain;
use super::palette::Palette;
use super::threshold::Edge;
use crate::data::{DataKind, Histogram, Volume};
use crate::model::{ControlPoint, Interpolation, LabelTable, Mixing, TransferFunction};

pub(super) use self::cover::thin_cover;
pub(super) use self::hounsfield::with_skin;
pub(super) use self::labels::{lost_labels, range as range_of_labels, table as label_table};
pub(super) use self::scalar::beginning_at;
pub(super) use self::veil::{inner, scale_opacity, unveiled, veiled};

/// What is shown of a volume, and what it is.
pub(super) struct Found {
    pub(super) transfer: TransferFunction,
    /// Of label maps alone.
    pub(super) labels: LabelTable,
    pub(super) domain: Domain,
    /// Something of it is too clear to count as shown, and is to be framed all the same.
    pub(super) has_veil: bool,
}

impl Found {
    /// A look of values.
    fn of_values(transfer: TransferFunction, domain: Domain) -> Self {
        Self { transfer, labels: LabelTable::default(), domain, has_veil: false }
    }
}

/// A transfer function for data of a kind.
pub(super) fn find(volume: &Volume, histogram: &Histogram, kind: DataKind) -> Found {
    match kind {
        DataKind::Mask => Found::of_values(mask::transfer(volume, histogram), Domain::Unknown),
        DataKind::LabelMap { .. } => Found {
            transfer: labels::transfer(volume),
            labels: labels::table(volume),
            domain: Domain::Unknown,
            has_veil: false,
        },
        DataKind::Signed => signed::find(volume).unwrap_or_else(|| scalar::find(volume, histogram)),
        DataKind::HounsfieldCt { water } => {
            hounsfield::find(volume, water).unwrap_or_else(|| scalar::find(volume, histogram))
        }
        DataKind::DarkOnBright => dark::find(volume, histogram),
        DataKind::Scalar => scalar::find(volume, histogram),
    }
}

/// A point before its value and its colour are known: how far along the scale, along the palette, and how opaque.
struct Stop {
    value: f64,
    place: f64,
    opacity: f64,
}

/// How much of the way to the bulk the first step of opacity takes, at least and at most.
const FIRST_STEP: (f64, f64) = (0.15, 0.8);

/// Where opacities rise on a scale from 0 to 1, of which `histogram` counts the values, for an object that begins at a
/// place of it: (place on the scale, place in the palette, opacity per unit).
fn rising(histogram: &Histogram, Edge { start, slope }: Edge) -> [(f64, f64, f64); 5] {
    let object = above(histogram, start);
    // The bulk of the object lies below `bulk`; its densest part is worth a colour of its own. A twenty-fifth of the scale
    // at least for each, ten steps of 8-bit data, lest surfaces end as abruptly as voxels do.
    let bulk = object.percentile(0.6).max(start + 0.04);
    let dense = object.percentile(0.97).max(bulk + 0.04);
    // The first step rises within a voxel of the boundary, as steep or gentle as that is in these data: surfaces are crisp,
    // so that shadows fall on something, and not so abrupt that voxels show. What begins there hides half of what is behind
    // it within two units. It ends well before the bulk, and begins no more abruptly than noise would show.
    let (least, most) = FIRST_STEP;
    let rise = slope.clamp(least * (bulk - start), most * (bulk - start));
    [
        (start, 0.0, 0.0),
        (start + rise, 0.2, 0.3),
        (bulk, 0.5, 0.65),
        (dense, 0.85, 0.88),
        (1.0f64.max(dense + 0.01), 1.0, 0.96),
    ]
}

/// A transfer function through stops in any order; colours mix as they are seen.
fn through(stops: impl IntoIterator<Item = Stop>, palette: &Palette) -> TransferFunction {
    let points =
        stops.into_iter().map(|stop| ControlPoint::new(stop.value, palette.at(stop.place), stop.opacity));
    of_points(points.collect())
}

fn of_points(points: Vec<ControlPoint>) -> TransferFunction {
    let mut function =
        TransferFunction { points, interpolation: Interpolation::Opacity, mixing: Mixing::Seen };
    function.sort();
    function
}

/// Values of a volume in order, where there is something: of all voxels, or of one in so many.
fn some_values(volume: &Volume, keep: impl FnMut(f64) -> Option<f64>) -> Vec<f64> {
    // Quantiles of two million are good to a thousandth.
    let step = volume.voxel_count().div_ceil(1 << 21).max(1);
    let samples = volume.samples();
    let is_there = |voxel: &usize| volume.missing().is_none_or(|missing| !missing.contains(*voxel));
    let found = (0..samples.len()).step_by(step).filter(is_there).map(|voxel| samples.value(voxel));
    let mut values: Vec<f64> = found.filter_map(keep).collect();
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// The value below which a share of ordered values lies; 0 where there are none.
fn quantile(values: &[f64], share: f64) -> f64 {
    let at = (share * values.len() as f64) as usize;
    values.get(at.min(values.len().saturating_sub(1))).copied().unwrap_or(0.0)
}
