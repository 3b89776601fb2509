//! Floor of the first look: decides whether it helps, and its colour. Shadows improve an image, and some objects cast
//! none on themselves.

use glam::DVec3;

use super::object::VisibleObject;
use crate::Settings;
use chiaroscuro_volume::Volume;

/// Share of the object in shadow below which its own shadows hardly show.
const MAX_SELF_SHADOW: f64 = 0.04;

/// Compactness from which a shape counts as an object: a ball of twenty cells has 0.93, a wall of one cell 0.5, haze
/// less.
const MIN_COMPACTNESS: f64 = 0.7;

/// Camera elevation in degrees from which the floor is seen from above, and not edge-on.
const MIN_ELEVATION_DEG: f64 = 8.0;

/// Displayed brightness of a fully lit floor in a first look, as a share of white in sRGB: as bright as material, and
/// dark enough that the eye stays with that.
const TARGET_GREY: f64 = 0.30;

/// Range of the floor's grey. A darker one would show no shadow (a tenth of sRGB is a hundredth of the light), and
/// none is lighter than the default floor.
const GREY_RANGE: [f64; 2] = [0.1, 0.6];

/// Returns the floor colour for an exposure: the floor is never brighter than the object on it.
pub fn floor_color(exposure: f64) -> [f32; 3] {
    [(TARGET_GREY / exposure).clamp(GREY_RANGE[0], GREY_RANGE[1]) as f32; 3]
}

/// Returns true if the first look has a floor.
///
/// Objects that stand on a broad base have one, and compact objects with hardly a shadow on themselves (`shadowed`:
/// its share). Objects that the volume's boundary cuts off below have none, as heads at the neck, which would stand
/// on the cut; nor does an empty view.
pub fn needs_floor(settings: &Settings, volume: &Volume, shadowed: f64) -> bool {
    if settings.camera.elevation_deg < MIN_ELEVATION_DEG || volume.is_anatomical() {
        return false;
    }
    let object = VisibleObject::from_settings(settings, volume);
    if object.is_empty() || object.compactness() < MIN_COMPACTNESS {
        return false;
    }
    match ObjectBase::classify(&object, volume, settings.camera.up.direction()) {
        ObjectBase::Cut => false,
        ObjectBase::Narrow => shadowed < MAX_SELF_SHADOW,
        // Only a single object stands: pieces would fall apart.
        ObjectBase::Broad => shadowed < MAX_SELF_SHADOW || object.largest_part_share() > MIN_LARGEST_PART,
    }
}

/// Share of the object in its largest part from which it counts as a single object; the rest is noise.
const MIN_LARGEST_PART: f64 = 0.9;

/// Height of the lowest part of an object, as a share of its height.
const BASE_HEIGHT: f64 = 0.03;

/// Width of an object's lowest part from which it rests on a floor, as a share of the object's width in both
/// directions: the legs of a chair have nearly all, the roots of a tooth a half, the cap of a ball a third. Less is a
/// tip.
const MIN_BASE_WIDTH: f64 = 0.3;

/// Share of an object's lowest part on the volume's face from which the object is cut off there.
const MAX_FACE_SHARE: f64 = 0.3;

/// Shape of an object's lower end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ObjectBase {
    /// Cut off by the boundary of the data.
    Cut,
    /// Tip, on which nothing stands.
    Narrow,
    /// Broad enough to stand on.
    Broad,
}

impl ObjectBase {
    /// Determines the base of an object in a volume; `up` is in scene space.
    fn classify(object: &VisibleObject, volume: &Volume, up: DVec3) -> Self {
        let scene_from_index = volume.scene().scene_from_index;
        // Direction to the lower face of the volume, in index space.
        let index_up = scene_from_index.inverse().transform_vector3(up);
        let axis = if index_up.x.abs() > index_up.y.abs().max(index_up.z.abs()) {
            0
        } else if index_up.y.abs() > index_up.z.abs() {
            1
        } else {
            2
        };
        let is_on_face = |cell: [usize; 3]| {
            if index_up[axis] > 0.0 { cell[axis] == 0 } else { cell[axis] + 1 == object.cells[axis] }
        };
        let (side, ahead) = up.any_orthonormal_pair();
        let places: Vec<(DVec3, bool)> = object
            .occupied_cells()
            .map(|cell| {
                let place = scene_from_index.transform_point3(object.cell_centre(cell));
                (DVec3::new(place.dot(side), place.dot(ahead), place.dot(up)), is_on_face(cell))
            })
            .collect();
        let [low, high] = bounding_box(places.iter().map(|(place, _)| *place));
        let edge = volume.scene().smallest_edge();
        let top = low.z + (BASE_HEIGHT * (high.z - low.z)).max(edge);
        let lowest: Vec<_> = places.iter().filter(|(place, _)| place.z <= top).collect();
        let [base_low, base_high] = bounding_box(lowest.iter().map(|(place, _)| *place));
        let on_face = lowest.iter().filter(|(_, is_on_face)| *is_on_face).count();
        if on_face as f64 > MAX_FACE_SHARE * lowest.len() as f64 {
            return Self::Cut;
        }
        let share = (base_high - base_low + edge) / (high - low + edge);
        if share.x.min(share.y) >= MIN_BASE_WIDTH { Self::Broad } else { Self::Narrow }
    }
}

