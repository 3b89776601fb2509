//! Silhouette of a connected component in a picture, which shows what a cut of it would hide.

use rayon::prelude::*;

use super::component::component_voxels;
use crate::{Camera, ComponentCut};
use chiaroscuro_volume::{Observer, Volume};
use glam::DVec3;

/// Factor of a voxel's extent in the picture for the half of what it covers.
const HALF_EXTENT: f64 = 0.6;

/// Largest number of pixels along a side of the rectangle that a voxel covers: nearer ones leave gaps, which a contour
/// shows.
const MAX_VOXEL_PIXELS: i64 = 64;

/// Silhouette of a connected component of voxels in a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ComponentSilhouette {
    /// Number of columns and rows.
    pub size: [usize; 2],
    /// Pixels that the component covers, row by row from the top left.
    pub is_covered: Vec<bool>,
}

impl ComponentSilhouette {
    /// Finds the voxels of a component, without the skin that a cut hides with them, among those that the eye sees, as a
    /// camera sees them in a picture of this size; `None` if there are none near its seed. Takes a quarter of a second for 256³ voxels on two
    /// cores.
    pub fn new(volume: &Volume, component: &ComponentCut, camera: &Camera, size: [usize; 2]) -> Option<Self> {
        let hidden = match volume.mask() {
            Some(mask) => mask.hidden_from(Observer::Eye).to_vec(),
            None => vec![0; volume.voxel_count()],
        };
        let inside = component_voxels(volume, &hidden, component, 0)?;
        let [width, height] = size.map(|n| n as f64);
        let scene = volume.scene();
        // Half of a voxel's extent in the picture, and a little more, so that those nearer to a perspective camera leave
        // no gaps.
        let view = camera.scene_from_view();
        let half_extent = |across: DVec3| {
            let axes = DVec3::AXES.map(|axis| (scene.scene_from_index.matrix3 * axis).dot(across).abs());
            let pixels = axes.iter().sum::<f64>() / camera.pixel_at_target(width, height);
            ((HALF_EXTENT * pixels).ceil() as i64).clamp(1, MAX_VOXEL_PIXELS / 2)
        };
        let (half_width, half_height) = (half_extent(view.x_axis), half_extent(view.y_axis));
        let dims = volume.dims();
        let places: Vec<[i64; 2]> = (0..inside.len())
            .into_par_iter()
            .filter(|&voxel| inside[voxel] && is_on_border(&inside, dims, voxel))
            .filter_map(|voxel| {
                let [x, y, z] = [voxel % dims[0], voxel / dims[0] % dims[1], voxel / (dims[0] * dims[1])];
                let point = scene.scene_from_index.transform_point3(DVec3::new(x as f64, y as f64, z as f64));
                let (x, y, _) = camera.pixel_from_scene(point, width, height)?;
                Some([x.floor() as i64, y.floor() as i64])
            })
            .collect();
        let mut silhouette = Self { size, is_covered: vec![false; size[0] * size[1]] };
        for [x, y] in places {
            silhouette.cover([x - half_width, x + half_width], [y - half_height, y + half_height]);
        }
        Some(silhouette)
    }

    /// Covers the pixels of a rectangle, ends included, as far as it lies in the picture.
    fn cover(&mut self, [left, right]: [i64; 2], [top, bottom]: [i64; 2]) {
        let [columns, rows] = self.size.map(|n| n as i64);
        if right < 0 || left >= columns {
            return;
        }
        let columns_covered = left.max(0) as usize..right.min(columns - 1) as usize + 1;
        for row in top.max(0)..=bottom.min(rows - 1) {
            let first = row as usize * self.size[0];
            self.is_covered[first + columns_covered.start..first + columns_covered.end].fill(true);
        }
    }

    /// Returns true if a pixel is covered, and one beside it is not.
    pub fn is_contour(&self, column: usize, row: usize) -> bool {
        let [columns, rows] = self.size;
        let is_open = |x: i64, y: i64| {
            let is_inside = (0..columns as i64).contains(&x) && (0..rows as i64).contains(&y);
            !is_inside || !self.is_covered[x as usize + columns * y as usize]
        };
        let (x, y) = (column as i64, row as i64);
        !is_open(x, y) && [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(dx, dy)| is_open(x + dx, y + dy))
    }
}

/// Returns true if a voxel beside this one, or the outside of the grid, is not inside.
fn is_on_border(inside: &[bool], [nx, ny, nz]: [usize; 3], voxel: usize) -> bool {
    [(1, nx), (nx, ny), (nx * ny, nz)].into_iter().any(|(stride, count)| {
        let place = voxel / stride % count;
        place == 0 || place + 1 == count || !inside[voxel - stride] || !inside[voxel + stride]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Projection;
    use chiaroscuro_volume::{Samples, ValueRange, VoxelMask};
    use std::sync::Arc;

    const EDGE: usize = 24;

    /// Two boxes of 6³ voxels beside each other along x.
    fn boxes() -> Volume {
        let value = |at: usize| {
            let [x, y, z] = [at % EDGE, at / EDGE % EDGE, at / EDGE / EDGE];
            let is_across = (9..15).contains(&y) && (9..15).contains(&z);
            if is_across && ((2..8).contains(&x) || (16..22).contains(&x)) { 200 } else { 0 }
        };
        let samples = Samples::U8((0..EDGE.pow(3)).map(value).collect());
        Volume::with_spacing("boxes", [EDGE; 3], DVec3::ONE, samples).unwrap()
    }

    fn component(volume: &Volume, x: f64) -> ComponentCut {
        let seed = volume.scene().scene_from_index.transform_point3(DVec3::new(x, 12.0, 12.0)).into();
        ComponentCut { seed, values: ValueRange::new(100.0, 255.0) }
    }

    #[test]
    fn a_silhouette_covers_one_component() {
        let volume = boxes();
        let camera = Camera {
            azimuth_deg: -90.0,
            elevation_deg: 0.0,
            projection: Projection::Orthographic,
            ..Camera::default()
        };
        let size = [120, 90];
        let found = ComponentSilhouette::new(&volume, &component(&volume, 4.0), &camera, size).unwrap();
        let covers = |x: f64, z: f64| {
            let point = volume.scene().scene_from_index.transform_point3(DVec3::new(x, 12.0, z));
            let (column, row, _) = camera.pixel_from_scene(point, 120.0, 90.0).unwrap();
            found.is_covered[column as usize + 120 * row as usize]
        };
        assert!(covers(4.5, 11.5) && covers(2.0, 9.0) && covers(7.0, 14.0));
        assert!(!covers(18.0, 12.0) && !covers(4.5, 17.0) && !covers(9.0, 12.0));
        let contour = (0..90).flat_map(|row| (0..120).map(move |column| (column, row)));
        let contour: Vec<_> = contour.filter(|&(column, row)| found.is_contour(column, row)).collect();
        assert!((40..200).contains(&contour.len()), "{} pixels", contour.len());
        // Nothing is found where nothing is, nor where it is hidden.
        assert_eq!(ComponentSilhouette::new(&volume, &component(&volume, 12.0), &camera, size), None);
        let shares = (0..EDGE.pow(3)).map(|at| if at % EDGE < 12 { 255 } else { 0 }).collect();
        let mask = VoxelMask::from_hidden_shares([EDGE; 3], shares).map(Arc::new);
        let hidden = volume.with_mask(mask);
        assert_eq!(ComponentSilhouette::new(&hidden, &component(&volume, 4.0), &camera, size), None);
    }
}
