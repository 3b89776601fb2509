//! Reorientation of a grid, so that its axes point to chosen sides of a body.

use glam::{DAffine3, DMat3, DVec3};

use chiaroscuro_volume::{AnatomicalAxes, AxisOrder};

/// Permutation of a grid's axes, and which of the resulting axes are reversed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct GridReorientation {
    pub(super) sources: [usize; 3],
    pub(super) is_reversed: [bool; 3],
}

impl GridReorientation {
    /// Finds the reorientation after which a grid's axes point to the given sides, as nearly as oblique axes can.
    pub(super) fn towards_sides(headings: AnatomicalAxes, world_from_index: DAffine3) -> Self {
        let axes = world_from_index.matrix3;
        let directions = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::normalize_or_zero);
        let sides = headings.directions();
        let along = |source: usize, side: DVec3| directions[source].dot(side);
        let nearness = |sources: &[usize; 3]| -> f64 {
            sources.iter().zip(sides).map(|(&source, side)| along(source, side).abs()).sum()
        };
        // Among equal candidates the first one wins, so that axes are not permuted without need.
        let orders = AxisOrder::ALL.map(AxisOrder::permutation);
        let sources = orders.into_iter().fold(orders[0], |best, order| {
            if nearness(&order) > nearness(&best) + 1e-9 { order } else { best }
        });
        let is_reversed = std::array::from_fn(|axis| along(sources[axis], sides[axis]) < 0.0);
        Self { sources, is_reversed }
    }

    /// Returns the transform from an index of the reoriented grid to the index of the same voxel in the original grid
    /// of `dims` voxels.
    pub(super) fn index_from_reoriented(self, dims: [usize; 3]) -> DAffine3 {
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

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn letters_are_of_three_axes() {
        let all: HashSet<String> = AnatomicalAxes::all().map(|headings| headings.to_string()).collect();
        assert_eq!(all.len(), 48);
        assert!(
            all.iter().all(|name| name.parse::<AnatomicalAxes>().is_ok_and(|own| own.to_string() == *name))
        );
        assert_eq!("ras".parse::<AnatomicalAxes>(), "RAS".parse());
        for text in ["", "RA", "RASS", "RLS", "RAX", "XYZ", "R A S", "RÄS"] {
            let said = text.parse::<AnatomicalAxes>().unwrap_err();
            assert!(said.contains("LPS"), "{text}: {said}");
        }
    }

    #[test]
    fn axes_go_where_the_letters_say() {
        // A large rotation about an oblique axis, and a mirroring: far from the identity.
        let askew = DMat3::from_axis_angle(DVec3::new(0.3, -0.9, 0.4).normalize(), 2.3);
        let matrix3 = askew * DMat3::from_diagonal(DVec3::new(0.5, 2.0, -3.0));
        let world_from_index = DAffine3 { matrix3, translation: DVec3::new(10.0, -20.0, 30.0) };
        let dims = [4, 5, 6];
        for name in AnatomicalAxes::all() {
            let sides = name.directions();
            let turn = GridReorientation::towards_sides(name, world_from_index);
            let turned = world_from_index * turn.index_from_reoriented(dims);
            let columns = [turned.matrix3.x_axis, turned.matrix3.y_axis, turned.matrix3.z_axis];
            let directions = columns.map(DVec3::normalize);
            // Every axis is nearer to its side than to the opposite one, and no other order is nearer.
            let along = |order: [usize; 3]| -> f64 {
                order.iter().zip(sides).map(|(&at, side)| directions[at].dot(side).abs()).sum()
            };
            assert!(
                directions.iter().zip(sides).all(|(direction, side)| direction.dot(side) > 0.0),
                "{name}"
            );
            let orders = AxisOrder::ALL.map(AxisOrder::permutation);
            assert!(orders.into_iter().all(|order| along(order) <= along([0, 1, 2]) + 1e-9), "{name}");
            // The corners of the box do not move.
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
