//! Direction sets: unit vectors all around and above, from which the light of a sky is followed.
//!
//! The sets of 24, 48 and 96 directions are orbits of the cube's 48 symmetries, so that a scene whose volume, camera,
//! lights and sky are turned by quarter turns or mirrored looks the same. All directions of a set count alike, and −ω
//! is in a set with ω: any plane hides exactly half of them. No direction lies in a face of the grid. Lebedev's sets of
//! 26 and 50 have 34 and 14 % of their weight there, and an open plate along a face is 13 and 6 % too bright in them,
//! or 21 and 8 % too dark, depending on which side of it those directions pass.
//!
//! The sets of 6 and 12, for previews, are an octahedron and an icosahedron that are turned off the axes.
//!
//! In all sets the mean of |x|, |y| and |z| is 1/2 as over the sphere, within 0.1 % in the largest: the light of an
//! open plate along a face, and what a layer along a face lets through, are exact.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::{DQuat, DVec3, EulerRot, Vec3Swizzles as _};

/// Numbers of directions for the sky's light, each in a set of its own. Fewer look patchy, more look no better.
pub const SKY_DIRECTION_SETS: [u32; 5] = [6, 12, 24, 48, 96];

/// Golden ratio minus one: the fractional parts of its multiples fill 0 … 1 evenly for any count.
const GOLDEN_FRACTION: f64 = 0.618_033_988_749_894_9;

/// Returns the size of the set that serves a number of directions: the nearest, and of two equally near ones the
/// smaller.
pub fn sky_direction_set(directions: u32) -> u32 {
    let nearest = SKY_DIRECTION_SETS.into_iter().min_by_key(|set| set.abs_diff(directions));
    nearest.unwrap_or(SKY_DIRECTION_SETS[0])
}

/// Returns unit vectors all around, each of equal weight: the set that serves `count` directions.
///
/// Polynomials of the direction up to degree 3, 5, 3, 5 and 9 have their exact mean over the sets.
pub fn sweep_directions(count: u32) -> Vec<DVec3> {
    match sky_direction_set(count) {
        6 => turned_off_the_axes([74.5496, 20.2118, 15.4504], [DVec3::X, DVec3::Y, DVec3::Z].into()),
        12 => turned_off_the_axes([11.8088, 9.6068, 11.8088], half_icosahedron()),
        24 => {
            // Components l, l and m with 2 l² + m² = 1 and 2 l + m = 3/2: 6 l² − 6 l + 5/4 = 0. Of both roots the
            // smaller has its largest component alone, so that rays have one axis to follow.
            let small = ((6.0 - 6f64.sqrt()) / 12.0).powi(2);
            cube_orbit([small, small, 1.0 - 2.0 * small])
        }
        48 => {
            // The sum of the products of two squares has its mean over the sphere, 1/5. With the sum of components 3/2
            // that of the products of two is 5/8, and its square 1/5 + 2 abc · 3/2, so abc = 61/960.
            cube_orbit(squares(1.0 / 5.0, (61.0 / 960.0_f64).powi(2)))
        }
        _ => {
            // Two orbits with the means over the sphere of the sum of products of two squares, 1/5, of its square,
            // 1/21 = (1/5)² + apart², and of the product of all three, 1/105. These products may differ by any amount
            // that leaves three real squares, 0.0084 … 0.0094: with this one, components sum to 3/2 on average.
            let apart = 2.0 / (5.0 * 21f64.sqrt());
            let product_apart = 0.009;
            let orbit =
                |side: f64| cube_orbit(squares(1.0 / 5.0 + side * apart, 1.0 / 105.0 + side * product_apart));
            [orbit(1.0), orbit(-1.0)].concat()
        }
    }
}

/// Returns about `count` unit vectors of the hemisphere above, each of which contributes equally to the irradiance of
/// a surface that faces `up`; their number is a multiple of eight.
///
/// They are even over the disc under the hemisphere, so denser above than near the horizon, as the cosine demands:
/// eight each at the radius rᵢ = √((i + ½)/m), mirrored at the axes across `up` and their diagonals. Seen from above,
/// all orbits of eight have different angles.
pub fn directions_above(up: DVec3, count: u32) -> Vec<DVec3> {
    let orbits = (sky_direction_set(count) / 8).max(1);
    // Up is an axis of the scene, and these are the other two: which is which does not matter.
    let (right, front) = up.any_orthonormal_pair();
    let orbit = |i: u32| {
        let square = (f64::from(i) + 0.5) / f64::from(orbits);
        let angle = FRAC_PI_4 * (GOLDEN_FRACTION * (f64::from(i) + 0.5)).fract();
        let (sin, cos) = angle.sin_cos();
        let corners = [(cos, sin), (sin, cos), (-sin, cos), (-cos, sin)];
        let both = corners.into_iter().flat_map(|(x, y)| [(x, y), (-x, -y)]);
        both.map(move |(x, y)| (right * x + front * y) * square.sqrt() + up * (1.0 - square).sqrt())
    };
    (0..orbits).flat_map(orbit).collect()
}

