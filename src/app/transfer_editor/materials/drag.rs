//! Drags of materials: their ends, whole boxes, and new boxes.

use eframe::egui::{Pos2, Rect};

use super::plane::MaterialPlane;
use chiaroscuro_scene::{MAX_MATERIAL_BOXES, MaterialBox};

/// Distance from the border of a box within which it is grabbed, in points.
const GRAB_DISTANCE: f32 = 6.0;

/// Drag of the ends of a material: of one or two for borders and corners, or of all for the whole box.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxDrag {
    /// Index of the material.
    pub index: usize,
    /// True for the lower and the upper end of values and of changes that move.
    moves: [[bool; 2]; 2],
    /// Material at the beginning.
    start: MaterialBox,
    /// Place of the pointer at the beginning: value and change.
    from: [f64; 2],
}

impl BoxDrag {
    /// Begins a drag at a position: of a material under it, the selected one first, or of one that is added.
    pub(super) fn begin(
        plane: &MaterialPlane,
        at: Pos2,
        materials: &mut Vec<MaterialBox>,
        selected: usize,
        fresh: MaterialBox,
    ) -> Option<Self> {
        let order = std::iter::once(selected).chain((0..materials.len()).rev());
        let found = order.filter_map(|index| {
            let moves = grabbed_ends(plane.rect(materials.get(index)?), at)?;
            Some((index, moves))
        });
        let from = plane.place_at(at);
        let (index, moves) = match found.into_iter().next() {
            Some(found) => found,
            None if materials.len() < MAX_MATERIAL_BOXES => {
                materials.push(MaterialBox { values: [from[0]; 2], changes: [from[1]; 2], ..fresh });
                (materials.len() - 1, [[false, true]; 2])
            }
            None => return None,
        };
        // Ends beyond the plane are grabbed at its border.
        let start = plane.within(materials[index]);
        Some(Self { index, moves, start, from })
    }

    /// Moves the ends of the material to where the pointer has dragged them.
    pub(super) fn update(&self, plane: &MaterialPlane, at: Pos2, material: &mut MaterialBox) {
        let to = plane.place_at(at);
        let moved = |ends: [f64; 2], moves: [bool; 2], axis: usize| {
            let by = to[axis] - self.from[axis];
            [0, 1].map(|end| if moves[end] { ends[end] + by } else { ends[end] })
        };
        let is_whole = self.moves == [[true; 2]; 2];
        let axes = [(self.start.values, &mut material.values), (self.start.changes, &mut material.changes)];
        for (axis, (start, ends)) in axes.into_iter().enumerate() {
            let new = moved(start, self.moves[axis], axis);
            // A box that is moved as a whole keeps its size.
            let new = if is_whole { plane.shifted_within(axis, new) } else { new };
            *ends = plane.opened_at_borders(axis, new);
            ends.sort_by(f64::total_cmp);
        }
    }
}

/// Returns the ends of a box that are grabbed at a position, all of them within it; `None` beside it.
fn grabbed_ends(area: Rect, at: Pos2) -> Option<[[bool; 2]; 2]> {
    if !area.expand(GRAB_DISTANCE).contains(at) {
        return None;
    }
    let near = |ends: [f32; 2], at: f32| {
        let apart = ends.map(|end| (end - at).abs());
        let nearer = usize::from(apart[1] < apart[0]);
        let is_near = apart[nearer] <= GRAB_DISTANCE;
        [is_near && nearer == 0, is_near && nearer == 1]
    };
    let ends = [near([area.left(), area.right()], at.x), near([area.bottom(), area.top()], at.y)];
    let is_inside = ends == [[false; 2]; 2];
    Some(if is_inside { [[true; 2]; 2] } else { ends })
}
