//! Which way the axes of a grid go, in letters, and how a grid is turned so that they do.

use std::str::FromStr;

use glam::{DAffine3, DMat3, DVec3};

/// What the letters of an orientation may be.
const EXPECTED: &str = "three letters, one of R and L, one of A and P, one of S and I, such as RAS or LPS";

/// Sides of a body towards which the axes of a grid go, the fastest first: along `RAS` voxels follow each other to the
/// right, rows to the front, slices to the head.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Orientation([Side; 3]);

/// A side of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Side {
    /// The axis of the world (right, anterior, superior) on which it lies.
    axis: usize,
    is_positive: bool,
}

impl FromStr for Orientation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |letter: char| {
            let at = "RLAPSI".find(letter.to_ascii_uppercase())?;
            Some(Side { axis: at / 2, is_positive: at % 2 == 0 })
        };
        let sides: Option<Vec<Side>> = text.chars().take(4).map(side).collect();
        let sides: Option<[Side; 3]> = sides.and_then(|sides| sides.try_into().ok());
        sides
            .filter(|sides| (0..3).all(|axis| sides.iter().any(|side| side.axis == axis)))
            .map(Self)
            .ok_or_else(|| format!("expected {EXPECTED}, found {text:?}"))
    }
}

/// How a grid is turned: which of its axes become the first, second and third, and which of those are walked backwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Turn {
    pub(super) sources: [usize; 3],
    pub(super) is_reversed: [bool; 3],
}

/// All orders of three axes.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

impl Orientation {
    /// The turn after which the axes of a grid go where the letters say, as nearly as axes can that go askew.
    pub(super) fn turn(self, world_from_index: DAffine3) -> Turn {
        let axes = world_from_index.matrix3;
        let directions = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::normalize_or_zero);
        let along = |source: usize, side: Side| {
            directions[source][side.axis] * if side.is_positive { 1.0 } else { -1.0 }
        };
        let nearness = |sources: &[usize; 3]| -> f64 {
            sources.iter().zip(self.0).map(|(&source, side)| along(source, side).abs()).sum()
        };
        // Of equally near ones the first, so that nothing moves without need.
        let sources = ORDERS.into_iter().fold(ORDERS[0], |best, order| {
            if nearness(&order) > nearness(&best) + 1e-9 { order } else { best }
        });
        let is_reversed = std::array::from_fn(|axis| along(sources[axis], self.0[axis]) < 0.0);
        Turn { sources, is_reversed }
    }
}

impl Turn {
    /// Takes an index of the turned grid to that of the same voxel before, in a grid of `dims` voxels before.
    pub(super) fn index_from_turned(self, dims: [usize; 3]) -> DAffine3 {
        let mut matrix3 = DMat3::ZERO;
        let mut translation = DVec3::ZERO;
        for (axis, source) in self.sources.into_iter().enumerate() {
            let is_reversed = self.is_reversed[axis];
            matrix3.col_mut(axis)[source] = if is_reversed { -1.0 } else { 1.0 };
            translation[source] = if is_reversed { (dims[source] - 1) as f64 } else { 0.0 };
        }
        DAffine3 { matrix3, translation }
    }
}

/// All orientations that there are.
#[cfg(test)]
pub(super) fn all() -> Vec<String> {
    let pairs = [["R", "L"], ["A", "P"], ["S", "I"]];
    let signs = (0..8).map(|bits| [bits & 1, bits >> 1 & 1, bits >> 2 & 1]);
    let name = |signs: [usize; 3], order: [usize; 3]| order.map(|axis| pairs[axis][signs[axis]]).concat();
    signs.flat_map(|signs| ORDERS.map(|order| name(signs, order))).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn letters_are_of_three_axes() {
        let all = all();
        assert_eq!(all.iter().collect::<HashSet<_>>().len(), 48);
        assert!(all.iter().all(|name| name.parse::<Orientation>().is_ok()));
        assert_eq!("ras".parse::<Orientation>(), "RAS".parse());
        for text in ["", "RA", "RASS", "RLS", "RAX", "XYZ", "R A S", "RÄS"] {
            let said = text.parse::<Orientation>().unwrap_err();
            assert!(said.contains("LPS"), "{text}: {said}");
        }
    }

    #[test]
    fn axes_go_where_the_letters_say() {
        // Half a turn around a skewed axis, and mirrored: nothing of a unit matrix left.
        let askew = DMat3::from_axis_angle(DVec3::new(0.3, -0.9, 0.4).normalize(), 2.3);
        let matrix3 = askew * DMat3::from_diagonal(DVec3::new(0.5, 2.0, -3.0));
        let world_from_index = DAffine3 { matrix3, translation: DVec3::new(10.0, -20.0, 30.0) };
        let dims = [4, 5, 6];
        for name in all() {
            let orientation: Orientation = name.parse().unwrap();
            let turn = orientation.turn(world_from_index);
            let turned = world_from_index * turn.index_from_turned(dims);
            let columns = [turned.matrix3.x_axis, turned.matrix3.y_axis, turned.matrix3.z_axis];
            let directions = columns.map(DVec3::normalize);
            // Every axis is nearer to its side than to the opposite one, and no other order is nearer.
            let along = |order: [usize; 3]| -> f64 {
                order.iter().zip(orientation.0).map(|(&at, side)| directions[at][side.axis].abs()).sum()
            };
            for (direction, side) in directions.iter().zip(orientation.0) {
                assert_eq!(direction[side.axis] > 0.0, side.is_positive, "{name}");
            }
            assert!(ORDERS.into_iter().all(|order| along(order) <= along([0, 1, 2]) + 1e-9), "{name}");
            // The corners of the box are the same.
            let count = turn.sources.map(|source| dims[source]);
            let corner = |affine: DAffine3, count: [usize; 3], at: usize| {
                let index = std::array::from_fn(|axis| (at >> axis & 1) as f64 * (count[axis] - 1) as f64);
                affine.transform_point3(DVec3::from_array(index))
            };
            for at in 0..8 {
                let found = corner(turned, count, at);
                let is_same = |other| corner(world_from_index, dims, other).abs_diff_eq(found, 1e-9);
                assert!((0..8).any(is_same), "{name}: {found}");
            }
        }
    }
}
