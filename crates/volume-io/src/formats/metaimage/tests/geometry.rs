//! Tests of `MetaImage` placement: matrices, orientation letters, units.

use glam::{DAffine3, DVec3};

use super::{VOXELS, read};

fn columns(affine: DAffine3) -> [[f64; 3]; 4] {
    let matrix = affine.matrix3;
    [matrix.x_axis, matrix.y_axis, matrix.z_axis, affine.translation]
        .map(|column| column.to_array().map(|n| n + 0.0))
}

#[test]
fn the_world_of_files_is_left_posterior_superior() {
    for (matrix, offset, spacing) in [
        ("TransformMatrix", "Offset", "ElementSpacing"),
        ("Rotation", "Position", "ElementSize"),
        ("Orientation", "Origin", "ElementSpacing"),
    ] {
        let volume = read(
            &[
                &format!("{matrix} = 0 1 0 0 0 1 -1 0 0"),
                &format!("{offset} = 10 20 30"),
                &format!("{spacing} = 1 2 3"),
                "AnatomicalOrientation = LPS",
            ],
            &VOXELS,
        );
        let expected = [[0.0, -1.0, 0.0], [0.0, 0.0, 2.0], [3.0, 0.0, 0.0], [-10.0, -20.0, 30.0]];
        assert_eq!(columns(volume.world_from_index()), expected, "{matrix}");
        assert!(volume.is_anatomical() && volume.remarks().is_empty());
    }
}

#[test]
fn letters_say_it_where_no_matrix_does() {
    for (letters, axes) in [
        ("RAI", [[-1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 3.0]]),
        ("LPI", [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]),
        ("ASL", [[0.0, -1.0, 0.0], [0.0, 0.0, -2.0], [3.0, 0.0, 0.0]]),
    ] {
        let field = format!("AnatomicalOrientation = {letters}");
        let volume = read(&[&field, "ElementSpacing = 1 2 3"], &VOXELS);
        assert_eq!(columns(volume.world_from_index())[..3], axes, "{letters}");
        assert!(volume.is_anatomical());
    }
    for field in [
        "Comment = none",
        "AnatomicalOrientation = ???",
        "AnatomicalOrientation = RRI",
        "AnatomicalOrientation = RA",
    ] {
        let volume = read(&[field, "ElementSpacing = 1 2 3", "Offset = 1 2 3"], &VOXELS);
        assert!(!volume.is_anatomical() && !volume.has_unknown_scale(), "{field}");
        assert_eq!(volume.spacing_mm(), DVec3::new(1.0, 2.0, 3.0));
    }
}

#[test]
fn distances_have_units_and_are_mended() {
    for (unit, mm) in [("um", 1e-3), ("mm", 1.0), ("cm", 10.0), ("nm", 1e-6), ("?", 1.0)] {
        let fields = [
            "TransformMatrix = 1 0 0 0 1 0 0 0 1",
            "Offset = 4 5 6",
            "ElementSpacing = 1 2 3",
            &format!("DistanceUnits = {unit}"),
        ];
        let volume = read(&fields, &VOXELS);
        assert_eq!(volume.spacing_mm(), DVec3::new(1.0, 2.0, 3.0) * mm);
        assert_eq!(volume.world_from_index().translation, DVec3::new(-4.0, -5.0, 6.0) * mm, "{unit}");
        assert_eq!(volume.has_unknown_scale(), unit == "?");
        let no_body = read(&[&fields[..], &["AnatomicalOrientation = ???"]].concat(), &VOXELS);
        assert!(volume.is_anatomical() && !no_body.is_anatomical());
        assert_eq!(no_body.world_from_index(), volume.world_from_index());
    }
    let identity = "TransformMatrix = 1 0 0 0 1 0 0 0 1";
    let volume = read(&[identity, "ElementSpacing = 0 -2 nan"], &VOXELS);
    assert_eq!(volume.spacing_mm(), DVec3::new(1.0, 2.0, 1.0));
    assert!(volume.is_anatomical() && volume.remarks()[0].contains("is unusable"));
    let flat = read(&["TransformMatrix = 1 0 0 1 0 0 0 0 1", "ElementSpacing = 1 2 3"], &VOXELS);
    assert!(!flat.is_anatomical() && !flat.remarks().is_empty());
    assert!(read(&[identity], &VOXELS).has_unknown_scale());
    let picture =
        read(&["NDims = 2", "DimSize = 4 2", "ElementSpacing = 3 2", "TransformMatrix = 1 0 0 1"], &VOXELS);
    assert_eq!((picture.dims(), picture.spacing_mm()), ([4, 2, 1], DVec3::new(3.0, 2.0, 2.0)));
    assert!(!picture.is_anatomical());
    let identity_4d = "TransformMatrix = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    let series = read(&["NDims = 4", "DimSize = 2 2 2 1", "ElementSpacing = 1 2 3 1", identity_4d], &VOXELS);
    assert!(series.is_anatomical());
    assert_eq!(series.spacing_mm(), DVec3::new(1.0, 2.0, 3.0));
}
