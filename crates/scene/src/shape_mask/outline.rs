//! Distances from an outline that was drawn in a picture, for the voxels behind it.

use rayon::prelude::*;

use super::voxel_edge;
use crate::{OutlineCut, Projection};
use chiaroscuro_volume::math::{Aabb, SceneSpace};
use glam::{DAffine3, DVec2, DVec3};

/// Number of cells along the longer side of the table of distances: one per pixel or two of a picture.
const TABLE_CELLS: f64 = 512.0;

/// Margin of the table around the outline, as a share of its longer side.
const TABLE_MARGIN: f64 = 0.05;

/// Smallest margin, in picture heights: half a voxel of a volume of 50 voxels that fills the picture.
const MIN_TABLE_MARGIN: f64 = 0.01;

/// Smallest depth in front of a perspective eye, in scene units.
const MIN_DEPTH: f64 = 1e-9;

/// Signed distances in the plane of a picture from an outline, and the projection of voxels into it.
pub(super) struct OutlineDistance {
    /// Transform from index space to the camera's axes: right, up, and backwards from the eye.
    view_from_index: DAffine3,
    /// Transform from the camera's axes to index space.
    index_from_view: DAffine3,
    /// Number of voxels along x, y, z.
    dims: [usize; 3],
    /// Distance of the target from the eye for perspective, in scene units; `None` for parallel rays.
    target_distance: Option<f64>,
    /// Height of the picture at the target, in scene units.
    height_at_target: f64,
    /// Edge of a voxel in scene units.
    edge: f64,
    table: DistanceTable,
}

/// Table of signed distances from an outline, in picture heights and positive inside.
struct DistanceTable {
    low: DVec2,
    /// Smallest distance of the table's border from the outline.
    margin: f64,
    cell: f64,
    size: [usize; 2],
    distances: Vec<f32>,
}

impl OutlineDistance {
    /// Measures the distances from an outline for the voxels of a scene.
    pub(super) fn new(outline: &OutlineCut, scene: &SceneSpace) -> Self {
        let OutlineCut { camera, aspect, points, depth: _, surface: _ } = outline;
        let scene_from_view = camera.scene_from_view();
        let view_from_scene = scene_from_view.transpose();
        let view_from_scene =
            DAffine3 { matrix3: view_from_scene, translation: -(view_from_scene * camera.position()) };
        // From the middle of the picture, y upwards.
        let corner = |&[x, y]: &[f64; 2]| DVec2::new((x - 0.5) * aspect, 0.5 - y);
        let view_from_index = view_from_scene * scene.scene_from_index;
        Self {
            view_from_index,
            index_from_view: view_from_index.inverse(),
            dims: scene.dims,
            target_distance: (camera.projection == Projection::Perspective).then_some(camera.distance),
            height_at_target: 2.0 * camera.half_height_at_target(*aspect),
            edge: voxel_edge(scene),
            table: DistanceTable::new(&points.iter().map(corner).collect::<Vec<_>>()),
        }
    }

    /// Returns the distance, in voxels, by which a point of index space lies inside the outline; negative outside.
    pub(super) fn voxels_inside(&self, index: DVec3) -> f64 {
        let view = self.view_from_index.transform_point3(index);
        if self.target_distance.is_some() && view.z > -MIN_DEPTH {
            return f64::NEG_INFINITY;
        }
        let height = self.height_at(-view.z);
        self.table.distance(view.truncate() / height) * height / self.edge
    }

    /// Returns the height of the picture at a depth along the viewing axis, in scene units.
    fn height_at(&self, depth: f64) -> f64 {
        self.target_distance
            .map_or(self.height_at_target, |distance| self.height_at_target * depth / distance)
    }

    /// Returns the place of a point of index space in the picture, from its middle in picture heights, and the depth.
    pub(super) fn place_and_depth(&self, index: DVec3) -> (DVec2, f64) {
        let view = self.view_from_index.transform_point3(index);
        (view.truncate() / self.height_at((-view.z).max(MIN_DEPTH)), -view.z)
    }

    /// Returns the point of index space at a place of the picture and a depth, inverse to [`Self::place_and_depth`].
    pub(super) fn index_at(&self, place: DVec2, depth: f64) -> DVec3 {
        self.index_from_view.transform_point3((place * self.height_at(depth)).extend(-depth))
    }

