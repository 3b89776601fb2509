//! Tests of NRRD dimensions, orientation and spacing, end to end.

use glam::DVec3;

use super::{VOXELS, assert_refused, header_with, load_attached};
use chiaroscuro_volume::LoadErrorKind;

#[test]
fn other_dimensions_become_three() {
    let dims = |fields: &[&str]| load_attached(&header_with(fields), &VOXELS).map(|volume| volume.dims());
    assert_eq!(dims(&["dimension: 2", "sizes: 4 2"]).unwrap(), [4, 2, 1]);
    assert_eq!(dims(&["dimension: 4", "sizes: 1 2 2 2"]).unwrap(), [2, 2, 2]);
    assert_eq!(dims(&["dimension: 4", "sizes: 2 2 1 2"]).unwrap(), [2, 2, 2]);
    assert_eq!(dims(&["dimension: 4", "sizes: 1 4 2 1"]).unwrap(), [4, 2, 1]);
    let last = ["dimension: 4", "sizes: 1 2 4 1", "space directions: (1,0,0) (0,1,0) (0,0,2) none"];
    assert_eq!(dims(&last).unwrap(), [1, 2, 4]);
    let one = load_attached(&header_with(&["dimension: 1", "sizes: 8"]), &VOXELS);
    assert_refused(one, LoadErrorKind::BadInput, &["dimension"]);
}

#[test]
fn the_world_is_right_anterior_superior_millimetres() {
    const DIRECTIONS: &str = "space directions: (0,2,0) (3,0,0) (0,0,4)";
    const ORIGIN: &str = "space origin: (10, 20, 30)";
    for (space, flip) in [
        ("left-posterior-superior", DVec3::new(-1.0, -1.0, 1.0)),
        ("LPS", DVec3::new(-1.0, -1.0, 1.0)),
        ("left-anterior-superior", DVec3::new(-1.0, 1.0, 1.0)),
        ("right-anterior-superior", DVec3::ONE),
        ("scanner-xyz", DVec3::ONE),
        ("unheard of", DVec3::ONE),
    ] {
        let fields = header_with(&[&format!("space: {space}"), DIRECTIONS, ORIGIN, "spacings: 9 9 9"]);
        let affine = load_attached(&fields, &VOXELS).unwrap().world_from_index();
        assert_eq!(affine.transform_point3(DVec3::ZERO), flip * DVec3::new(10.0, 20.0, 30.0), "{space}");
        let step = affine.transform_vector3(DVec3::new(1.0, 1.0, 1.0));
        assert_eq!(step, flip * DVec3::new(3.0, 2.0, 4.0), "{space}");
    }
    let microns =
        header_with(&["space dimension: 3", DIRECTIONS, ORIGIN, "space units: \"um\" \"um\" \"um\""]);
    let affine = load_attached(&microns, &VOXELS).unwrap().world_from_index();
    assert!((affine.transform_point3(DVec3::ONE) - DVec3::new(0.013, 0.022, 0.034)).length() < 1e-12);
}

