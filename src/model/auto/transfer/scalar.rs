//! More is more of something: the object begins above what is around it.

use super::super::domain::Domain;
use super::super::palette::Palette;
use super::super::threshold::{Edge, object_edge};
use super::{Found, Stop, rising, through};
use crate::data::{Histogram, Volume};
use crate::model::TransferFunction;

/// Shows the object and hides what is around it.
pub(super) fn find(volume: &Volume, histogram: &Histogram) -> Found {
    let edge = object_edge(volume, histogram);
    let domain = Domain::of(volume, edge.start);
    Found::of_values(in_colors_of(domain, volume, histogram, edge), domain)
}

/// Shows what begins somewhere, in the colours of its field.
pub(in crate::model::auto) fn beginning_at(
    volume: &Volume,
    histogram: &Histogram,
    edge: Edge,
) -> TransferFunction {
    in_colors_of(Domain::of(volume, edge.start), volume, histogram, edge)
}

fn in_colors_of(domain: Domain, volume: &Volume, histogram: &Histogram, edge: Edge) -> TransferFunction {
    let stops = rising(histogram, edge).map(|(density, place, opacity)| Stop {
        // Beyond the range there is nothing else.
        value: volume.value_of(density.min(1.0)),
        place,
        opacity,
    });
    through(stops, Palette::of(domain))
}
