//! Transfer functions for dark objects on a bright background: opacity rises towards lower values.

use super::super::domain::Domain;
use super::super::isosurfaces::Isosurfaces;
use super::super::palette::Palette;
use super::super::threshold::{Edge, LEAST_ABOVE, above_margin, border_level, otsu};
use super::{Found, Stop, rising, through};
use crate::data::{Histogram, Volume};

/// Builds the function as for bright objects, on an inverted scale.
pub(super) fn find(volume: &Volume, histogram: &Histogram) -> Found {
    let mut counts = histogram.counts.clone();
    counts.reverse();
    // Darkness is 0 at the highest value, 1 at the lowest.
    let darkness = Histogram { counts, total: histogram.total };
    let split = otsu(&darkness);
    // Darkness of the background, without a few voxels.
    let around = border_level(volume, |density| 1.0 - density);
    let margin = if around < split { around } else { 0.0 };
    // The limit ensures that something is left.
    let start = above_margin(margin, split).min(1.0 - LEAST_ABOVE);
    let domain = Domain::of_channels(volume).unwrap_or(Domain::Unknown);
    let slope = Isosurfaces::of(volume).slope(1.0 - start).unwrap_or_default();
    let stops = rising(&darkness, Edge { start, slope }).map(|(darkness, place, opacity)| Stop {
        value: volume.value_of((1.0 - darkness).max(0.0)),
        place,
        opacity,
    });
    Found::of_values(through(stops, Palette::of(domain)), domain)
}
