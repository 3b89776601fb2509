//! Orientation of slices on the screen: grid axes to the right and upwards, and the anatomical sides at their edges.
//!
//! Slices of a body follow the radiological viewing convention or the neurological one: anterior at the top of axial
//! slices, superior at the top of the others, and the body's right on the side that the convention names. For other
//! data x runs to the right and z, or else y, upwards.

use eframe::egui::{Pos2, Rect, Vec2, pos2};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use chiaroscuro_media::orientation_letters_of_plane;
use chiaroscuro_volume::{AnatomicalAxes, Volume, math::SceneSpace};

/// Side of the screen on which axial and coronal slices show a body's right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ViewingConvention {
    /// Body's right on the left, as if the body faced the viewer.
    #[default]
    Radiological,
    /// Body's right on the right, as if the viewer stood behind the body.
    Neurological,
}

/// Anatomical plane, named by the axis of the body across which it lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BodyPlane {
    /// Plane across the left–right axis.
    Sagittal,
    /// Plane across the posterior–anterior axis.
    Coronal,
    /// Plane across the inferior–superior axis.
    Axial,
}

/// Grid axis that runs along a direction of the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ScreenAxis {
    /// Index of the axis in index space.
    pub axis: usize,
    /// True if indices decrease in that direction.
    pub is_reversed: bool,
}

/// Orientation on the screen of the slices across one grid axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SlicePlane {
    /// Axis of index space across which the slices lie.
    pub normal_axis: usize,
    /// Grid axis that runs to the right.
    pub right: ScreenAxis,
    /// Grid axis that runs upwards.
    pub up: ScreenAxis,
    /// Nearest anatomical plane, if the volume has anatomical directions.
    pub body_plane: Option<BodyPlane>,
}

/// Indices of the body's axes in right–anterior–superior space.
const RIGHT: usize = 0;
const ANTERIOR: usize = 1;
const SUPERIOR: usize = 2;

impl ScreenAxis {
    /// Position of a voxel's centre along this axis, as a share from the left or the bottom.
    fn share_of_index(self, index: usize, count: usize) -> f32 {
        let share = (index as f32 + 0.5) / count as f32;
        if self.is_reversed { 1.0 - share } else { share }
    }

    /// Index of the voxel at a share of the length of this axis.
    fn index_of_share(self, share: f32, count: usize) -> usize {
        let share = if self.is_reversed { 1.0 - share } else { share };
        ((share * count as f32).max(0.0) as usize).min(count - 1)
    }

    /// Index of the n-th voxel from the left or the bottom.
    pub(super) fn nth_index(self, nth: usize, count: usize) -> usize {
        if self.is_reversed { count - 1 - nth } else { nth }
    }

    /// Direction of this axis in scene space, a unit vector.
    fn scene_direction(self, scene: &SceneSpace) -> DVec3 {
        let along = scene.scene_from_index.matrix3.col(self.axis).normalize_or_zero();
        if self.is_reversed { -along } else { along }
    }
}

