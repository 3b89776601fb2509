//! Further layers in slices, whose colours are blended over those of the first one.

use std::sync::Arc;

use eframe::egui::{Color32, ColorImage};

use super::plane::SlicePlane;
use super::slice_image::{LOOKUP_STEPS, displayed_color};
use chiaroscuro_scene::{Settings, TransferFunction, VolumeLayer};
use chiaroscuro_volume::{Dataset, Volume};

/// Largest share of tints, through which the scan is seen.
const MAX_TINT: f64 = 0.5;

/// Layer that is blended over slices of the first one.
#[derive(Debug, Clone)]
pub(super) struct SliceOverlay {
    volume: Arc<Volume>,
    transfer: TransferFunction,
    /// Largest share of its colours.
    most: f64,
}

impl PartialEq for SliceOverlay {
    fn eq(&self, other: &Self) -> bool {
        let identity = |layer: &Self| (layer.volume.content_id(), layer.volume.density_mapping());
        identity(self) == identity(other) && self.transfer == other.transfer && self.most == other.most
    }
}

impl SliceOverlay {
    /// Creates the seen layers behind the first one that have colours of their own.
    pub(super) fn from_dataset(dataset: &Dataset, settings: &Settings) -> Vec<Self> {
        let drawn = settings.resolved_for_dataset(dataset);
        let has_colors = |layer: &VolumeLayer| layer.is_seen() && layer.blend.has_own_color();
        let further = drawn.layers.iter().zip(dataset.fields().iter()).skip(1);
        further
            .filter(|(layer, _)| has_colors(layer))
            .map(|(layer, field)| {
                let volume = field.volume();
                Self {
                    volume: Arc::new(volume.with_density_mapping(layer.density_mapping(&volume.ranges()))),
                    transfer: layer.transfer.clone(),
                    most: if layer.blend.adds_matter() { 1.0 } else { MAX_TINT },
                }
            })
            .collect()
    }

    /// Blends the layer over a slice of a plane at an index across it.
    pub(super) fn blend_over(&self, image: &mut ColorImage, plane: &SlicePlane, at: usize) {
        let range = self.volume.table_range();
        let entry = |step: usize| {
            let place = range.value_at(step as f64 / LOOKUP_STEPS as f64);
            let color = displayed_color(self.transfer.sample(place).color);
            (color, (self.most * self.transfer.opacity_at(place)) as f32)
        };
        let table: Vec<_> = (0..=LOOKUP_STEPS).map(entry).collect();
        for (pixel, voxel) in image.pixels.iter_mut().zip(plane.voxels(self.volume.dims(), at)) {
            let Some(density) = self.volume.density_at(voxel) else { continue };
            let (color, opacity) = table[((density * LOOKUP_STEPS as f64) as usize).min(LOOKUP_STEPS)];
            let [r, g, b] = [0, 1, 2].map(|c| {
                let below = f32::from(pixel[c]);
                (below + (color[c] - below) * opacity).round() as u8
            });
            *pixel = Color32::from_rgb(r, g, b);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use chiaroscuro_scene::{ControlPoint, LayerBlend, LayerVisibility};
    use chiaroscuro_volume::Samples;

    fn volume(value: impl Fn(usize) -> u8) -> Volume {
        let values = (0..64).map(value).collect();
        Volume::with_spacing("t", [4; 3], DVec3::ONE, Samples::U8(values)).unwrap()
    }

    #[test]
    fn colors_of_further_layers_cover_what_they_mark() {
        let dataset = Dataset::from_volumes(volume(|_| 7), [volume(|at| if at % 4 < 2 { 0 } else { 200 })]);
        let points = [(100.0, 0.0), (150.0, 1.0)]
            .map(|(value, opacity)| ControlPoint::new(value, [1.0, 0.0, 0.0], opacity));
        let transfer = TransferFunction { points: points.to_vec(), ..TransferFunction::default() };
        let layer = VolumeLayer { transfer, ..VolumeLayer::default() };
        let plane = SlicePlane::across_axis(2);
        let row = |layer: VolumeLayer| {
            let mut settings = Settings::default();
            settings.layers.push(layer);
            let mut image = ColorImage::filled([4, 4], Color32::from_gray(100));
            for layer in SliceOverlay::from_dataset(&dataset, &settings) {
                layer.blend_over(&mut image, &plane, 1);
            }
            image.pixels[..4].to_vec()
        };
        let (grey, red) = (Color32::from_gray(100), Color32::from_rgb(255, 0, 0));
        assert_eq!(row(layer.clone()), [grey, grey, red, red]);
        let tint = VolumeLayer { blend: LayerBlend::Tint, ..layer.clone() };
        let tinted = row(tint)[2];
        assert!(tinted.r().abs_diff(178) <= 1 && tinted.g().abs_diff(50) <= 1, "half of it: {tinted:?}");
        let hidden = VolumeLayer { visibility: LayerVisibility::Hidden, ..layer };
        assert_eq!(row(hidden), [grey; 4]);
    }
}
