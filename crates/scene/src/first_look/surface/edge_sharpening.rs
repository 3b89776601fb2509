//! Crisp surfaces of small volumes: their opacity rises over a part of a voxel.

use crate::{MAX_OPACITY, TransferFunction};
use chiaroscuro_volume::Volume;

/// Number of voxels along the longest edge from which surfaces are as thin as those of the data. In a picture of 800
/// pixels a voxel of smaller volumes is wider than six pixels, and surfaces that fade over a voxel look blurred.
const SHARP_EDGE_VOXELS: f64 = 128.0;

/// Smallest share of its width that a surface keeps. Thinner ones need thinner slabs: *Exact* is 0.4 steps of 8 bits
/// from the limit on a chair of 24 voxels with half of the width, 0.8 with a third and 1.9 with a seventh of it.
const MIN_WIDTH: f64 = 0.5;

/// Opacities between which a function is the surface of something opaque: below the first it is clear, or a veil.
const CLEAR_OPACITY: f64 = 0.05;
const SURFACE_OPACITY: f64 = 0.2;

/// Position of the sharpened surface in the ramp as it was, from its beginning: where a voxel of it has let half of the
/// light through, so that objects keep their size.
const SURFACE_PLACE: f64 = 1.0 / 3.0;

/// Makes the surfaces of a function as thin as pictures of a volume show, for volumes of few voxels. Returns true if
/// that changes where the outermost surface is.
pub(crate) fn sharpen_edges(function: &mut TransferFunction, volume: &Volume) -> bool {
    let longest = volume.file_dims().into_iter().max().unwrap_or(1);
    let width = (longest as f64 / SHARP_EDGE_VOXELS).clamp(MIN_WIDTH, 1.0);
    let first = function.points.first().map(|point| point.value);
    if width < 1.0 {
        narrow_ramps(function, width);
    }
    function.points.first().map(|point| point.value) != first
}

/// Narrows each ramp from clear to opaque to a share `width`, and makes what is behind it as opaque over that share as
/// it was over a whole voxel.
fn narrow_ramps(function: &mut TransferFunction, width: f64) {
    let before = function.points.clone();
    let is_opaque = |at: usize| before[at].opacity >= SURFACE_OPACITY;
    let is_clear = |at: usize| before[at].opacity <= CLEAR_OPACITY;
    for (at, point) in function.points.iter_mut().enumerate() {
        if is_opaque(at) {
            point.opacity = (1.0 - (1.0 - point.opacity).powf(1.0 / width)).min(MAX_OPACITY);
        }
        // Towards the neighbour at the other end of a ramp, on either side.
        let neighbours = [at.checked_sub(1), Some(at + 1).filter(|&next| next < before.len())];
        for other in neighbours.into_iter().flatten() {
            let [clear, opaque] = if is_clear(at) && is_opaque(other) {
                [at, other]
            } else if is_opaque(at) && is_clear(other) {
                [other, at]
            } else {
                continue;
            };
            let ramp = before[opaque].value - before[clear].value;
            let begin = before[clear].value + SURFACE_PLACE * (1.0 - width) * ramp;
            point.value = if at == clear { begin } else { begin + width * ramp };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ControlPoint;

    fn narrowed(points: &[(f64, f64)], width: f64) -> Vec<(f64, f64)> {
        let points = points.iter().map(|&(value, opacity)| ControlPoint::new(value, [1.0; 3], opacity));
        let mut function = TransferFunction { points: points.collect(), ..TransferFunction::default() };
        narrow_ramps(&mut function, width);
        function.points.iter().map(|point| (point.value, point.opacity)).collect()
    }

    #[test]
    fn surfaces_become_thin_where_they_were() {
        let found = narrowed(&[(0.0, 0.0), (30.0, 0.36), (60.0, 0.75)], 0.5);
        let expected = [(5.0, 0.0), (20.0, 0.5904), (60.0, 0.9375)];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found.0 - expected.0).abs() < 1e-9 && (found.1 - expected.1).abs() < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn veils_and_the_ramps_of_fields_downwards_are_told_apart() {
        // A veil, then a surface.
        let found = narrowed(&[(0.0, 0.0), (10.0, 0.04), (20.0, 0.0), (30.0, 0.5)], 0.5);
        assert_eq!(found[..2], [(0.0, 0.0), (10.0, 0.04)]);
        assert!(found[2].0 > 20.0 && found[3].0 < 30.0);
        // A surface that faces lower values.
        let found = narrowed(&[(0.0, 0.5), (30.0, 0.0)], 0.5);
        assert_eq!((found[0].0, found[1].0), (10.0, 25.0));
    }
}