impl SlicePlane {
    /// Iterates over the voxels of the slice at an index across the plane, row by row from the top left.
    pub(super) fn voxels(&self, dims: [usize; 3], at: usize) -> impl Iterator<Item = [usize; 3]> + '_ {
        let (right, up) = (&self.right, &self.up);
        let [u, v] = [right.axis, up.axis];
        (0..dims[v]).rev().flat_map(move |row| {
            (0..dims[u]).map(move |column| {
                let mut voxel = [at; 3];
                (voxel[u], voxel[v]) = (right.nth_index(column, dims[u]), up.nth_index(row, dims[v]));
                voxel
            })
        })
    }

    /// Creates the plane across an axis of a grid without anatomical directions.
    pub(crate) fn across_axis(axis: usize) -> Self {
        let [right, up] = [[1, 2], [0, 2], [0, 1]][axis].map(|axis| ScreenAxis { axis, is_reversed: false });
        Self { normal_axis: axis, right, up, body_plane: None }
    }

    /// Planes of the three cuts of a volume: from above, from the front and from the side.
    pub(crate) fn for_volume(volume: &Volume, convention: ViewingConvention) -> [Self; 3] {
        if !volume.is_anatomical() {
            return [2, 1, 0].map(Self::across_axis);
        }
        let axes = volume.world_from_index().matrix3;
        let headings = AnatomicalAxes::nearest([axes.x_axis, axes.y_axis, axes.z_axis]).directions();
        // The grid axis that runs along an axis of the body, towards its end or its start.
        let screen_axis = |of_body: usize, to_end: bool| {
            let axis = (0..3).find(|&axis| headings[axis][of_body] != 0.0).unwrap_or(of_body);
            ScreenAxis { axis, is_reversed: (headings[axis][of_body] > 0.0) != to_end }
        };
        let to_right = convention == ViewingConvention::Neurological;
        let plane = |across, right, up, of_body| Self {
            normal_axis: screen_axis(across, true).axis,
            right,
            up: screen_axis(up, true),
            body_plane: Some(of_body),
        };
        [
            plane(SUPERIOR, screen_axis(RIGHT, to_right), ANTERIOR, BodyPlane::Axial),
            plane(ANTERIOR, screen_axis(RIGHT, to_right), SUPERIOR, BodyPlane::Coronal),
            // Both conventions look at a body's left side, with its front on the left.
            plane(RIGHT, screen_axis(ANTERIOR, false), SUPERIOR, BodyPlane::Sagittal),
        ]
    }

    /// Anatomical letters at the right, left, top and bottom of the slices.
    pub(crate) fn side_letters(&self, scene: &SceneSpace) -> [String; 4] {
        orientation_letters_of_plane(self.right.scene_direction(scene), self.up.scene_direction(scene))
    }

    /// Position of a voxel's centre on the screen, in an area that the slice fills.
    pub(crate) fn screen_position(&self, voxel: [usize; 3], dims: [usize; 3], area: Rect) -> Pos2 {
        let share = |run: ScreenAxis| run.share_of_index(voxel[run.axis], dims[run.axis]);
        pos2(area.left() + share(self.right) * area.width(), area.bottom() - share(self.up) * area.height())
    }

    /// Moves a voxel within its slice to a position on the screen.
    pub(crate) fn move_to(&self, at: Pos2, area: Rect, dims: [usize; 3], voxel: &mut [usize; 3]) {
        let Vec2 { x, y } = (at - area.left_bottom()) / area.size();
        voxel[self.right.axis] = self.right.index_of_share(x, dims[self.right.axis]);
        voxel[self.up.axis] = self.up.index_of_share(-y, dims[self.up.axis]);
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3};

    use super::*;
    use chiaroscuro_volume::Samples;

    /// Anatomical volume of 2 × 3 × 4 voxels, with grid axes in these directions of right–anterior–superior space.
    fn body(axes: [[f64; 3]; 3]) -> Volume {
        let world_from_index = DAffine3::from_mat3(DMat3::from_cols_array_2d(&axes));
        let samples = Samples::U8((0..24).collect());
        Volume::new("body", [2, 3, 4], world_from_index, samples).unwrap().with_anatomical_axes(true)
    }

    fn letters(volume: &Volume, convention: ViewingConvention) -> [String; 3] {
        SlicePlane::for_volume(volume, convention).map(|plane| plane.side_letters(&volume.scene()).concat())
    }

    #[test]
    fn bodies_lie_as_people_look_at_them_however_their_voxels_are_stored() {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let back = |axis: [f64; 3]| axis.map(|c| -c);
        for axes in [[x, y, z], [back(x), back(y), z], [y, back(z), x], [back(z), x, back(y)]] {
            let volume = body(axes);
            // Letters at right, left, top and bottom.
            assert_eq!(
                letters(&volume, ViewingConvention::Radiological),
                ["LRAP", "LRSI", "PASI"],
                "{axes:?}"
            );
            assert_eq!(
                letters(&volume, ViewingConvention::Neurological),
                ["RLAP", "RLSI", "PASI"],
                "{axes:?}"
            );
            let planes = SlicePlane::for_volume(&volume, ViewingConvention::Radiological);
            let mut across = planes.map(|plane| plane.normal_axis);
            for plane in planes {
                assert!(
                    ![plane.right.axis, plane.up.axis].contains(&plane.normal_axis)
                        && plane.right.axis != plane.up.axis,
                    "{plane:?}"
                );
            }
            across.sort_unstable();
            assert_eq!(across, [0, 1, 2]);
            assert_eq!(
                planes.map(|plane| plane.body_plane),
                [BodyPlane::Axial, BodyPlane::Coronal, BodyPlane::Sagittal].map(Some)
            );
        }
    }

    #[test]
    fn oblique_bodies_have_the_letters_of_both_sides() {
        // At 30° about the inferior–superior axis both letters are shown, at 10° only the nearer one.
        let turned = |deg: f64| DMat3::from_rotation_z(deg.to_radians()).to_cols_array_2d();
        let oblique = letters(&body(turned(30.0)), ViewingConvention::Radiological);
        assert_eq!(oblique, ["LPRAALPR", "LPRASI", "PRALSI"]);
        assert_eq!(letters(&body(turned(10.0)), ViewingConvention::Radiological), ["LRAP", "LRSI", "PASI"]);
    }

    #[test]
    fn other_data_lie_along_their_axes() {
        let volume = Volume::with_spacing("t", [2, 3, 4], DVec3::ONE, Samples::U8(vec![0; 24])).unwrap();
        let planes = SlicePlane::for_volume(&volume, ViewingConvention::Radiological);
        assert_eq!(planes.map(|plane| plane.normal_axis), [2, 1, 0]);
        assert_eq!(planes.map(|plane| [plane.right.axis, plane.up.axis]), [[0, 1], [0, 2], [1, 2]]);
        assert!(planes.iter().all(|plane| plane.body_plane.is_none() && !plane.right.is_reversed));
    }

    #[test]
    fn places_on_the_screen_lead_back_to_their_voxels() {
        let area = Rect::from_min_max(pos2(10.0, 20.0), pos2(30.0, 80.0));
        let dims = [2, 3, 4];
        for convention in [ViewingConvention::Radiological, ViewingConvention::Neurological] {
            for plane in SlicePlane::for_volume(
                &body([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]),
                convention,
            ) {
                for at in 0..24 {
                    let voxel = [at % 2, at / 2 % 3, at / 6];
                    let mut found = [0; 3];
                    found[plane.normal_axis] = voxel[plane.normal_axis];
                    plane.move_to(plane.screen_position(voxel, dims, area), area, dims, &mut found);
                    assert_eq!(found, voxel, "{plane:?}");
                }
            }
        }
    }
}
