//! Rays through a pixel for antialiasing: fixed places in the pixel, and shifts of the slabs along each ray.

use crate::plan::geometry::eye_frame::slab_parts;
use crate::plan::geometry::sheet_frame::SheetFrame;
use chiaroscuro_scene::{OutputSettings, Settings};

/// Ray through a pixel, relative to the one through its middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelRay {
    /// Offset on the picture, right and down, in pixels: −½ … ½.
    pub offset: [f64; 2],
    /// Shift of the slabs away from the eye, in thickest slabs: 0 … 1.
    pub phase: f64,
}

/// Places of four rays: in eighths of a pixel right and down of its middle, and the shift of slabs in quarters.
///
/// As in all sets each column and each row of a grid has one ray, so that coverage grows in even steps when an edge
/// close to upright or level passes; and shifts are evenly spaced, in an order that is hardly correlated with places.
/// The places are those of Direct3D's standard multisample patterns, which graphics cards have.
const FOUR: [[i32; 3]; 4] = [[-1, -3, 0], [3, -1, 2], [1, 3, 1], [-3, 1, 3]];

/// Places of eight rays, in sixteenths of a pixel, and shifts in eighths.
const EIGHT: [[i32; 3]; 8] =
    [[1, -3, 0], [-1, 3, 4], [5, 1, 2], [-3, -5, 6], [-5, 5, 1], [-7, -1, 5], [3, 7, 3], [7, -7, 7]];

/// Places of sixteen rays, in 32nds of a pixel, and shifts in sixteenths.
const SIXTEEN: [[i32; 3]; 16] = [
    [3, 3, 0],
    [-1, -5, 8],
    [-5, 5, 4],
    [9, -1, 12],
    [-9, -3, 2],
    [5, 11, 10],
    [11, 7, 6],
    [7, -9, 14],
    [-3, 13, 1],
    [1, -13, 9],
    [-7, -11, 5],
    [-11, 9, 13],
    [-15, 1, 3],
    [15, -7, 11],
    [13, 15, 7],
    [-13, -15, 15],
];

impl PixelRay {
    /// Returns the rays through each pixel for a number of them, of which the nearest possible one serves; none
    /// beside the ray through the middle for 1.
    pub fn set(count: u32) -> Vec<Self> {
        let places: &[[i32; 3]] = match OutputSettings::nearest_antialiasing(count) {
            4 => &FOUR,
            8 => &EIGHT,
            16 => &SIXTEEN,
            _ => &[],
        };
        let count = places.len() as f64;
        let ray = |&[x, y, shift]: &[i32; 3]| Self {
            offset: [x, y].map(|place| f64::from(place) / (2.0 * count)),
            phase: f64::from(shift) / count,
        };
        places.iter().map(ray).collect()
    }

    /// Returns the contrast of the faintest edges that have `count` rays, as a share of the light: a quarter of that
    /// of the steps in which rays divide an edge.
    ///
    /// With one ray, coverage is off by half a step at most: where fainter edges keep one, by an eighth of the
    /// brightness of a ray's share, with four rays 3.5 of 255 grey steps at white and less than 2 at middle grey.
    pub fn min_contrast(count: u32) -> f64 {
        0.25 / f64::from(count.max(1))
    }
}

impl SheetFrame {
    /// Returns the frame whose pixels' middles lie where this ray crosses the pixels of the frame, with slabs shifted
    /// by the ray's phase; `settings` are those of the frame.
    ///
    /// One more of the thickest slabs in front covers what the shift uncovers, except in front of an eye amid the
    /// volume, where it would lie behind the eye.
    #[must_use]
    pub fn for_pixel_ray(&self, ray: PixelRay, settings: &Settings) -> Self {
        let [i, j] = ray.offset;
        let parts = slab_parts(settings);
        let thickest = self.slab * f64::from(parts);
        let is_in_front = 1.0 + (self.first_depth - thickest) * self.inverse_distance > 0.0;
        let added = if ray.phase > 0.0 && is_in_front { parts } else { 0 };
        let mut moved = self.clone();
        moved.origin.base = self.origin.at(i, j);
        moved.direction.base = self.direction.at(i, j);
        moved.slope.base = self.slope.at(i, j);
        moved.first_depth += ray.phase * thickest - f64::from(added) * self.slab;
        moved.slab_count += added;
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::picture_frame;
    use chiaroscuro_scene::{ANTIALIASING_RAYS, Camera, SamplingSettings, SlabMode};
    use chiaroscuro_volume::math::SceneSpace;

    #[test]
    fn places_are_centred_and_shifts_are_even() {
        for count in ANTIALIASING_RAYS {
            let rays = PixelRay::set(count);
            if count == 1 {
                assert!(rays.is_empty());
                continue;
            }
            assert_eq!(rays.len(), count as usize);
            for axis in 0..2 {
                let mut places: Vec<_> = rays.iter().map(|ray| ray.offset[axis]).collect();
                places.sort_by(f64::total_cmp);
                // One ray in the middle of each column or row.
                let wanted = (0..count).map(|k| (f64::from(k) + 0.5) / f64::from(count) - 0.5);
                assert!(wanted.zip(&places).all(|(a, b)| (a - b).abs() < 1e-12), "{count}: {places:?}");
            }
            let mut phases: Vec<_> = rays.iter().map(|ray| ray.phase * f64::from(count)).collect();
            phases.sort_by(f64::total_cmp);
            assert!(phases.iter().zip(0..).all(|(a, k)| (a - f64::from(k)).abs() < 1e-12), "{phases:?}");
        }
        assert_eq!(PixelRay::set(5), PixelRay::set(4));
    }

    #[test]
    fn rays_see_what_lies_beside_the_middle_and_slabs_still_cover_the_material() {
        let scene = SceneSpace::new([40, 30, 20], glam::DAffine3::IDENTITY);
        for slabs in [SlabMode::Even, SlabMode::ByNeed, SlabMode::Preintegrated] {
            let settings = Settings {
                sampling: SamplingSettings { slabs, ..SamplingSettings::default() },
                ..Settings::default()
            };
            let frame = picture_frame(&settings, &scene, [64, 48]);
            let parts = f64::from(slab_parts(&settings));
            for ray in PixelRay::set(8) {
                let moved = frame.for_pixel_ray(ray, &settings);
                let [i, j] = ray.offset;
                let apart = moved.point(3.0, 5.0, 0.2) - frame.point(3.0 + i, 5.0 + j, 0.2);
                assert!(apart.length() < 1e-9, "{apart}");
                let end = |frame: &SheetFrame| frame.first_depth + f64::from(frame.slab_count) * frame.slab;
                assert!(moved.first_depth <= frame.first_depth && end(&moved) >= end(&frame) - 1e-9);
                let shift = (moved.first_depth - frame.first_depth) / (frame.slab * parts);
                assert!((shift.rem_euclid(1.0) - ray.phase).abs() < 1e-9, "{shift}");
            }
        }
    }

    #[test]
    fn no_slab_is_added_behind_an_eye_amid_the_volume() {
        let scene = SceneSpace::new([40; 3], glam::DAffine3::IDENTITY);
        let camera = Camera { distance: 0.1, ..Camera::default() };
        let settings = Settings { camera, ..Settings::default() };
        let frame = picture_frame(&settings, &scene, [64, 48]);
        for ray in PixelRay::set(4) {
            let moved = frame.for_pixel_ray(ray, &settings);
            assert!(moved.first_depth >= frame.first_depth && moved.slab_count == frame.slab_count);
        }
    }
}
