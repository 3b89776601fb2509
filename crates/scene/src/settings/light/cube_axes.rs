//! Cube axes: a pair of axes across any direction that turns with the scene. Quarter turns and mirrors of the scene map
//! the pairs of all directions to each other, up to their order and signs.

use glam::DVec3;

/// Sum below which all directions across are alike, as along a diagonal of the cube; far above rounding.
const ALIKE: f64 = 1e-9;

/// Returns two unit vectors across `forward` that form a right-handed system with it.
///
/// Each axis of the scene, seen along `forward`, votes for the directions at quarter turns from it, with the fourth
/// power of its length. On complex numbers, which quarter turns multiply by i, that is the sum of fourth powers. The
/// pair changes smoothly but for its order and signs, except around the four diagonals of the cube, along which three
/// axes at 120° cancel: there it is upright.
pub fn cube_axes(forward: DVec3) -> [DVec3; 2] {
    let (right, down) = forward.any_orthonormal_pair();
    let vote = |axis: DVec3| {
        let (x, y) = (axis.dot(right), axis.dot(down));
        let [real, imaginary] = [x * x - y * y, 2.0 * x * y];
        [real * real - imaginary * imaginary, 2.0 * real * imaginary]
    };
    let votes = [DVec3::X, DVec3::Y, DVec3::Z].map(vote);
    let [real, imaginary] = [0, 1].map(|part| votes.iter().map(|vote| vote[part]).sum::<f64>());
    let first = if (real * real + imaginary * imaginary).sqrt() < ALIKE {
        forward.cross(DVec3::Z).normalize_or(right)
    } else {
        let (sin, cos) = (imaginary.atan2(real) / 4.0).sin_cos();
        right * cos + down * sin
    };
    [first, forward.cross(first)]
}

#[cfg(test)]
mod tests {
    use glam::Vec3Swizzles as _;

    use super::*;

    /// Asserts that two pairs are the same up to order and signs.
    fn assert_same_cross(found: [DVec3; 2], wanted: [DVec3; 2], limit: f64, what: &str) {
        let aligned = wanted.map(|axis| axis.dot(found[0]).abs());
        let near = aligned[0].max(aligned[1]);
        assert!(1.0 - near < limit, "{what}: {found:?}, not {wanted:?}");
    }

    fn directions() -> impl Iterator<Item = DVec3> {
        let some = [
            [0.3, -0.5, 0.8],
            [1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [2.0, -2.0, 2.5],
            [0.9, 0.2, 0.9],
            [-0.01, 0.02, 0.99],
            [0.58, 0.57, 0.579],
        ];
        some.into_iter().map(|at| DVec3::from(at).normalize())
    }

    #[test]
    fn pairs_turn_and_mirror_with_the_scene() {
        let symmetries: [fn(DVec3) -> DVec3; 4] = [
            |v| v.yzx(),
            |v| DVec3::new(-v.x, v.y, v.z),
            |v| DVec3::new(-v.y, v.x, v.z),
            |v| DVec3::new(v.x, v.z, v.y),
        ];
        for forward in directions() {
            let pair = cube_axes(forward);
            assert!((pair[0].cross(pair[1]) - forward).length() < 1e-12, "right-handed");
            for symmetry in symmetries {
                let turned = cube_axes(symmetry(forward));
                assert_same_cross(turned, pair.map(symmetry), 1e-12, &format!("{forward}"));
            }
        }
    }

    #[test]
    fn pairs_lie_along_the_axes_seen_along_one() {
        for forward in [DVec3::Z, DVec3::NEG_X, DVec3::new(1.0, 0.0, -1.0).normalize()] {
            assert_same_cross(cube_axes(forward), [DVec3::Y, DVec3::Y.cross(forward)], 1e-12, "along a face");
        }
    }

    #[test]
    fn pairs_change_smoothly_away_from_the_diagonals() {
        let mut previous: Option<[DVec3; 2]> = None;
        for step in 0..=1440 {
            let angle = (f64::from(step) / 4.0).to_radians();
            let forward = DVec3::new(angle.cos() * 0.8, angle.sin() * 0.8, -0.6);
            let pair = cube_axes(forward);
            if let Some(previous) = previous {
                // Two degrees for a quarter of one.
                assert_same_cross(pair, previous, 6e-4, &format!("step {step}"));
            }
            previous = Some(pair);
        }
    }

    #[test]
    fn pairs_are_defined_along_the_diagonals() {
        for forward in [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0)].map(DVec3::normalize) {
            let pair = cube_axes(forward);
            assert!(pair[0].is_normalized() && pair[0].z.abs() < 1e-12, "{pair:?}");
        }
    }
}
