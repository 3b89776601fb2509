//! Brightest light of an environment map: the sun, a lamp, a window.

use std::f64::consts::PI;

use glam::DVec3;

use super::BrightLight;
use super::panorama::Panorama;
use chiaroscuro_volume::math::luminance;

/// Thresholds of a light's region, as shares of its peak brightness, tried in order. The sun's rim is half as bright
/// as its centre, and glare around it a hundredth. If a region at one threshold is too large for a light, the next
/// one is tried.
const PEAK_SHARES: [f64; 3] = [1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];

/// Maximum angular diameter of a light, in degrees. A larger region is a sky: windows span this angle from a room's
/// middle.
const MAX_LIGHT_DEG: f64 = 70.0;

/// Minimum share of the total light; a weaker light casts no visible shadow.
const MIN_LIGHT_SHARE: f64 = 0.08;

/// Finds the brightest light and removes it from the panorama: its region gets the mean radiance of its border.
/// `None` if no light stands out.
pub(super) fn extract_brightest_light(panorama: &mut Panorama) -> Option<BrightLight> {
    let brightness: Vec<f64> = panorama.cells().map(|cell| luminance(cell.radiance)).collect();
    let (peak, &most) = brightness.iter().enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let found = PEAK_SHARES
        .into_iter()
        .find_map(|share| BrightRegion::flood_fill(panorama, &brightness, peak, share * most));
    let BrightRegion { cells: inside, border_radiance: around, solid_angle } = found?;
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
    if luminance(flux) < MIN_LIGHT_SHARE * all || largest <= 0.0 {
        return None;
    }
    let towards = towards.try_normalize()?;
    for at in inside {
        panorama.set(at, around);
    }
    Some(BrightLight {
        direction: towards,
        color: flux.map(|c| c / largest),
        // The radiance reflected by a white surface is irradiance over π.
        intensity: largest / PI,
        angle_deg: cap_diameter_deg(solid_angle),
    })
}

/// Returns the angular diameter, in degrees, of the spherical cap with a solid angle of 2π (1 − cos r).
fn cap_diameter_deg(solid_angle: f64) -> f64 {
    2.0 * (1.0 - solid_angle / (2.0 * PI)).clamp(-1.0, 1.0).acos().to_degrees()
}

/// Connected component of cells that are at least as bright as a threshold.
struct BrightRegion {
    cells: Vec<usize>,
    /// Mean radiance of the cells at the border.
    border_radiance: [f64; 3],
    solid_angle: f64,
}

impl BrightRegion {
    /// Flood fills from cell `first`; `None` if the component is wider than any light, or covers the whole panorama.
    fn flood_fill(panorama: &Panorama, brightness: &[f64], first: usize, threshold: f64) -> Option<Self> {
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
            if cap_diameter_deg(solid_angle) > MAX_LIGHT_DEG {
                return None;
            }
            for next in panorama.neighbours(at) {
                if !seen[next] {
                    seen[next] = true;
                    waiting.push(next);
                }
            }
        }
        let around = around.map(|sum| sum / border.max(1) as f64);
        (border > 0).then_some(Self { cells: inside, border_radiance: around, solid_angle })
    }
}
