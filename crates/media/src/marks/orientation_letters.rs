//! Orientation of a volume's sides in a picture. Left and right come from the file's orientation and are never
//! guessed.

use glam::DVec3;

use super::layer::MarksLayer;
use chiaroscuro_scene::Camera;

/// Least direction cosine at which a side is named: an edge that is 17° off names one side, and one between two sides
/// names both.
const MIN_DIRECTION_COSINE: f64 = 0.3;

/// Maximum number of sides named at one edge.
const MAX_LETTERS: usize = 2;

/// Directions of scene space with their labels: signed axes, or anatomical letters.
pub const SCENE_SIDES: [(DVec3, [&str; 2]); 6] = [
    (DVec3::X, ["+x", "R"]),
    (DVec3::NEG_X, ["−x", "L"]),
    (DVec3::Y, ["+y", "A"]),
    (DVec3::NEG_Y, ["−y", "P"]),
    (DVec3::Z, ["+z", "S"]),
    (DVec3::NEG_Z, ["−z", "I"]),
];

/// Returns the anatomical letters of a direction in scene space, the nearest first.
fn letters_of_direction(direction: DVec3) -> String {
    let mut found: Vec<(f64, &str)> = SCENE_SIDES
        .iter()
        .map(|(side, [_, letter])| (side.dot(direction), *letter))
        .filter(|(share, _)| *share >= MIN_DIRECTION_COSINE)
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().take(MAX_LETTERS).map(|(_, letter)| letter).collect()
}

/// Returns the anatomical letters at the right, left, top and bottom of a picture.
pub fn orientation_letters(camera: &Camera) -> [String; 4] {
    let view = camera.scene_from_view();
    orientation_letters_of_plane(view.x_axis, view.y_axis)
}

/// Returns the anatomical letters at the right, left, top and bottom of a plane whose `right` and `up` directions are
/// unit vectors in scene space.
pub fn orientation_letters_of_plane(right: DVec3, up: DVec3) -> [String; 4] {
    [right, -right, up, -up].map(letters_of_direction)
}

