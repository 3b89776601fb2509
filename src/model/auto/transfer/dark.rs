//! An object that is darker than what is around it: opacity rises downwards.

use super::super::domain::Domain;
use super::super::palette::Palette;
use super::super::threshold::{border_level, otsu};
use super::{Found, Stop, through};
use crate::data::{Histogram, Volume};

/// As [`super::super::threshold`], with the scale turned around.
const TOWARDS_SPLIT: f64 = 0.65;

/// Shows what is dark.
pub(super) fn find(volume: &Volume, histogram: &Histogram) -> Found {
    let mut counts = histogram.counts.clone();
    counts.reverse();
    // Darkness: 0 at the highest value, 1 at the lowest.
    let darkness = Histogram { counts, total: histogram.total };
    let split = otsu(&darkness);
    // The darkest that the surroundings are, but for a few voxels.
    let around = border_level(volume, |density| 1.0 - density);
    let margin = if around < split { around } else { 0.0 };
    let start = (margin + TOWARDS_SPLIT * (split - margin)).max(margin + 0.02).min(0.98);
    let above = |share: f64| {
        let first = ((start * darkness.counts.len() as f64) as usize).min(darkness.counts.len() - 1);
        let mut counts = darkness.counts.clone();
        counts[..first].fill(0);
        let total = counts.iter().sum();
        Histogram { counts, total }.percentile(share)
    };
    let bulk = above(0.6).max(start + 0.04);
    let dark = above(0.97).max(bulk + 0.04);
    let stops = [
        (start, 0.0, 0.0),
        (start + 0.35 * (bulk - start), 0.2, 0.3),
        (bulk, 0.5, 0.65),
        (dark, 0.85, 0.88),
        (1.0f64.max(dark + 0.01), 1.0, 0.96),
    ];
    let domain = Domain::Unknown;
    let stops = stops.map(|(darkness, place, opacity)| Stop {
        value: volume.value_of((1.0 - darkness).max(0.0)),
        place,
        opacity,
    });
    Found::of_values(through(stops, Palette::of(domain)), domain)
}
