//! Revealing hidden materials in the first look: if an inner material is hardly visible, the outer one becomes a
//! veil.

mod optical_depth;
mod skin;
mod small_objects;
mod visibility;
mod voxel_clusters;

use std::ops::Range;

use super::domain::DataDomain;
use super::isosurfaces::IsosurfaceStatistics;
use super::threshold::otsu_threshold;
use super::{frame_largest_part, histogram_above, transfer};
use crate::{Settings, TransferFunction};
use chiaroscuro_volume::{Histogram, Volume};
pub(super) use skin::add_skin as with_skin;
pub(super) use small_objects::show_small_objects;
use visibility::AveragedCells;

/// Share of the object's voxels that an inner material may take: not a few specks, nor nearly all.
const INNER_SHARE: std::ops::RangeInclusive<f64> = 0.01..=0.7;

/// Depth of the histogram's valley between two materials, relative to the outer one's peak, below which they are
/// separate. Of 25 scans and simulations, textures of one material (tissue, concrete, noise) have 0.73 and more, and
/// objects of two (skin and bone, dentine and enamel, a head and its holder) at most 0.35.
const MAX_VALLEY_SHARE: f64 = 0.5;

/// Smallest compactness of a material: noise and thin walls between others are less compact.
const MIN_COMPACTNESS: f64 = 0.6;

/// Share of visible light below which a material is hidden, and the share that it should have afterwards. A skull
/// behind skin has 0.04 to 0.07 from any side; materials that need no revealing, such as the core of an atom, 0.15
/// and more.
const HIDDEN_SHARE: f64 = 0.1;
const REVEALED_SHARE: f64 = 0.5;

/// Opacity factors of the outer material, tried in order until the inner one is revealed.
const VEIL_OPACITIES: [f64; 5] = [0.5, 0.25, 0.12, 0.06, 0.03];

/// Half the width of the smoothing of histograms before valleys are searched, in bins: an eightieth of the scale,
/// three steps of 8-bit data.
const SMOOTHING: usize = 12;

/// Returns the settings with a veil around a hidden material; unchanged if none is hidden.
pub(super) fn reveal_inner_material(settings: Settings, volume: &Volume, histogram: &Histogram) -> Settings {
    let Some(density) = inner_material(&settings, volume, histogram) else { return settings };
    let Some(cells) = AveragedCells::average(volume, settings.layer().opacity_unit) else { return settings };
    let start = volume.value_of(density);
    let share = |function: &TransferFunction| {
        let seen = cells.visibility_by_bin(function, &settings.camera);
        let all: f64 = seen.iter().sum();
        seen.iter().skip(cells.value_bin(start)).sum::<f64>() / all.max(f64::MIN_POSITIVE)
    };
    if share(&settings.layer().transfer) >= HIDDEN_SHARE {
        return settings;
    }
    let channels = DataDomain::from_channels(volume);
    let veiled = VEIL_OPACITIES
        .map(|veil| transfer::veiled_transfer(&settings.layer().transfer, start, veil, channels));
    match veiled.into_iter().find(|function| share(function) >= REVEALED_SHARE) {
        Some(transfer) => settings.with_transfer(transfer),
        None => settings,
    }
}

/// Returns the density at which an inner material begins within the visible object; `None` if there is only one
/// material.
fn inner_material(settings: &Settings, volume: &Volume, histogram: &Histogram) -> Option<f64> {
    let bins = histogram.counts.len();
    let first = volume.density_of(settings.layer().transfer.points.first()?.value);
    let object = histogram_above(histogram, first);
    let cut = otsu_threshold(&object);
    let bin = |density: f64| ((density * bins as f64) as usize).min(bins - 1);
    let (start, split) = (bin(first), bin(cut));
    let inside = object.counts.iter().skip(split).sum::<u64>() as f64 / object.total.max(1) as f64;
    if !INNER_SHARE.contains(&inside) || split <= start {
        return None;
    }
    // Smoothed within one part of the histogram: counts beside it are not included.
    let smooth = |part: &Range<usize>, at: usize| {
        let (low, high) = (at.saturating_sub(SMOOTHING).max(part.start), (at + SMOOTHING + 1).min(part.end));
        object.counts[low..high].iter().sum::<u64>() as f64 / (high - low) as f64
    };
    let peak = |part: Range<usize>| {
        let height = |at: &usize| smooth(&part, *at);
        part.clone().max_by(|a, b| height(a).total_cmp(&height(b))).map(|at| (at, height(&at)))
    };
    let ((outer, height), (inner, _)) = (peak(start..split)?, peak(split..bins)?);
    let valley = (outer..=inner).map(|at| smooth(&(0..bins), at)).fold(f64::INFINITY, f64::min);
    let is_apart = valley < MAX_VALLEY_SHARE * height;
    (is_apart && IsosurfaceStatistics::measure(volume).compactness(cut) >= MIN_COMPACTNESS).then_some(cut)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::first_look::first_settings;
    use chiaroscuro_volume::Samples;

    /// Returns a ball of a dense material, with a centre and a radius, in a ball of a less dense one.
    fn balls(outer: f64, middle: [f64; 3], radius: f64, dense: u8) -> Volume {
        const N: usize = 48;
        let value = |at: usize| {
            let p = DVec3::from([at % N, at / N % N, at / N / N].map(|c| c as f64 - 23.5));
            if p.distance(middle.into()) < radius {
                dense
            } else if p.length() < outer {
                80 + (at % 5) as u8
            } else {
                0
            }
        };
        let samples = Samples::U8((0..N * N * N).map(value).collect());
        Volume::with_spacing("balls", [N; 3], DVec3::ONE, samples).unwrap()
    }

    fn opacities(volume: &Volume) -> [f64; 2] {
        let settings = first_settings(volume, &Histogram::from_volume(volume));
        [82.0, 220.0].map(|value| settings.layer().transfer.opacity_at(value))
    }

    #[test]
    fn what_lies_within_is_seen() {
        let volume = balls(20.0, [0.0; 3], 9.0, 220);
        let [outer, inner] = opacities(&volume);
        assert!(outer < 0.1 && inner > 0.5, "{outer} {inner}");
        let first = first_settings(&volume, &Histogram::from_volume(&volume));
        assert!(
            (0..80).any(|value| first.layer().transfer.opacity_at(f64::from(value)) > 0.01),
            "there is a skin"
        );
    }

    #[test]
    fn what_is_seen_or_alone_stays_opaque() {
        // The dense ball beside the other, in front of it, and without a difference in density.
        for volume in [
            balls(12.0, [0.0, 0.0, 16.0], 7.0, 220),
            balls(20.0, [8.0, -10.0, 9.0], 12.0, 220),
            balls(20.0, [0.0; 3], 9.0, 82),
        ] {
            let [outer, _] = opacities(&volume);
            assert!(outer > 0.2, "{outer}");
        }
    }
}
