//! The brightest light of surroundings: the sun, a lamp, a window.

use std::f64::consts::PI;

use glam::DVec3;

use super::BrightLight;
use super::panorama::Panorama;
use crate::math::luminance;

/// What belongs to a light is at least this share as bright as its brightest part: the sun's rim is half as bright as its
/// middle, and glare around it a hundredth. Where so much of the surroundings is as bright that it is no light, only what is
/// brighter can be one.
const OF_PEAK: [f64; 3] = [1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];

/// What looks wider than this from the volume is no light but a sky: windows do so from a room's middle.
const WIDEST_DEG: f64 = 70.0;

/// A light that gives less than this share of all light does not stand out: it makes no shadow that one sees.
const LEAST_SHARE: f64 = 0.08;

/// Finds the light and takes it out: where it was is as bright as around it. `None` where none stands out.
pub(super) fn take(panorama: &mut Panorama) -> Option<BrightLight> {
    let brightness: Vec<f64> = panorama.cells().map(|cell| luminance(cell.radiance)).collect();
    let (peak, &most) = brightness.iter().enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let found =
        OF_PEAK.into_iter().find_map(|share| Patch::around(panorama, &brightness, peak, share * most));
    let Patch { inside, around, solid_angle } = found?;
    let (mut flux, mut towards) = ([0.0; 3], DVec3::ZERO);
    for &at in &inside {
        let cell = panorama.cell(at);
        let more: [f64; 3] =
            std::array::from_fn(|c| (cell.radiance[c] - around[c]).max(0.0) * cell.solid_angle);
        towards += cell.towards * luminance(more);
        (0..3).for_each(|c| flux[c] += more[c]);
    }
    let all: f64 = panorama.cells().map(|cell| luminance(cell.radiance) * cell.solid_angle).sum();
    let largest = flux.into_iter().fold(0.0, f64::max);
    if luminance(flux) < LEAST_SHARE * all || largest <= 0.0 {
        return None;
    }
    let towards = towards.try_normalize()?;
    for at in inside {
        panorama.set(at, around);
    }
    Some(BrightLight {
        towards,
        color: flux.map(|c| c / largest),
        // A white surface gives back irradiance over π.
        intensity: largest / PI,
        angle_deg: cap_deg(solid_angle),
    })
}

/// The width of the cap of a sphere that has a solid angle, 2π (1 − cos r), in degrees.
fn cap_deg(solid_angle: f64) -> f64 {
    2.0 * (1.0 - solid_angle / (2.0 * PI)).clamp(-1.0, 1.0).acos().to_degrees()
}

/// Cells around one of them that are as bright as a threshold, and hang together.
struct Patch {
    inside: Vec<usize>,
    /// The mean radiance of those that border on it.
    around: [f64; 3],
    solid_angle: f64,
}

impl Patch {
    /// `None` where it is wider than any light, or all there is.
    fn around(panorama: &Panorama, brightness: &[f64], first: usize, threshold: f64) -> Option<Self> {
        let (mut inside, mut seen, mut waiting) = (Vec::new(), vec![false; brightness.len()], vec![first]);
        let (mut around, mut border, mut solid_angle) = ([0.0; 3], 0usize, 0.0);
        seen[first] = true;
        while let Some(at) = waiting.pop() {
            let cell = panorama.cell(at);
            if brightness[at] < threshold {
                (0..3).for_each(|c| around[c] += cell.radiance[c]);
                border += 1;
                continue;
            }
            inside.push(at);
            solid_angle += cell.solid_angle;
            if cap_deg(solid_angle) > WIDEST_DEG {
                return None;
            }
            for next in panorama.beside(at) {
                if !seen[next] {
                    seen[next] = true;
                    waiting.push(next);
                }
            }
        }
        let around = around.map(|sum| sum / border.max(1) as f64);
        (border > 0).then_some(Self { inside, around, solid_angle })
    }
}
