//! Transfer functions for dark objects on a bright background: opacity rises towards lower values.

use super::super::domain::DataDomain;
use super::super::isosurfaces::IsosurfaceStatistics;
use super::super::palette::DomainPalette;
use super::super::threshold::{
    MIN_ABOVE_BACKGROUND, ObjectThreshold, border_level, otsu_threshold, threshold_above_margin,
};
use super::{FirstTransfer, PaletteStop, opacity_ramp, transfer_through_stops};
use chiaroscuro_volume::{Histogram, Volume};

/// Builds the function as for bright objects, on an inverted scale.
pub(super) fn find_dark_on_bright(volume: &Volume, histogram: &Histogram) -> FirstTransfer {
    let mut counts = histogram.counts.clone();
    counts.reverse();
    // Darkness is 0 at the highest value, 1 at the lowest.
    let darkness = Histogram { counts, total: histogram.total };
    let split = otsu_threshold(&darkness);
    // Darkness of the background, without a few voxels.
    let around = border_level(volume, |density| 1.0 - density);
    let margin = if around < split { around } else { 0.0 };
    // The limit ensures that something is left.
    let start = threshold_above_margin(margin, split).min(1.0 - MIN_ABOVE_BACKGROUND);
    let domain = DataDomain::from_channels(volume).unwrap_or(DataDomain::Unknown);
    let slope = IsosurfaceStatistics::measure(volume).slope(1.0 - start).unwrap_or_default();
    let stops = opacity_ramp(&darkness, ObjectThreshold { start, slope })
        .map(|stop| PaletteStop { value: volume.value_of((1.0 - stop.value).max(0.0)), ..stop });
    FirstTransfer::from_values(transfer_through_stops(stops, DomainPalette::for_domain(domain)), domain)
}
