//! Outline of the visible object of a volume, by which views are framed.

use glam::DVec3;

use super::super::object::VisibleObject;
use super::{frame_points, outline_points};
use crate::{Camera, FRAME_ASPECT, LayerBlend, Projection, Settings};
use chiaroscuro_volume::{Dataset, Volume};

/// Share of the frame that the object may reach when orbiting: all but a small margin.
const MAX_FRAME_SHARE: f64 = 0.98;

/// Smallest orthographic camera distance, as a multiple of the depth of the nearest part in front of the target.
const MIN_DEPTH_FACTOR: f64 = 1.05;

/// Share of outline points that may lie outside: single voxels of noise.
const OUTLIER_SHARE: f64 = 0.001;

/// Outline of an object as points in scene space.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ObjectOutline {
    points: Vec<DVec3>,
}

impl ObjectOutline {
    /// Computes the outline of what settings show of a volume, without specks, tables and clipped parts. Reads all
    /// voxels.
    pub fn from_settings(settings: &Settings, volume: &Volume) -> Self {
        let mut points = outline_points(volume, &VisibleObject::from_settings(settings, volume));
        let region = settings.cuts.visible_part().region(&volume.scene());
        let index_from_scene = volume.scene().scene_from_index.inverse();
        let is_left = |point: &DVec3| region.contains(index_from_scene.transform_point3(*point));
        if points.iter().any(is_left) {
            points.retain(is_left);
        }
        Self { points }
    }

    /// Computes the outline of what settings show of all fields of a dataset that have matter. Reads all voxels.
    pub fn from_dataset(settings: &Settings, dataset: &Dataset) -> Self {
        let mut points = Vec::new();
        for (index, (layer, field)) in settings.layers.iter().zip(dataset.fields().iter()).enumerate() {
            let has_matter = index == 0 || layer.blend == LayerBlend::Add;
            if layer.is_seen() && has_matter {
                let shown_first = settings.clone().with_first_exchanged(index);
                points.extend(Self::from_settings(&shown_first, field.volume()).points);
            }
        }
        Self { points }
    }

    /// Returns true if there is nothing to frame.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Points a camera at the object without rotating it, close enough that the object fills the frame.
    pub fn frame(&self, camera: &mut Camera) {
        if !self.is_empty() {
            frame_points(camera, &self.points);
        }
    }

    /// Returns the least distance from its target at which a camera has the object in its frame, without rotating it;
    /// 0 without an object.
    pub fn least_distance(&self, camera: &Camera) -> f64 {
        least_distance(&self.points, camera)
    }
}

/// Returns the least distance from its target at which a camera has all but a share of [`OUTLIER_SHARE`] of the
/// points in its frame; 0 without points.
pub(super) fn least_distance(points: &[DVec3], camera: &Camera) -> f64 {
    if points.is_empty() {
        return 0.0;
    }
    let view = camera.scene_from_view();
    let up = MAX_FRAME_SHARE * camera.half_height_at_target(FRAME_ASPECT) / camera.distance;
    let target = DVec3::from(camera.target);
    let mut distances: Vec<f64> = points
        .iter()
        .map(|point| {
            let local = view.transpose() * (*point - target);
            let aside = (local.y.abs() / up).max(local.x.abs() / (up * FRAME_ASPECT));
            match camera.projection {
                // Points closer to the camera than the target by z appear larger.
                Projection::Perspective => aside + local.z,
                // No point may be behind the camera.
                Projection::Orthographic => aside.max(local.z * MIN_DEPTH_FACTOR),
            }
        })
        .collect();
    let at = ((distances.len() as f64 * (1.0 - OUTLIER_SHARE)) as usize).min(distances.len() - 1);
    *distances.select_nth_unstable_by(at, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_look::first_settings;
    use chiaroscuro_volume::{Histogram, Samples};

    /// Returns a bar along x in a corner of a volume.
    fn bar() -> Volume {
        let n = 48;
        let value = |at: usize| {
            let [x, y, z] = [at % n, at / n % n, at / n / n];
            if (4..44).contains(&x) && (6..12).contains(&y) && (8..14).contains(&z) { 200 } else { 0 }
        };
        let voxels = Samples::U8((0..n * n * n).map(value).collect());
        Volume::with_spacing("bar", [n; 3], DVec3::ONE, voxels).unwrap()
    }

    /// Returns the extent of the object in a 4:3 image: 1 is the border.
    fn reach(outline: &ObjectOutline, camera: &Camera) -> f64 {
        let reach = outline.points.iter().map(|point| {
            let (x, y, _) = camera.pixel_from_scene(*point, 400.0, 300.0).unwrap();
            ((x - 200.0) / 200.0).abs().max(((y - 150.0) / 150.0).abs())
        });
        reach.fold(0.0, f64::max)
    }

    #[test]
    fn views_from_all_sides_have_the_object_in_their_frame() {
        let volume = bar();
        let settings = first_settings(&volume, &Histogram::from_volume(&volume));
        let outline = ObjectOutline::from_settings(&settings, &volume);
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for (azimuth_deg, elevation_deg) in [(0.0, 0.0), (90.0, 0.0), (0.0, 90.0), (40.0, -30.0)] {
                let mut camera = Camera { projection, azimuth_deg, elevation_deg, ..settings.camera.clone() };
                outline.frame(&mut camera);
                let reached = reach(&outline, &camera);
                assert!((0.4..=1.0).contains(&reached), "{projection:?} {azimuth_deg}: {reached}");
                camera.distance = outline.least_distance(&camera);
                let reached = reach(&outline, &camera);
                // In orthographic projection, a long object seen from its end needs room for the camera.
                let least = if projection == Projection::Perspective { MAX_FRAME_SHARE - 0.02 } else { 0.1 };
                assert!(
                    (least..MAX_FRAME_SHARE + 0.02).contains(&reached),
                    "{projection:?} {azimuth_deg}: {reached}"
                );
            }
        }
    }

    #[test]
    fn what_is_cut_away_is_not_framed() {
        let volume = bar();
        let mut settings = first_settings(&volume, &Histogram::from_volume(&volume));
        let whole = ObjectOutline::from_settings(&settings, &volume);
        settings.cuts.crop.on = true;
        settings.cuts.crop.high[0] = 0.5;
        let half = ObjectOutline::from_settings(&settings, &volume);
        assert!(half.points.len() < whole.points.len() && !half.is_empty());
        // With everything clipped, the whole object is framed.
        settings.cuts.crop.high[0] = 0.02;
        assert_eq!(ObjectOutline::from_settings(&settings, &volume), whole);
        assert_eq!(ObjectOutline::default().least_distance(&settings.camera), 0.0);
    }
}
