//! Sky visibility in scenes with a known solution, on the reference and on the GPU.

use chiaroscuro_reference::{Reference, ReferenceOptions};
use chiaroscuro_scene::{LightVolumeResolution, Settings, SkyMode, SkySettings};
use chiaroscuro_volume::{Dataset, Samples, Volume};
use glam::DVec3;

use crate::common::new_renderer;
use crate::scenes::{self, linear_extinction};
use crate::thresholds::{SKY_VISIBILITY, SKY_VISIBILITY_AT_WALL};

/// White sky with a number of directions, at full resolution.
fn white_sky(directions: u32) -> SkySettings {
    SkySettings {
        mode: SkyMode::White,
        directions,
        resolution: LightVolumeResolution::Full,
        ..SkySettings::default()
    }
}

/// Sky-visibility moments at a voxel: V₁ and V₀.
struct VisibilityMoments {
    mean: f64,
    first: DVec3,
}

impl VisibilityMoments {
    /// Irradiance over π of a surface under a white sky of 1.
    fn on_a_surface(&self, normal: DVec3) -> f64 {
        self.mean + 2.0 * normal.dot(self.first)
    }
}

/// Sky-visibility moments of reference and GPU at some voxels of a scene, for a number of directions.
fn visibility_moments(
    dims: [usize; 3],
    (per_voxel, directions): (f64, u32),
    full: impl Fn(DVec3) -> f64,
    at: &[[usize; 3]],
) -> [Vec<VisibilityMoments>; 2] {
    let [nx, ny, nz] = dims;
    let place = |at: usize| DVec3::new((at % nx) as f64, (at / nx % ny) as f64, (at / (nx * ny)) as f64);
    let mut values: Vec<u8> = (0..nx * ny * nz).map(|at| (255.0 * full(place(at))).round() as u8).collect();
    // So that the values span their range.
    values[0] = 255 - values[0];
    let volume = Volume::with_spacing("sky", dims, DVec3::ONE, Samples::U8(values)).expect("a volume");
    let mut settings = Settings { sky: white_sky(directions), ..scenes::look() }
        .with_transfer(linear_extinction(per_voxel))
        .with_range(chiaroscuro_scene::DensityRange::Full);
    // Blocks hold what reaches them, not what reaches the surface that they belong to.
    scenes::make_isotropic(&mut settings);
    let index = |[x, y, z]: [usize; 3]| x + nx * (y + ny * z);
    let openness = Reference::new(&volume, &settings, ReferenceOptions::default()).sky_visibility();
    let reference = at
        .iter()
        .map(|&voxel| VisibilityMoments {
            mean: openness.mean_transmittance[index(voxel)],
            first: DVec3::from(openness.first_moment.each_ref().map(|values| values[index(voxel)])),
        })
        .collect();
    let mut renderer = new_renderer();
    let moments = renderer.sky_visibility(&Dataset::new(volume), &settings).expect("moments are read back");
    let gpu = at
        .iter()
        .map(|&voxel| {
            let [x, y, z, mean] = moments[index(voxel)].map(f64::from);
            VisibilityMoments { mean, first: DVec3::new(x, y, z) }
        })
        .collect();
    [reference, gpu]
}

fn assert_near(what: &str, found: f64, right: f64, limit: f64) {
    println!("{what}: {found:.4}, {right:.4} in closed form");
    assert!((found - right).abs() <= limit, "{what}: {found}, not {right}");
}

#[test]
fn empty_space_is_open() {
    for found in visibility_moments([12, 9, 15], (1.0, 48), |_| 0.0, &[[5, 4, 7], [11, 8, 14], [0, 8, 3]]) {
        for at in found {
            assert_near("mean", at.mean, 1.0, SKY_VISIBILITY);
            assert_near("first moment", at.first.length(), 0.0, SKY_VISIBILITY);
        }
    }
}

