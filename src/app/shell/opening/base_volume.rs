//! Choice of the volume over which others are shown: the picture has its grid.

use chiaroscuro_volume::{DataKind, Volume, math::Aabb};

/// Largest ratio of the volumes of two voxels at which the smaller one is worth another grid: its edges are then a fifth shorter.
const FINER_VOXEL: f64 = 0.5;

/// Share of the open volume's box that a finer one must have in it, so that little is lost outside its grid.
const COVERED_SHARE: f64 = 0.8;

/// Returns true if an open volume is better shown over another one than that one over it: labels over what they are
/// of, and coarse voxels over fine ones, which would be lost in a coarse grid.
pub(super) fn is_better_base(volume: &Volume, open: &Volume) -> bool {
    let is_label = |volume: &Volume| matches!(volume.kind().kind, DataKind::LabelMap { .. } | DataKind::Mask);
    if is_label(volume) || is_label(open) {
        return is_label(open) && !is_label(volume) && !is_much_coarser(volume, open);
    }
    let [finer, coarser] = [volume, open].map(world_box);
    let size = |bounds: &Aabb| (bounds.max - bounds.min).element_product();
    is_much_coarser(open, volume) && common_volume(&finer, &coarser) >= COVERED_SHARE * size(&coarser)
}

/// Returns true if details of a fine volume would be lost on the grid of a coarse one.
fn is_much_coarser(coarse: &Volume, fine: &Volume) -> bool {
    let voxel = |volume: &Volume| volume.world_from_index().matrix3.determinant().abs();
    voxel(fine) < FINER_VOXEL * voxel(coarse)
}

/// Bounding box of a volume's voxel centres in its own world space.
pub(super) fn world_box(volume: &Volume) -> Aabb {
    let map = volume.world_from_index();
    let corners = Aabb::of_grid(volume.dims(), 0.0).corners();
    Aabb::from_points(corners.map(|corner| map.transform_point3(corner)))
}

/// Size of what two boxes have in common.
pub(super) fn common_volume(a: &Aabb, b: &Aabb) -> f64 {
    (a.max.min(b.max) - a.min.max(b.min)).max(glam::DVec3::ZERO).element_product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Samples;
    use glam::{DAffine3, DVec3};

    fn volume(edge: usize, spacing: f64, value: impl Fn(usize) -> i16) -> Volume {
        let map = DAffine3::from_scale(DVec3::splat(spacing));
        let values = Samples::I16((0..edge.pow(3)).map(value).collect());
        Volume::new("t", [edge; 3], map, values).unwrap().with_anatomical_axes(true)
    }

    #[test]
    fn labels_and_coarse_scans_lie_over_fine_ones() {
        let scan = |edge, spacing| volume(edge, spacing, |at| (at * 7919 % 1777) as i16);
        let labels = |edge, spacing| volume(edge, spacing, |at| (at / 9000 % 3) as i16);
        assert!(matches!(labels(32, 1.0).kind().kind, DataKind::LabelMap { .. } | DataKind::Mask));
        assert!(is_better_base(&scan(32, 1.0), &scan(16, 2.0)));
        assert!(!is_better_base(&scan(16, 2.0), &scan(32, 1.0)));
        assert!(!is_better_base(&scan(32, 1.0), &scan(30, 1.1)), "about as fine");
        assert!(!is_better_base(&scan(16, 1.0), &scan(16, 2.0)), "of a part");
        assert!(is_better_base(&scan(32, 1.0), &labels(32, 1.0)));
        assert!(!is_better_base(&labels(32, 1.0), &scan(32, 1.0)));
        assert!(!is_better_base(&scan(8, 4.0), &labels(32, 1.0)), "labels that are finer");
    }
}
