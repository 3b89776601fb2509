//! Gradient noise (Perlin) and its fractal sum, from an integer hash: identical on every machine.
//!
//! After K. Perlin, "Improving noise", SIGGRAPH 2002, with a hash in place of the permutation table.

use glam::DVec3;

/// Gradient vectors: from the centre of a cube to the midpoints of its twelve edges.
const GRADIENTS: [DVec3; 12] = [
    DVec3::new(1.0, 1.0, 0.0),
    DVec3::new(-1.0, 1.0, 0.0),
    DVec3::new(1.0, -1.0, 0.0),
    DVec3::new(-1.0, -1.0, 0.0),
    DVec3::new(1.0, 0.0, 1.0),
    DVec3::new(-1.0, 0.0, 1.0),
    DVec3::new(1.0, 0.0, -1.0),
    DVec3::new(-1.0, 0.0, -1.0),
    DVec3::new(0.0, 1.0, 1.0),
    DVec3::new(0.0, -1.0, 1.0),
    DVec3::new(0.0, 1.0, -1.0),
    DVec3::new(0.0, -1.0, -1.0),
];

/// Returns fractal noise around 0, within about ±0.6: each octave has half the size and half the amplitude of the one
/// before.
pub(super) fn fractal(p: DVec3, octaves: u32) -> f64 {
    let mut sum = 0.0;
    let mut height = 0.5;
    let mut at = p;
    for octave in 0..octaves {
        sum += height * gradient(at, octave);
        height *= 0.5;
        // Not exactly 2: the lattices of the octaves, where noise is 0, must not coincide.
        at = at * 2.03 + 17.3;
    }
    sum
}

/// Returns gradient noise of one lattice, within about ±1, smooth up to its second derivative.
fn gradient(p: DVec3, seed: u32) -> f64 {
    let cell = p.floor();
    let inside = p - cell;
    let fade = inside * inside * inside * (inside * (inside * 6.0 - 15.0) + 10.0);
    let corner = |dx: i32, dy: i32, dz: i32| {
        let [x, y, z] = [cell.x as i32 + dx, cell.y as i32 + dy, cell.z as i32 + dz];
        let choice = hash(x, y, z, seed) % GRADIENTS.len() as u32;
        GRADIENTS[choice as usize].dot(inside - DVec3::new(f64::from(dx), f64::from(dy), f64::from(dz)))
    };
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let along_x = |dy: i32, dz: i32| mix(corner(0, dy, dz), corner(1, dy, dz), fade.x);
    let along_y = |dz: i32| mix(along_x(0, dz), along_x(1, dz), fade.y);
    mix(along_y(0), along_y(1), fade.z)
}

/// Hashes a lattice point and a seed: a multiplication each, then the finalizer of `MurmurHash3`.
fn hash(x: i32, y: i32, z: i32, seed: u32) -> u32 {
    let mut h = (x as u32).wrapping_mul(0x8da6_b343)
        ^ (y as u32).wrapping_mul(0xd816_3841)
        ^ (z as u32).wrapping_mul(0xcb1a_b31f)
        ^ seed.wrapping_mul(0x9e37_79b9);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_smooth_and_centred() {
        let mut sum = 0.0;
        let mut largest: f64 = 0.0;
        for i in 0..4000 {
            let p = DVec3::new(f64::from(i) * 0.37 - 700.0, f64::from(i % 61) * 0.53, f64::from(i % 7) * 1.1);
            let value = fractal(p, 5);
            sum += value;
            largest = largest.max(value.abs());
            assert!((fractal(p + 1e-6, 5) - value).abs() < 1e-4, "{p}");
        }
        assert!((sum / 4000.0).abs() < 0.05, "{sum}");
        assert!(largest > 0.2 && largest < 1.0, "{largest}");
    }

    #[test]
    fn noise_is_zero_on_its_lattice() {
        assert_eq!(gradient(DVec3::new(3.0, -2.0, 5.0), 1), 0.0);
    }
}
