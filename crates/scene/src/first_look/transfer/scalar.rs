//! Transfer functions for scalar data in which higher values mean more material: the object begins above the
//! background.

use super::super::domain::DataDomain;
use super::super::palette::DomainPalette;
use super::super::threshold::{ObjectThreshold, object_threshold};
use super::{FirstTransfer, PaletteStop, opacity_ramp, transfer_through_stops};
use crate::TransferFunction;
use chiaroscuro_volume::{Histogram, Volume};

/// Builds a function that shows the object and hides the background.
pub(super) fn find_scalar(volume: &Volume, histogram: &Histogram) -> FirstTransfer {
    let edge = object_threshold(volume, histogram);
    let domain = DataDomain::detect(volume, edge.start);
    FirstTransfer::from_values(transfer_in_domain_colors(domain, volume, histogram, edge), domain)
}

/// Builds a function for an object that begins at a given edge, in the colours of its domain.
pub(crate) fn transfer_from_edge(
    volume: &Volume,
    histogram: &Histogram,
    edge: ObjectThreshold,
) -> TransferFunction {
    transfer_in_domain_colors(DataDomain::detect(volume, edge.start), volume, histogram, edge)
}

fn transfer_in_domain_colors(
    domain: DataDomain,
    volume: &Volume,
    histogram: &Histogram,
    edge: ObjectThreshold,
) -> TransferFunction {
    let stops = opacity_ramp(histogram, edge).map(|stop| PaletteStop {
        // There are no values beyond the range.
        value: volume.value_of(stop.value.min(1.0)),
        ..stop
    });
    transfer_through_stops(stops, DomainPalette::for_domain(domain))
}
