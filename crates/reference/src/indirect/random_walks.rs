//! Random walks that estimate light in a medium, independent of fixed directions, of the number of bounces and of the
//! diffusion of later ones.

use glam::DVec3;

use super::bounces::ScatteringMedium;
use crate::Reference;

impl Reference<'_> {
    /// Estimates the mean light over all directions in a block by backward random walks from there: free paths by
    /// delta tracking (Woodcock, Murphy, Hemmings and Longworth 1965) through the interpolated extinction, isotropic
    /// directions. It converges to the true value with the number of walks, independent of other discretisation.
    pub fn light_by_walks(&self, medium: &ScatteringMedium, at: usize, walks: u32, seed: u64) -> [f64; 3] {
        let sampled_lights = self.active_lights();
        let sky = self.settings.sky.radiance(self.settings.camera.up);
        let own = self.settings.shading.emission / self.settings.scattering.albedo;
        let most = medium.extinction.iter().copied().fold(0.0, f64::max);
        let mut random = SplitMix64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ at as u64);
        let mut sum = [0.0; 3];
        for walk in 0..walks {
            let within = DVec3::new(random.next(), random.next(), random.next()) - 0.5;
            let mut block = medium.block(at) + within;
            let mut weight = [1.0; 3];
            let here = |block: DVec3| {
                self.light_at(medium, &sampled_lights, block, |along, distance| {
                    let step = 0.5 / along.abs().max_element();
                    (|_| 1.0, medium.optical_depth(block, along, (0.0, distance), step))
                })
            };
            sum.iter_mut().zip(here(block)).for_each(|(sum, light)| *sum += light);
            // First directions are stratified over the sphere, which reduces variance.
            let mut towards = unit_vector(
                1.0 - f64::from(2 * walk + 1) / f64::from(walks),
                f64::from(walk) * std::f64::consts::PI * (3.0 - 5f64.sqrt()),
            );
            while weight.iter().any(|&weight| weight > 1e-4) {
                let along = self.scene.index_from_scene.transform_vector3(towards) / medium.divisor as f64;
                block += along * (-random.next().ln() / most);
                if !medium.contains(block) {
                    if let Some(sky) = &sky {
                        for c in 0..3 {
                            sum[c] += weight[c] * (sky.mean[c] + sky.slope[c].dot(towards)).max(0.0);
                        }
                    }
                    break;
                }
                let (scattering, extinction) = medium.at(block);
                if random.next() * most >= extinction {
                    continue;
                }
                let light = here(block);
                for c in 0..3 {
                    weight[c] *= scattering[c] / extinction;
                    sum[c] += weight[c] * (light[c] + own);
                }
                towards = random.direction();
            }
        }
        sum.map(|sum| sum / f64::from(walks))
    }
}

/// Deterministic pseudo-random numbers: splitmix64 (Steele, Lea and Flood 2014).
struct SplitMix64(u64);

impl SplitMix64 {
    /// Returns a number above 0 and at most 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64 + f64::EPSILON / 2.0
    }

    /// Returns a unit vector, uniform over the sphere.
    fn direction(&mut self) -> DVec3 {
        unit_vector(2.0 * self.next() - 1.0, std::f64::consts::TAU * self.next())
    }
}

/// Returns the unit vector at a height and an angle about the axis.
fn unit_vector(z: f64, angle: f64) -> DVec3 {
    let across = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(across * angle.cos(), across * angle.sin(), z)
}