    /// Returns the smallest and the largest depth of the volume, in front of the eye for perspective.
    pub(super) fn depth_range(&self) -> [f64; 2] {
        let corners = Aabb::of_grid(self.dims, 0.0).corners();
        let depths = corners.map(|corner| -self.view_from_index.transform_point3(corner).z);
        let [near, far] =
            [depths.into_iter().fold(f64::MAX, f64::min), depths.into_iter().fold(f64::MIN, f64::max)];
        if self.target_distance.is_some() { [near.max(MIN_DEPTH), far] } else { [near, far] }
    }

    /// Returns the corners of a box around the outline in the picture, from its middle in picture heights.
    pub(super) fn bounds(&self) -> [DVec2; 2] {
        [self.table.low, self.table.low + self.table.extent()]
    }

    /// Returns the edge of a voxel, in scene units.
    pub(super) fn edge(&self) -> f64 {
        self.edge
    }
}

impl DistanceTable {
    /// Computes the distances around an outline of at least three corners.
    fn new(corners: &[DVec2]) -> Self {
        let low = corners.iter().copied().reduce(DVec2::min).unwrap_or_default();
        let high = corners.iter().copied().reduce(DVec2::max).unwrap_or_default();
        let longer = (high - low).max_element().max(1e-6);
        let margin = TABLE_MARGIN * longer + MIN_TABLE_MARGIN;
        let low = low - margin;
        let cell = (longer + 2.0 * margin) / TABLE_CELLS;
        let size = ((high + margin - low) / cell).ceil().to_array().map(|cells| cells as usize + 1);
        let edges: Vec<[DVec2; 2]> =
            corners.iter().zip(corners.iter().cycle().skip(1)).map(|(&from, &to)| [from, to]).collect();
        let distances = (0..size[0] * size[1])
            .into_par_iter()
            .map(|at| {
                let point = low + DVec2::new((at % size[0]) as f64, (at / size[0]) as f64) * cell;
                signed_distance(&edges, point) as f32
            })
            .collect();
        Self { low, margin, cell, size, distances }
    }

    /// Returns the size of the table, in picture heights.
    fn extent(&self) -> DVec2 {
        DVec2::new((self.size[0] - 1) as f64, (self.size[1] - 1) as f64) * self.cell
    }

    /// Returns the interpolated distance at a point; outside the table the negative one of its border.
    fn distance(&self, point: DVec2) -> f64 {
        let at = (point - self.low) / self.cell;
        let last = DVec2::new((self.size[0] - 1) as f64, (self.size[1] - 1) as f64);
        if !(at.cmpge(DVec2::ZERO).all() && at.cmplt(last).all()) {
            // The outline is further away than the border of the table, by the margin.
            return -(point - point.clamp(self.low, self.low + last * self.cell)).length() - self.margin;
        }
        let low = at.floor();
        let share = at - low;
        let first = low.x as usize + self.size[0] * low.y as usize;
        let value = |offset: usize| f64::from(self.distances[first + offset]);
        let across = |offset: usize| value(offset) + (value(offset + 1) - value(offset)) * share.x;
        across(0) + (across(self.size[0]) - across(0)) * share.y
    }
}

/// Returns the distance of a point from the nearest edge: positive if the edges wind around it, else negative. Winding
/// counts, so that a loop drawn twice stays inside.
fn signed_distance(edges: &[[DVec2; 2]], point: DVec2) -> f64 {
    let mut nearest = f64::INFINITY;
    let mut winding = 0;
    for &[from, to] in edges {
        let along = to - from;
        let place = ((point - from).dot(along) / along.length_squared().max(1e-30)).clamp(0.0, 1.0);
        nearest = nearest.min(point.distance_squared(from + along * place));
        let side = along.perp_dot(point - from);
        if from.y <= point.y && to.y > point.y && side > 0.0 {
            winding += 1;
        } else if from.y > point.y && to.y <= point.y && side < 0.0 {
            winding -= 1;
        }
    }
    if winding == 0 { -nearest.sqrt() } else { nearest.sqrt() }
}