/// Returns six of the corners of an icosahedron, the others being opposite.
fn half_icosahedron() -> Vec<DVec3> {
    let golden = 1.0 + GOLDEN_FRACTION;
    let corner = |side: f64| DVec3::new(0.0, 1.0, side * golden).normalize();
    [corner(1.0), corner(-1.0)].into_iter().flat_map(|corner| [corner, corner.yzx(), corner.zxy()]).collect()
}

/// Returns directions and their opposites, turned by angles about z, y and x in degrees. Of all angles with which the
/// means of |x|, |y| and |z| are 1/2, these keep them farthest from all planes in which the cube can be mirrored, 3.9°
/// for the octahedron and 2.7° for the icosahedron.
fn turned_off_the_axes(turn_deg: [f64; 3], half: Vec<DVec3>) -> Vec<DVec3> {
    let [x, y, z] = turn_deg.map(f64::to_radians);
    let turn = DQuat::from_euler(EulerRot::ZYX, x, y, z);
    half.into_iter().map(|direction| turn * direction).flat_map(|direction| [direction, -direction]).collect()
}

/// Returns the squares of a unit vector's components from the sum of the products of two of them and their product:
/// the roots of t³ − t² + `pairs` t − `product`, in ascending order.
fn squares(pairs: f64, product: f64) -> [f64; 3] {
    // t = s + 1/3 leaves s³ + p s + q, which has the roots 2 √(−p/3) cos((φ + 2πk)/3).
    let (p, q) = (pairs - 1.0 / 3.0, -2.0 / 27.0 + pairs / 3.0 - product);
    let radius = (-p / 3.0).sqrt();
    let angle = (-q / (2.0 * radius.powi(3))).clamp(-1.0, 1.0).acos();
    [1.0, 2.0, 0.0].map(|turn| 1.0 / 3.0 + 2.0 * radius * ((angle + 2.0 * PI * turn) / 3.0).cos())
}