/// Mean transmittance to the sky from a point at distance r from the centre of a ball of radius R and extinction μ:
/// V₀(r) = ½ ∫ e^{−μ (√(R² − r²(1 − u²)) − r u)} du over the cosine u = −1 … 1.
fn ball_visibility(extinction: f64, radius: f64, r: f64) -> f64 {
    let n = 4000;
    let at = |i: u32| -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(n);
    let way = |u: f64| (radius * radius - r * r * (1.0 - u * u)).sqrt() - r * u;
    (0..n).map(|i| (-extinction * way(at(i))).exp()).sum::<f64>() / f64::from(n)
}

#[test]
fn a_ball_darkens_towards_its_middle() {
    const EXTINCTION: f64 = 0.075;
    const RADIUS: f64 = 27.0;
    let middle = DVec3::splat(29.0);
    let full = |p: DVec3| (0.5 + RADIUS - p.distance(middle)).clamp(0.0, 1.0);
    // Nearer to the surface, the kernel blurs it.
    let depths = [0, 13, 24];
    let at = depths.map(|r| [29 + r, 29, 29]);
    for found in visibility_moments([59; 3], (EXTINCTION, 48), full, &at) {
        for (found, r) in found.iter().zip(depths) {
            let right = ball_visibility(EXTINCTION, RADIUS, r as f64);
            assert_near(&format!("{r} voxels from the middle"), found.mean, right, SKY_VISIBILITY);
        }
    }
}

/// Height above a floor, in voxels, at which the kernel's blur of its surface does not affect rays. The lowest of 48
/// directions fall by 15°: within a few voxels they enter that blur, and it stops them. Those that rise clear it.
const HEIGHT_ABOVE_FLOOR: usize = 2;

/// Above an opaque floor half of the sky is visible: V₀ = ½, V₁ = n/4, and E = π.
#[test]
fn a_floor_sees_half_the_sky() {
    let full = |p: DVec3| if p.z < 3.5 { 1.0 } else { 0.0 };
    for found in visibility_moments([210, 210, 8], (9.0, 48), full, &[[105, 105, 4 + HEIGHT_ABOVE_FLOOR]]) {
        assert_near("mean", found[0].mean, 0.5, SKY_VISIBILITY);
        assert_near("first moment", found[0].first.z, 0.25, SKY_VISIBILITY);
        assert_near("across", found[0].first.truncate().length(), 0.0, SKY_VISIBILITY);
        assert_near("irradiance", found[0].on_a_surface(DVec3::Z), 1.0, 2.0 * SKY_VISIBILITY);
    }
}

/// A long wall of height a at a distance x hides a wedge of atan(a/x): V₀ = ½ (1 − α/π), E/π = ½ (1 + x/√(x² + a²)).
#[test]
fn a_wall_hides_a_wedge_of_the_sky() {
    const FLOOR: usize = 4;
    const TOP: usize = 18;
    // Voxels are full up to half a voxel before the next.
    let full = |p: DVec3| {
        let is_wall = p.x < 3.5 && p.z < TOP as f64 - 0.5;
        if p.z < FLOOR as f64 - 0.5 || is_wall { 1.0 } else { 0.0 }
    };
    let distances = [6, 12, 24];
    let at = distances.map(|x| [3 + x, 100, FLOOR + HEIGHT_ABOVE_FLOOR]);
    for found in visibility_moments([130, 200, 24], (9.0, 48), full, &at) {
        for (found, x) in found.iter().zip(distances) {
            let (x, height) = (x as f64 - 0.5, (TOP - FLOOR - HEIGHT_ABOVE_FLOOR) as f64 - 0.5);
            let wedge = (height / x).atan();
            let right = 0.5 * (1.0 - wedge / std::f64::consts::PI);
            assert_near(&format!("mean {x} away"), found.mean, right, SKY_VISIBILITY_AT_WALL);
            let right = 0.5 * (1.0 + x / (x * x + height * height).sqrt());
            assert_near(
                &format!("irradiance {x} away"),
                found.on_a_surface(DVec3::Z),
                right,
                2.0 * SKY_VISIBILITY_AT_WALL,
            );
        }
    }
}
