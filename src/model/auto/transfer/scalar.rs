//! More is more of something: the object begins above what is around it.

use super::super::domain::Domain;
use super::super::palette::Palette;
use super::super::threshold::object_threshold;
use super::{Found, Stop, rising, through};
use crate::data::{Histogram, Volume};
use crate::model::TransferFunction;

/// Shows the object and hides what is around it.
pub(super) fn find(volume: &Volume, histogram: &Histogram) -> Found {
    let start = object_threshold(volume, histogram);
    let domain = Domain::of(volume, start);
    Found::of_values(in_colors_of(domain, volume, histogram, start), domain)
}

/// Shows what begins at a density, in the colours of its field.
pub(in crate::model::auto) fn beginning_at(
    volume: &Volume,
    histogram: &Histogram,
    start: f64,
) -> TransferFunction {
    in_colors_of(Domain::of(volume, start), volume, histogram, start)
}

fn in_colors_of(domain: Domain, volume: &Volume, histogram: &Histogram, start: f64) -> TransferFunction {
    let stops = rising(histogram, start).map(|(density, place, opacity)| Stop {
        // Beyond the range there is nothing else.
        value: volume.value_of(density.min(1.0)),
        place,
        opacity,
    });
    through(stops, Palette::of(domain))
}