/// Returns all directions that the cube's symmetries make of one, given by the squares of its components.
fn cube_orbit(squares: [f64; 3]) -> Vec<DVec3> {
    let [a, b, c] = squares.map(f64::sqrt);
    let mut orbit: Vec<DVec3> = Vec::new();
    for permuted in [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
        for signs in 0..8 {
            let side = |axis: usize| if signs >> axis & 1 == 0 { 1.0 } else { -1.0 };
            let direction = DVec3::from([0, 1, 2].map(|axis| side(axis) * permuted[axis]));
            // Components that are equal make some of them twice.
            if !orbit.contains(&direction) {
                orbit.push(direction);
            }
        }
    }
    orbit
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean over the sphere of a product of powers of x, y and z: Π (eᵢ − 1)!! / (e + 1)!!, or 0 for an odd power.
    fn mean_of_powers(powers: [i32; 3]) -> f64 {
        let double_factorial = |n: i32| (1..=n).rev().step_by(2).map(f64::from).product::<f64>();
        let even: f64 = powers.iter().map(|&e| double_factorial(e - 1)).product();
        if powers.iter().any(|e| e % 2 == 1) {
            0.0
        } else {
            even / double_factorial(powers.iter().sum::<i32>() + 1)
        }
    }

    /// Worst error of the mean of a product of powers up to a degree.
    fn worst_error(set: &[DVec3], degree: i32) -> f64 {
        let mut worst = 0.0_f64;
        for powers in
            (0..=degree).flat_map(|a| (0..=degree).flat_map(move |b| (0..=degree).map(move |c| [a, b, c])))
        {
            if powers.iter().sum::<i32>() > degree {
                continue;
            }
            let of = |at: &DVec3| at.x.powi(powers[0]) * at.y.powi(powers[1]) * at.z.powi(powers[2]);
            let mean = set.iter().map(of).sum::<f64>() / set.len() as f64;
            worst = worst.max((mean - mean_of_powers(powers)).abs());
        }
        worst
    }

    #[test]
    fn the_nearest_set_serves_any_number_of_directions() {
        let served = [0, 6, 9, 14, 18, 26, 36, 37, 64, 72, 73, 1000].map(sky_direction_set);
        assert_eq!(served, [6, 6, 6, 12, 12, 24, 24, 48, 48, 48, 96, 96]);
        for set in SKY_DIRECTION_SETS {
            assert_eq!(sweep_directions(set).len(), set as usize);
        }
    }

    #[test]
    fn polynomials_have_their_exact_mean_over_the_sets() {
        for (set, degree) in SKY_DIRECTION_SETS.into_iter().zip([3, 5, 3, 5, 9]) {
            let all = sweep_directions(set);
            assert!(all.iter().all(|towards| (towards.length() - 1.0).abs() < 1e-12), "{set}");
            assert!(worst_error(&all, degree) < 1e-12, "{set}: {}", worst_error(&all, degree));
            assert!(worst_error(&all, degree + 1) > 1e-6, "{set} integrates more than degree {degree}");
        }
    }

    #[test]
    fn the_cubes_symmetries_map_full_sets_to_themselves() {
        for set in [24, 48, 96] {
            let all = sweep_directions(set);
            // A cyclic exchange, a mirror and a swap make all 48.
            let symmetries: [fn(DVec3) -> DVec3; 3] =
                [|v| v.yzx(), |v| DVec3::new(-v.x, v.y, v.z), |v| DVec3::new(v.y, v.x, v.z)];
            for symmetry in symmetries {
                assert!(all.iter().all(|&towards| all.contains(&symmetry(towards))), "{set}");
            }
        }
    }

    #[test]
    fn no_direction_lies_in_a_face_or_follows_two_axes_alike() {
        for set in SKY_DIRECTION_SETS {
            for towards in sweep_directions(set) {
                let [a, b, c] = towards.abs().to_array();
                assert!(towards.abs().min_element() > 0.04, "{set}: {towards}");
                let largest = towards.abs().max_element();
                let alike = [a, b, c].into_iter().filter(|component| largest - component < 1e-3).count();
                assert_eq!(alike, 1, "{set}: {towards}");
            }
        }
    }

    /// Irradiance of open planes of all tilts, 1 in the mean over all directions: ½ + Σ |n·ω| / N.
    #[test]
    fn open_planes_are_as_bright_as_paper() {
        for (set, limit) in SKY_DIRECTION_SETS.into_iter().zip([0.17, 0.042, 0.028, 0.021, 0.01]) {
            let all = sweep_directions(set);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let mean = all.iter().map(|towards| towards.dot(axis).abs()).sum::<f64>() / all.len() as f64;
                assert!((mean - 0.5).abs() < if set == 96 { 5e-4 } else { 1e-5 }, "{set}: {mean}");
            }
            for normal in sweep_directions(96).into_iter().chain([DVec3::X, DVec3::ONE.normalize()]) {
                let facing = all.iter().map(|towards| towards.dot(normal).abs()).sum::<f64>();
                let found = 0.5 + facing / all.len() as f64;
                assert!((found - 1.0).abs() < limit, "{set}: {found} towards {normal}");
                let seen = all.iter().filter(|towards| towards.dot(normal) > 0.0).count();
                assert_eq!(seen, all.len() / 2, "{set} towards {normal}");
            }
        }
    }

    #[test]
    fn directions_above_light_what_faces_up_equally() {
        for up in [DVec3::Z, DVec3::NEG_Y] {
            for count in [6, 24, 48, 96] {
                let all = directions_above(up, count);
                let mean = all.iter().sum::<DVec3>() / all.len() as f64;
                // Mean of ω cos θ over π, divided by that of cos θ; one orbit is all at 45°.
                let limit = if count == 6 { 0.05 } else { 0.01 };
                assert!((mean - up * 2.0 / 3.0).length() < limit, "{count}: {mean}");
                let is_unit = |towards: &DVec3| (towards.length() - 1.0).abs() < 1e-12;
                assert!(all.iter().all(|towards| towards.dot(up) > 0.05 && is_unit(towards)), "{count}");
                let quarter = glam::DQuat::from_axis_angle(up, std::f64::consts::FRAC_PI_2);
                let has = |wanted: DVec3| all.iter().any(|found| found.distance(wanted) < 1e-12);
                assert!(all.iter().all(|&towards| has(quarter * towards)), "{count}: quarter turns");
                let across = up.any_orthonormal_vector();
                assert!(all.iter().all(|&v| has(v - 2.0 * v.dot(across) * across)), "{count}: mirrored");
            }
        }
    }
}