/// Returns the corners of the bounding box of points.
fn bounding_box(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    points.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_look::lay_floor;
    use crate::first_look::tests::threshold_settings;
    use chiaroscuro_volume::Samples;

    const N: usize = 40;

    /// Returns settings that show values above 100, seen from above.
    fn look() -> Settings {
        let mut settings = threshold_settings();
        settings.camera.elevation_deg = 25.0;
        settings
    }

    fn volume(is_there: impl Fn(DVec3) -> bool) -> Volume {
        let value = |at: usize| {
            let place = [at % N, at / N % N, at / N / N].map(|n| n as f64 - 19.5);
            if is_there(DVec3::from(place)) { 255u8 } else { 0 }
        };
        let voxels = (0..N * N * N).map(value).collect();
        Volume::with_spacing("t", [N; 3], DVec3::ONE, Samples::U8(voxels)).unwrap()
    }

    fn ball(p: DVec3) -> bool {
        p.length() < 12.0
    }

    fn spindle(p: DVec3) -> bool {
        p.truncate().length() < 12.0 - p.z.abs()
    }

    fn block(p: DVec3) -> bool {
        p.abs().max_element() < 12.0
    }

    fn table(p: DVec3) -> bool {
        let is_leg = p.x.abs() > 8.0 && p.y.abs() > 8.0;
        block(p) && (p.z > 4.0 || is_leg)
    }

    fn pieces(p: DVec3) -> bool {
        block(p) && p.x.abs() > 2.0 && p.y.abs() > 2.0
    }

    #[test]
    fn what_stands_stands_on_a_floor() {
        for (name, is_there, shadowed, expected) in [
            ("block", block as fn(DVec3) -> bool, 0.5, true),
            ("table", table, 0.5, true),
            ("ball", ball, 0.5, true),
            ("spindle", spindle, 0.5, false),
            ("spindle without shadows", spindle, 0.01, true),
            ("pieces", pieces, 0.5, false),
        ] {
            assert_eq!(needs_floor(&look(), &volume(is_there), shadowed), expected, "{name}");
        }
    }

    #[test]
    fn what_goes_on_below_does_not() {
        // A bust whose neck is cut off by the boundary.
        let bust = |p: DVec3| {
            (p - DVec3::new(0.0, 0.0, 4.0)).length() < 12.0 || p.z < 0.0 && p.truncate().length() < 9.0
        };
        assert!(!needs_floor(&look(), &volume(bust), 0.01));
    }

    #[test]
    fn haze_and_shells_do_not() {
        let shell = |p: DVec3| (11.0..12.0).contains(&p.length());
        assert!(!needs_floor(&look(), &volume(shell), 0.01));
        let specks = |p: DVec3| block(p) && (p.x + 2.0 * p.y + 3.0 * p.z).rem_euclid(5.0) < 1.0;
        assert!(!needs_floor(&look(), &volume(specks), 0.01));
    }

    #[test]
    fn nothing_has_no_floor_and_leaves_it_where_it_is() {
        let nothing = volume(|_| false);
        assert!(!needs_floor(&look(), &nothing, 0.01));
        let mut settings = look();
        settings.floor.height = -0.3;
        lay_floor(&mut settings, &nothing);
        assert_eq!(settings.floor.height, -0.3);
    }

    #[test]
    fn the_floor_is_laid_under_what_is_shown() {
        let ball = volume(ball);
        let mut settings = look();
        lay_floor(&mut settings, &ball);
        // The ball's radius is twelve of forty voxels, and a scene unit twenty.
        assert!((settings.floor.height + 12.0 / 20.0).abs() < 0.05, "{}", settings.floor.height);
        assert_eq!(
            settings,
            Settings { floor: settings.floor.clone(), ..look() },
            "and nothing else changes"
        );
    }

    #[test]
    fn floors_are_no_brighter_for_a_longer_exposure() {
        let shown = |exposure: f64| f64::from(floor_color(exposure)[0]) * exposure;
        assert!((shown(1.0) - TARGET_GREY).abs() < 1e-6 && (shown(1.8) - TARGET_GREY).abs() < 1e-6);
        assert_eq!(floor_color(0.0)[0], GREY_RANGE[1] as f32);
        assert_eq!(floor_color(1e9)[0], GREY_RANGE[0] as f32);
    }

    #[test]
    fn an_eye_that_does_not_look_down_sees_none() {
        let mut settings = look();
        settings.camera.elevation_deg = 2.0;
        assert!(!needs_floor(&settings, &volume(block), 0.01));
    }
}
