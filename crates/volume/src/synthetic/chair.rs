//! Built-in volume `chair`: a wooden chair on a floor plate, a scene to demonstrate shadows.
//!
//! After the voxelised chair in figure 6 of M. Nulkar, K. Mueller, "Splatting with shadows", Volume Graphics 2001.
//! The chair faces −y, is 1.35 high and stands on a plate of 1.84 x 1.84.

use glam::DVec3;

use super::shapes::SdfShape;
use super::voxelise::ScenePart;

/// Voxel values, far enough apart for a transfer function to give each its own colour.
const WOOD: u8 = 200;
const CUSHION: u8 = 150;
const FLOOR: u8 = 90;

/// Height of the floor plate's top, where the legs begin.
const FLOOR_TOP: f64 = -0.74;

/// Depth by which the feet reach into the plate, to hide their round ends.
const FOOT_DEPTH: f64 = 0.03;

/// Lower end of the back posts, at the seat.
const BACK_FOOT: DVec3 = DVec3::new(0.30, 0.27, -0.12);

/// Upper end of the back posts; the top rail sits on them.
const BACK_TOP: DVec3 = DVec3::new(0.30, 0.41, 0.50);

/// Backward bow of the back in its middle, relative to the posts.
const BOW: f64 = 0.055;

/// Returns all parts of the scene.
pub(super) fn parts() -> Vec<ScenePart> {
    let floor = SdfShape::upright_box([0.0, 0.0, FLOOR_TOP - 0.05], [0.92, 0.92, 0.05], 0.015);
    let cushion = SdfShape::upright_box([0.0, -0.02, -0.055], [0.30, 0.27, 0.04], 0.04);
    let mut parts =
        vec![ScenePart { value: FLOOR, shape: floor }, ScenePart { value: CUSHION, shape: cushion }];
    let wood = [frame(), stretchers(), back()].into_iter().flatten();
    parts.extend(wood.map(|shape| ScenePart { value: WOOD, shape }));
    parts
}

/// Returns the seat, the apron and the legs.
fn frame() -> Vec<SdfShape> {
    let foot = FLOOR_TOP - FOOT_DEPTH;
    let mut shapes = vec![
        SdfShape::upright_box([0.0, 0.0, -0.115], [0.37, 0.35, 0.035], 0.03),
        SdfShape::upright_box([0.0, -0.265, -0.185], [0.28, 0.022, 0.05], 0.012),
        SdfShape::upright_box([0.0, 0.265, -0.185], [0.28, 0.022, 0.05], 0.012),
    ];
    for side in [-1.0, 1.0] {
        let front = [side * 0.295, -0.27, -0.15].into();
        let front_foot = [side * 0.325, -0.31, foot].into();
        let back = [side * BACK_FOOT.x, BACK_FOOT.y, BACK_FOOT.z].into();
        let back_foot = [side * 0.325, 0.34, foot].into();
        shapes.extend([
            SdfShape::upright_box([side * 0.29, 0.0, -0.185], [0.022, 0.26, 0.05], 0.012),
            SdfShape::Rod { from: front, to: front_foot, radii: [0.05, 0.036] },
            SdfShape::Rod { from: back, to: back_foot, radii: [0.05, 0.036] },
        ]);
    }
    shapes
}

/// Returns the rods between the legs: one on each side, one between these two, and one in front.
fn stretchers() -> Vec<SdfShape> {
    vec![
        SdfShape::rod([-0.315, -0.295, -0.54], [-0.315, 0.315, -0.54], 0.025),
        SdfShape::rod([0.315, -0.295, -0.54], [0.315, 0.315, -0.54], 0.025),
        SdfShape::rod([-0.315, 0.0, -0.54], [0.315, 0.0, -0.54], 0.025),
        SdfShape::rod([-0.31, -0.287, -0.42], [0.31, -0.287, -0.42], 0.025),
    ]
}

/// Returns the posts, the slats, and the rails above and below the slats, all leaning backwards.
fn back() -> Vec<SdfShape> {
    let lean = (BACK_TOP.y - BACK_FOOT.y) / (BACK_TOP.z - BACK_FOOT.z);
    let post_y = |z: f64| BACK_FOOT.y + lean * (z - BACK_FOOT.z);
    let rail = |z: f64, half: [f64; 3], crown: f64| SdfShape::Board {
        centre: DVec3::new(0.0, post_y(z), z),
        half: half.into(),
        radius: 0.022,
        bow: BOW,
        crown,
        lean,
    };
    let mut shapes = vec![rail(0.49, [0.365, 0.028, 0.075], 0.04), rail(0.06, [0.30, 0.024, 0.032], 0.0)];
    for side in [-1.0, 1.0] {
        let mirror = DVec3::new(side, 1.0, 1.0);
        shapes.push(SdfShape::Rod { from: BACK_FOOT * mirror, to: BACK_TOP * mirror, radii: [0.05, 0.036] });
    }
    for slat in -2..=2 {
        let x = f64::from(slat) * 0.1;
        // The slats follow the bow of the rails that hold them.
        let behind = BOW * (1.0 - (x / BACK_TOP.x).powi(2));
        let at = |z: f64, spread: f64| DVec3::new(x * spread, post_y(z) + behind, z);
        shapes.push(SdfShape::bar(at(0.06, 0.95), at(0.46, 1.05), 0.03, 0.02, 0.012));
    }
    shapes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::builtin;

    #[test]
    fn the_chair_stands_on_its_floor() {
        let volume = builtin("chair", Some(64)).unwrap();
        let at = |p: [f64; 3]| {
            let [x, y, z] = p.map(|p| ((p + 1.0) * 32.0) as usize);
            volume.value(x, y, z)
        };
        assert_eq!(at([0.8, -0.8, FLOOR_TOP - 0.05]), f64::from(FLOOR));
        assert_eq!(at([0.0, 0.0, -0.05]), f64::from(CUSHION));
        assert!(at([0.31, -0.29, -0.5]) > 150.0, "a leg");
        assert!(at([0.0, 0.0, -0.4]) < 1.0, "air below the seat");
        assert!(at([0.0, 0.46, 0.5]) > 150.0, "the top rail");
        assert!(at([0.0, 0.0, 0.8]) < 1.0, "air above");
        assert_eq!(volume.value_range(), (0.0, f64::from(WOOD)).into());
    }
}