/// Draws the letters at the edges of a picture.
pub(super) fn draw(layer: &mut MarksLayer, camera: &Camera, [width, height]: [f64; 2], letters: f64) {
    let [right, left, top, bottom] = orientation_letters(camera);
    let edge = letters / 2.0;
    layer.write(&right, [width - edge, height / 2.0], [1.0, 0.5], letters);
    layer.write(&left, [edge, height / 2.0], [0.0, 0.5], letters);
    layer.write(&top, [width / 2.0, edge], [0.5, 0.0], letters);
    layer.write(&bottom, [width / 2.0, height - edge], [0.5, 1.0], letters);
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_scene::{SceneAxis, StandardView};
    use chiaroscuro_volume::{LoadControl, Volume};
    use chiaroscuro_volume_io::{LoadOptions, load};

    /// Reads a volume of 8 × 9 × 10 voxels with the axes of an NRRD header.
    fn volume(space: &str, directions: [[i32; 3]; 3]) -> Volume {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("head.nrrd");
        let [a, b, c] = directions.map(|[x, y, z]| format!("({x},{y},{z})"));
        let header = format!(
            "NRRD0004\ntype: uint8\ndimension: 3\nspace: {space}\nsizes: 8 9 10\nspace directions: {a} {b} {c}\n\
             space origin: (0,0,0)\nencoding: raw\n\n"
        );
        std::fs::write(&path, [header.as_bytes(), &[7; 720]].concat()).unwrap();
        load(&path, &LoadOptions::default(), &LoadControl::new()).unwrap()
    }

    /// Returns the letter of an axis direction in the space of an NRRD header (right-anterior-superior, or with
    /// opposite axes).
    fn letter_of(space: &str, direction: [i32; 3]) -> &'static str {
        let words: Vec<&str> = space.split('-').collect();
        let axis = direction.iter().position(|&c| c != 0).unwrap();
        match (words[axis], direction[axis] > 0) {
            ("right", true) | ("left", false) => "R",
            ("left", true) | ("right", false) => "L",
            ("anterior", true) | ("posterior", false) => "A",
            ("posterior", true) | ("anterior", false) => "P",
            ("superior", true) | ("inferior", false) => "S",
            _ => "I",
        }
    }

    #[test]
    fn letters_are_where_the_file_says() {
        let axes = [
            [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
            [[-1, 0, 0], [0, 1, 0], [0, 0, -1]],
            [[0, 0, 1], [1, 0, 0], [0, -1, 0]],
        ];
        for space in ["right-anterior-superior", "left-posterior-superior", "left-anterior-superior"] {
            for directions in axes {
                let volume = volume(space, directions);
                assert!(volume.is_anatomical());
                let scene = volume.scene();
                for up in SceneAxis::ALL {
                    for view in StandardView::ALL.into_iter().take(6) {
                        let mut camera = Camera { up, ..Camera::default() };
                        camera.set_standard_view(view);
                        let place = |index: DVec3| {
                            let point = scene.scene_from_index.transform_point3(index);
                            let (x, y, _) = camera.pixel_from_scene(point, 100.0, 100.0).unwrap();
                            (x, y)
                        };
                        let middle = DVec3::new(3.5, 4.0, 4.5);
                        let [right, left, top, bottom] = orientation_letters(&camera);
                        for (axis, step) in DVec3::AXES.into_iter().enumerate() {
                            let (from, to) = (place(middle - step), place(middle + step));
                            let (dx, dy) = (to.0 - from.0, to.1 - from.1);
                            if dx * dx + dy * dy < 1.0 {
                                // The axis is parallel to the line of sight.
                                continue;
                            }
                            let edge = match (dx.abs() > dy.abs(), dx > 0.0, dy > 0.0) {
                                (true, true, _) => &right,
                                (true, false, _) => &left,
                                (false, _, true) => &bottom,
                                (false, _, false) => &top,
                            };
                            let wanted = letter_of(space, directions[axis]);
                            assert_eq!(edge, wanted, "{space} {directions:?} {view:?} with {up:?} up");
                        }
                    }
                }
            }
        }
    }

    /// Reads phantoms of heads with an L on their left side, written by other programs with permuted and flipped
    /// axes.
    #[test]
    fn the_left_of_a_head_is_named_so_in_every_format() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracle/phantom");
        let (mut bodies, mut others) = (0, 0);
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            // Raw voxel files are opened through their headers.
            if name.rsplit('.').next() == Some("bin") {
                continue;
            }
            let volume = load(&path, &LoadOptions::default(), &LoadControl::new()).unwrap();
            let is_body = [".nrrd", ".nii.gz", ".mha", ".dcm"].iter().any(|ending| name.ends_with(ending));
            assert_eq!(volume.is_anatomical(), is_body, "{name}");
            let ([nx, ny, _], scene) = (volume.dims(), volume.scene());
            let marked: Vec<DVec3> = (0..volume.voxel_count())
                .filter(|&voxel| volume.samples().value(voxel) == 120.0)
                .map(|voxel| {
                    DVec3::new((voxel % nx) as f64, (voxel / nx % ny) as f64, (voxel / nx / ny) as f64)
                })
                .map(|index| scene.scene_from_index.transform_point3(index))
                .collect();
            let middle = marked.iter().sum::<DVec3>() / marked.len() as f64;
            // Face of the orientation cube in front of it.
            let (_, names) =
                SCENE_SIDES.into_iter().max_by(|a, b| a.0.dot(middle).total_cmp(&b.0.dot(middle))).unwrap();
            assert_eq!(names, ["−x", "L"], "{name}");
            assert_eq!(names[usize::from(is_body)], if is_body { "L" } else { "−x" }, "{name}");
            // Seen from the front it is on the right, and the letter there says so.
            let mut camera = Camera::default();
            camera.set_standard_view(StandardView::PlusY);
            let (x, ..) = camera.pixel_from_scene(middle, 100.0, 100.0).unwrap();
            assert!(x > 60.0, "{name}: {x}");
            assert_eq!(orientation_letters(&camera)[0], "L");
            *(if is_body { &mut bodies } else { &mut others }) += 1;
        }
        assert!(bodies > 50 && others > 15, "{bodies} of bodies, {others} others");
    }

    #[test]
    fn faces_are_seen_as_a_mirror_does_not_show_them() {
        // From the front, a patient's right is on the left; from above the head, the face is at the bottom.
        let mut camera = Camera::default();
        camera.set_standard_view(StandardView::PlusY);
        assert_eq!(orientation_letters(&camera), ["L", "R", "S", "I"]);
        camera.set_standard_view(StandardView::PlusZ);
        assert_eq!(orientation_letters(&camera), ["R", "L", "A", "P"]);
        camera.elevation_deg = 0.0;
        camera.azimuth_deg = 60.0;
        assert_eq!(orientation_letters(&camera)[..2], ["LA", "RP"]);
    }
}
