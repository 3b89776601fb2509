//! Tests of `NIfTI` placement: sform, qform, spacings and units.

use glam::{DAffine3, DVec3};

use super::{NiftiBuilder, nifti1_header, read};
use chiaroscuro_volume::Volume;

fn place(header: &NiftiBuilder) -> Volume {
    read(&header.with_data(&[1; 8]))
}

/// Returns the columns of an affine, rounded to the precision of 32-bit floats.
fn columns(affine: DAffine3) -> [[f64; 3]; 4] {
    let matrix = affine.matrix3;
    [matrix.x_axis, matrix.y_axis, matrix.z_axis, affine.translation]
        .map(|column| ((column * 1e4).round() / 1e4).to_array().map(|n| n + 0.0))
}

/// A header with an sform that mirrors and rotates.
fn matrix() -> NiftiBuilder {
    nifti1_header(&[2, 2, 2], 2)
        .i16(254, &[4])
        .f32(280, &[-2.0, 0.0, 0.5, 90.0])
        .f32(296, &[0.0, 0.0, 3.0, -126.0])
        .f32(312, &[0.25, 4.0, 0.0, -72.0])
}

const MATRIX: [[f64; 3]; 4] = [[-2.0, 0.0, 0.25], [0.0, 0.0, 4.0], [0.5, 3.0, 0.0], [90.0, -126.0, -72.0]];

/// A header with a qform that rotates by 90° around z: the x axis maps to y.
fn quaternion() -> NiftiBuilder {
    let half = 0.5f32.sqrt();
    nifti1_header(&[2, 2, 2], 2).i16(252, &[1]).f32(256, &[0.0, 0.0, half, 10.0, 20.0, 30.0])
}

#[test]
fn the_matrix_comes_before_the_quaternion_and_this_before_distances() {
    let volume = place(&matrix());
    assert_eq!(columns(volume.world_from_index()), MATRIX);
    assert!(volume.is_anatomical() && volume.remarks().is_empty() && !volume.has_unknown_scale());
    let turned = [[0.0, 2.0, 0.0], [-3.0, 0.0, 0.0], [0.0, 0.0, 4.0], [10.0, 20.0, 30.0]];
    let volume = place(&quaternion());
    assert_eq!(columns(volume.world_from_index()), turned);
    assert!(volume.is_anatomical());
    let both =
        quaternion().i16(254, &[2]).f32(280, &[1.0, 0.0, 0.0, 7.0]).f32(296, &[0.0, 1.0]).f32(320, &[1.0]);
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [7.0, 0.0, 0.0]];
    assert_eq!(columns(place(&both).world_from_index()), identity);
    // A singular matrix falls back to the quaternion.
    let flat = both.f32(320, &[0.0]);
    let volume = place(&flat);
    assert_eq!(columns(volume.world_from_index()), turned);
    assert!(volume.remarks()[0].contains("sform"));

    let volume = place(&nifti1_header(&[2, 2, 2], 2));
    assert_eq!(volume.spacing_mm(), DVec3::new(2.0, 3.0, 4.0));
    assert!(!volume.is_anatomical() && !volume.has_unknown_scale());
    assert!(volume.remarks()[0].contains("left and right"));
}

#[test]
fn the_third_axis_can_be_mirrored_and_half_turns_are_rounded() {
    let mirrored = place(&quaternion().f32(76, &[-1.0]));
    assert_eq!(columns(mirrored.world_from_index())[2], [0.0, 0.0, -4.0]);
    // b² + c² + d² slightly above 1.
    let half_turn = nifti1_header(&[2, 2, 2], 2).i16(252, &[1]).f32(256, &[1.000_001]);
    let axes = columns(place(&half_turn).world_from_index());
    assert_eq!(axes[..3], [[2.0, 0.0, 0.0], [0.0, -3.0, 0.0], [0.0, 0.0, -4.0]]);
    let broken = place(&nifti1_header(&[2, 2, 2], 2).i16(252, &[1]).f32(256, &[f32::NAN]));
    assert!(!broken.is_anatomical());
    assert_eq!(broken.spacing_mm(), DVec3::new(2.0, 3.0, 4.0));
    assert!(broken.remarks()[0].contains("qform"));
}

#[test]
fn lengths_have_units() {
    for (code, mm) in [(1u8, 1e3), (2, 1.0), (3, 1e-3), (0, 1.0), (2 + 8, 1.0), (3 + 16, 1e-3)] {
        let volume = place(&matrix().text(123, &[code]));
        let expected = MATRIX.map(|column| DVec3::from_array(column) * mm);
        let affine = volume.world_from_index();
        assert!((affine.translation - expected[3]).length() < 1e-6 * expected[3].length(), "{code}");
        assert!((affine.matrix3.x_axis - expected[0]).length() < 1e-6 * expected[0].length(), "{code}");
        let spaced = place(&nifti1_header(&[2, 2, 2], 2).text(123, &[code]));
        assert!((spaced.spacing_mm() - DVec3::new(2.0, 3.0, 4.0) * mm).length() < 1e-6 * mm, "{code}");
    }
}

#[test]
fn what_nobody_has_said_is_not_known() {
    let default = nifti1_header(&[2, 2, 2], 2).f32(76, &[1.0; 8]);
    assert!(place(&default).has_unknown_scale());
    assert!(place(&default.clone().f32(76, &[0.0; 8])).has_unknown_scale());
    assert!(!place(&default.clone().text(123, &[2])).has_unknown_scale(), "one millimetre");
    let volume = place(&default.f32(76, &[1.0, 2.0, 0.0, -3.0]));
    assert_eq!(volume.spacing_mm(), DVec3::new(2.0, 1.0, 3.0));
    assert!(volume.remarks().iter().any(|remark| remark.contains("is unusable")));
    // One slice, without a spacing along z.
    let slice = read(&nifti1_header(&[2, 2], 2).f32(88, &[0.0]).with_data(&[1; 4]));
    assert_eq!((slice.dims(), slice.spacing_mm()), ([2, 2, 1], DVec3::new(2.0, 3.0, 2.0)));
}
