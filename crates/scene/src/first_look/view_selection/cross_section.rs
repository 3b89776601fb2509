//! Cross sections of an object near the faces of its volume, and the share of them that its densest material
//! encloses. Sections are in index space, and materials told by densities.

use std::ops::Range;

use super::super::threshold::otsu_threshold;
use super::super::{MIN_VISIBLE_OPACITY, histogram_above};
use crate::Settings;
use chiaroscuro_volume::{Histogram, Volume};

/// Number of pixels along the longer edge of a section in which dense rings are sought: with a few millimetres each,
/// as thick as the bone that closes them.
const SECTION_PIXELS: usize = 64;

/// Sections that are tried at a face, at these shares of the volume's height from it: bone may have gaps.
const DEPTHS: [f64; 3] = [0.0, 0.015, 0.03];

/// Densities at which an object and its densest material begin.
#[derive(Debug, Clone, Copy)]
pub(super) struct MaterialStarts {
    object: f64,
    dense: f64,
}

impl MaterialStarts {
    /// Finds where the object of a look begins, and its densest material: halfway between the most frequent densities
    /// on either side of Otsu's split, for thin bone is dimmed by what is beside it.
    pub(super) fn find(look: &Settings, volume: &Volume, histogram: &Histogram) -> Self {
        let transfer = &look.layer().transfer;
        let bins = histogram.counts.len();
        let density = |bin: usize| bin as f64 / bins as f64;
        let is_visible =
            |bin: &usize| transfer.opacity_at(volume.value_of(density(*bin))) > MIN_VISIBLE_OPACITY;
        let object = (0..bins).find(is_visible).map_or(1.0, density);
        let of_object = histogram_above(histogram, object);
        let split = ((otsu_threshold(&of_object) * bins as f64) as usize).min(bins);
        let mode = |part: Range<usize>| part.max_by_key(|&bin| of_object.counts[bin]).map(density);
        let [soft, dense] = [0..split, split..bins].map(mode);
        let dense = f64::midpoint(soft.unwrap_or(object).max(object), dense.unwrap_or(1.0));
        Self { object, dense }
    }
}

/// Returns the share of the sections near a face that dense material encloses, the largest of a few. The face lies at
/// the first or the last index along an axis.
pub(super) fn enclosed_share(volume: &Volume, axis: usize, is_last: bool, starts: MaterialStarts) -> f64 {
    let last = volume.dims()[axis] - 1;
    let share = |depth: f64| {
        let layer = (depth * last as f64).ceil() as usize;
        CrossSection::new(volume, axis, if is_last { last - layer } else { layer }, starts).enclosed_share()
    };
    DEPTHS.into_iter().map(share).fold(0.0, f64::max)
}

/// Densest material in a pixel of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum SectionMaterial {
    None,
    Soft,
    Dense,
}

/// Section through an object across an index axis, with a margin of one pixel.
struct CrossSection {
    width: usize,
    height: usize,
    materials: Vec<SectionMaterial>,
}

impl CrossSection {
    fn new(volume: &Volume, axis: usize, layer: usize, starts: MaterialStarts) -> Self {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        let dims = volume.dims();
        let step = dims[u].max(dims[v]).div_ceil(SECTION_PIXELS);
        // The outside is filled from the margin.
        let (width, height) = (dims[u].div_ceil(step) + 2, dims[v].div_ceil(step) + 2);
        let mut materials = vec![SectionMaterial::None; width * height];
        for (y, x) in (0..dims[v]).flat_map(|y| (0..dims[u]).map(move |x| (y, x))) {
            let mut place = [0; 3];
            (place[axis], place[u], place[v]) = (layer, x, y);
            let material = match volume.density_at(place) {
                Some(density) if density >= starts.dense => SectionMaterial::Dense,
                Some(density) if density >= starts.object => SectionMaterial::Soft,
                _ => SectionMaterial::None,
            };
            let pixel = &mut materials[(y / step + 1) * width + x / step + 1];
            *pixel = material.max(*pixel);
        }
        Self { width, height, materials }
    }

    /// Returns the share of the object's pixels that dense material encloses.
    fn enclosed_share(&self) -> f64 {
        let mut is_outside = vec![false; self.materials.len()];
        let mut waiting = vec![0];
        while let Some(at) = waiting.pop() {
            if std::mem::replace(&mut is_outside[at], true) {
                continue;
            }
            let (x, y) = (at % self.width, at / self.width);
            // Diagonal neighbours of dense pixels close a ring.
            let beside = [
                (x > 0, at.wrapping_sub(1)),
                (x + 1 < self.width, at + 1),
                (y > 0, at.wrapping_sub(self.width)),
                (y + 1 < self.height, at + self.width),
            ];
            let open = beside.into_iter().filter(|(is_there, _)| *is_there).map(|(_, next)| next);
            waiting.extend(
                open.filter(|&next| !is_outside[next] && self.materials[next] != SectionMaterial::Dense),
            );
        }
        let of_object = self.materials.iter().filter(|material| **material != SectionMaterial::None).count();
        let is_enclosed = |(material, is_outside): &(&SectionMaterial, &bool)| {
            **material == SectionMaterial::Soft && !**is_outside
        };
        let enclosed = self.materials.iter().zip(&is_outside).filter(is_enclosed).count();
        enclosed as f64 / of_object.max(1) as f64
    }
}