#[test]
fn spacings_without_a_space_are_used() {
    let spacing = |fields: &[&str]| load_attached(&header_with(fields), &VOXELS).unwrap().spacing_mm();
    assert_eq!(spacing(&[]), DVec3::ONE);
    let is_unknown =
        |fields: &[&str]| load_attached(&header_with(fields), &VOXELS).unwrap().has_unknown_scale();
    assert!(is_unknown(&[]) && is_unknown(&["spacings: nan nan nan"]));
    assert!(!is_unknown(&["spacings: 1 1 1"]));
    assert!(!is_unknown(&["space: RAS", "space directions: (1,0,0) (0,1,0) (0,0,1)"]));
    assert_eq!(spacing(&["spacings: 0.5 0.5 3"]), DVec3::new(0.5, 0.5, 3.0));
    assert_eq!(spacing(&["spacings: 0.5 NaN 3"]), DVec3::new(0.5, 1.0, 3.0));
    for (field, steps) in
        [("units", "spacings: 1 1 2"), ("space units", "space directions: (1,0,0) (0,1,0) (0,0,2)")]
    {
        let units = format!("{field}: \"voxel\" \"voxel\" \"voxel\"");
        let fields = ["space dimension: 3", steps, &units];
        assert!(is_unknown(&fields) && spacing(&fields) == DVec3::new(1.0, 1.0, 2.0), "{field}");
    }
    assert_eq!(spacing(&["spacings: 2 2 3", "units: \"cm\" \"cm\" \"cm\""]), DVec3::new(20.0, 20.0, 30.0));
    let squeezed = ["dimension: 4", "sizes: 1 2 2 2", "spacings: nan 1 2 3"];
    assert_eq!(spacing(&squeezed), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(spacing(&["dimension: 2", "sizes: 4 2", "spacings: 1 4"]), DVec3::new(1.0, 4.0, 2.0));
}

#[test]
fn ends_of_axes_say_the_distances_of_samples() {
    let read = |fields: &[&str]| load_attached(&header_with(fields), &VOXELS).unwrap();
    let bounds = ["axis mins: 0 0 -4", "axismaxs: 1 2 4"];
    let nodes = read(&[bounds[0], bounds[1], "centers: node node node"]);
    assert_eq!((nodes.spacing_mm(), nodes.has_unknown_scale()), (DVec3::new(1.0, 2.0, 8.0), false));
    assert_eq!(nodes.world_from_index().translation, DVec3::new(0.0, 0.0, -4.0));
    for centers in ["centers: cell cell cell", "centerings: cell cell cell", "number: 8"] {
        let cells = read(&[bounds[0], bounds[1], centers]);
        assert_eq!(cells.spacing_mm(), DVec3::new(0.5, 1.0, 4.0), "{centers}");
        assert_eq!(cells.world_from_index().translation, DVec3::new(0.25, 0.5, -2.0), "{centers}");
    }
    let units = "units: \"cm\" \"cm\" \"cm\"";
    assert_eq!(read(&[bounds[0], bounds[1], units]).spacing_mm(), DVec3::new(5.0, 10.0, 40.0));
    let spaced = read(&[bounds[0], bounds[1], "spacings: 3 nan 3"]);
    assert_eq!(spaced.spacing_mm(), DVec3::new(3.0, 1.0, 3.0), "what is said of distances counts more");
    let squeezed = ["dimension: 4", "sizes: 1 2 2 2", "axis mins: nan 0 0 0", "axis maxs: nan 2 4 6"];
    assert_eq!(read(&squeezed).spacing_mm(), DVec3::new(1.0, 2.0, 3.0));
    assert!(read(&["axis mins: 0 0 0"]).has_unknown_scale(), "half of them say nothing");
    assert!(read(&["axis mins: 0 0", "axis maxs: 1 1 1"]).has_unknown_scale());
    let lying = read(&["axis mins: 0 0 0", "axis maxs: 0 -2 inf"]);
    assert_eq!((lying.spacing_mm(), lying.remarks().len()), (DVec3::ONE, 1));
}

#[test]
fn distances_that_cannot_be_are_mended_and_said() {
    for (field, taken) in [
        ("spacings: 1 0 2", [1.0, 1.0, 2.0]),
        ("spacings: 1 -1.5 1", [1.0, 1.5, 1.0]),
        ("spacings: 1 inf 1", [1.0; 3]),
        ("spacings: 2 1e300 1", [2.0, 1.0, 1.0]),
        ("spacings: 1e-8 1 1e8", [1.0; 3]),
        ("space directions: (2,0,0) (0,1,0) (0,1,0)", [2.0, 1.0, 1.0]),
        ("space directions: (2,0,0) (0,1,0) (0,0,0)", [2.0, 1.0, 1.0]),
        ("space directions: (2,0,0) (0,1,0) (0,nan,0)", [2.0, 1.0, 1.0]),
    ] {
        let volume = load_attached(&header_with(&[field]), &VOXELS).unwrap();
        assert_eq!(volume.spacing_mm(), DVec3::from_array(taken), "{field}");
        assert!(!volume.remarks().is_empty(), "{field}");
    }
}
