//! Hounsfield units: bone and contrast agent are opaque, flesh is not there.

use super::super::domain::Domain;
use super::super::palette::Palette;
use super::{Found, Stop, quantile, some_values, through};
use crate::data::Volume;

/// Hounsfield units at which bone and contrast agent begin: spongy bone and enhanced blood are above 130, organs below
/// 80 (100 with agent in them).
const BONE: f64 = 150.0;

/// Share of the voxels that are bone or agent, at least: less is noise, or a scan without any.
const LEAST_BONE: f64 = 0.0005;

/// Shows bone; nothing where there is none.
pub(super) fn find(volume: &Volume, water: f64) -> Option<Found> {
    let (mut all, start) = (0usize, water + BONE);
    let dense = some_values(volume, |value| {
        all += 1;
        (value >= start).then_some(value)
    });
    if (dense.len() as f64) < LEAST_BONE * all as f64 {
        return None;
    }
    // Where compact bone is, of what is dense; a scan of soft bones, or of agent alone, has less of it.
    let compact = quantile(&dense, 0.6).clamp(water + 300.0, water + 700.0);
    let hard = quantile(&dense, 0.97).clamp(compact + 150.0, water + 1600.0);
    let stops = [
        (start, 0.0, 0.0),
        (start + 0.3 * (compact - start), 0.25, 0.35),
        (compact, 0.6, 0.8),
        (hard, 0.9, 0.94),
        (water + 3000.0, 1.0, 0.97),
    ];
    let stops = stops.map(|(value, place, opacity)| Stop { value, place, opacity });
    Some(Found::of_values(through(stops, Palette::of(Domain::Bone)), Domain::Bone))
}
