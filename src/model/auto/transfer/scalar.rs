//! Transfer functions for scalar data in which higher values mean more material: the object begins above the
//! background.

use super::super::domain::Domain;
use super::super::palette::Palette;
use super::super::threshold::{Edge, object_edge};
use super::{Found, Stop, rising, through};
use crate::data::{Histogram, Volume};
use crate::model::TransferFunction;

/// Builds a function that shows the object and hides the background.
pub(super) fn find(volume: &Volume, histogram: &Histogram) -> Found {
    let edge = object_edge(volume, histogram);
    let domain = Domain::of(volume, edge.start);
    Found::of_values(in_colors_of(domain, volume, histogram, edge), domain)
}

/// Builds a function for an object that begins at a given edge, in the colours of its domain.
pub(in crate::model::auto) fn beginning_at(
    volume: &Volume,
    histogram: &Histogram,
    edge: Edge,
) -> TransferFunction {
    in_colors_of(Domain::of(volume, edge.start), volume, histogram, edge)
}

fn in_colors_of(domain: Domain, volume: &Volume, histogram: &Histogram, edge: Edge) -> TransferFunction {
    let stops = rising(histogram, edge).map(|(density, place, opacity)| Stop {
        // There are no values beyond the range.
        value: volume.value_of(density.min(1.0)),
        place,
        opacity,
    });
    through(stops, Palette::of(domain))
}
