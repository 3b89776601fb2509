//! An object that is darker than what is around it: opacity rises downwards.

use super::super::domain::Domain;
use super::super::isosurfaces::Isosurfaces;
use super::super::palette::Palette;
use super::super::threshold::{Edge, LEAST_ABOVE, above_margin, border_level, otsu};
use super::{Found, Stop, rising, through};
use crate::data::{Histogram, Volume};

/// Shows what is dark: as what is bright is shown, on a scale that is turned around.
pub(super) fn find(volume: &Volume, histogram: &Histogram) -> Found {
    let mut counts = histogram.counts.clone();
    counts.reverse();
    // Darkness: 0 at the highest value, 1 at the lowest.
    let darkness = Histogram { counts, total: histogram.total };
    let split = otsu(&darkness);
    // How dark the surroundings are, but for a few voxels.
    let around = border_level(volume, |density| 1.0 - density);
    let margin = if around < split { around } else { 0.0 };
    // Never so dark that nothing is left.
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
