//! More is more of something: the object begins above what is around it.

use super::super::above as histogram_above;
use super::super::domain::Domain;
use super::super::palette::Palette;
use super::super::threshold::object_threshold;
use super::{Found, Stop, through};
use crate::data::{Histogram, Volume};
use crate::model::TransferFunction;

/// The density at which the object begins.
pub(in crate::model::auto) fn start_of_object(volume: &Volume, histogram: &Histogram) -> f64 {
    object_threshold(volume, histogram)
}

/// Shows the object and hides what is around it.
pub(super) fn find(volume: &Volume, histogram: &Histogram) -> Found {
    let start = start_of_object(volume, histogram);
    let domain = Domain::of(volume, start);
    Found::of_values(rising(volume, histogram, start, Palette::of(domain)), domain)
}

/// Shows what begins at a density, in the colours of its field.
pub(super) fn beginning_at(volume: &Volume, histogram: &Histogram, start: f64) -> TransferFunction {
    rising(volume, histogram, start, Palette::of(Domain::of(volume, start)))
}

/// Rises from a density on.
fn rising(volume: &Volume, histogram: &Histogram, start: f64, palette: &Palette) -> TransferFunction {
    let shown = histogram_above(histogram, start);
    let above = |fraction: f64| shown.percentile(fraction);
    // The bulk of the object lies below `bulk`; its brightest part is worth a colour of its own.
    let bulk = above(0.6).max(start + 0.04);
    let bright = above(0.97).max(bulk + 0.04);
    // (density, place in the palette, opacity per unit). The first step rises quickly, so that surfaces are crisp and
    // shadows fall on something.
    let stops = [
        (start, 0.0, 0.0),
        (start + 0.35 * (bulk - start), 0.2, 0.3),
        (bulk, 0.5, 0.65),
        (bright, 0.85, 0.88),
        (1.0f64.max(bright + 0.01), 1.0, 0.96),
    ];
    through(
        // Beyond the range there is nothing else.
        stops.map(|(density, place, opacity)| Stop {
            value: volume.value_of(density.min(1.0)),
            place,
            opacity,
        }),
        palette,
    )
}
