//! Outline of the part under the pointer, while a click would cut it: found on a thread once the pointer rests.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{
    Color32, ColorImage, Painter, Pos2, Rect, Response, TextureHandle, TextureOptions, Ui, pos2,
};

use crate::app::common::theme;
use crate::app::viewport::light_probe;
use crate::app::worker::jobs::{JobKind, JobSlot};
use chiaroscuro_scene::{Camera, ComponentCut, ComponentSilhouette, Settings};
use chiaroscuro_volume::Volume;

/// Time for which the pointer rests before the part is looked for, in seconds.
const REST_S: f64 = 0.15;

/// Distance within which the pointer counts as resting, in points.
const REST_DISTANCE: f32 = 3.0;

/// Opacity of the covered area, of 255: the picture stays readable.
const COVER_ALPHA: u8 = 36;

/// Inputs of an outline.
#[derive(Debug, Clone, PartialEq)]
struct PartInputs {
    component: ComponentCut,
    camera: Camera,
    /// Content identifier of the volume, and hash of the cuts that hide its voxels.
    volume: (u64, Option<u64>),
    size: [usize; 2],
}

/// Outline of the part under the pointer.
#[derive(Default)]
pub(super) struct PartHighlight {
    /// Place at which the pointer rests, and the time since when.
    rest: Option<(Pos2, f64)>,
    /// Place for which the part was looked for.
    place: Option<Pos2>,
    search: JobSlot<Option<ComponentSilhouette>, PartInputs>,
    shown: Option<(PartInputs, Option<TextureHandle>)>,
}

impl std::fmt::Debug for PartHighlight {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PartHighlight").field("rest", &self.rest).finish_non_exhaustive()
    }
}

impl PartHighlight {
    /// Looks for the part under the pointer once it rests over the picture, and takes over what was found.
    pub(super) fn update(&mut self, ui: &Ui, response: &Response, settings: &Settings, volume: &Arc<Volume>) {
        let identity = (volume.content_id(), settings.cuts.shapes_id());
        if self.shown.as_ref().is_some_and(|(of, _)| of.camera != settings.camera || of.volume != identity) {
            self.clear();
        }
        let Some(at) = response.hover_pos().filter(|_| !response.dragged()) else { return self.clear() };
        let now_s = ui.input(|input| input.time);
        let is_near = |place: Option<Pos2>| place.is_some_and(|place| place.distance(at) <= REST_DISTANCE);
        let since = match self.rest {
            Some((place, since)) if is_near(Some(place)) => since,
            _ => {
                self.rest = Some((at, now_s));
                now_s
            }
        };
        if let Some((inputs, found)) = self.search.take_ended() {
            let texture = found
                .ok()
                .flatten()
                .map(|found| ui.ctx().load_texture("part", highlight_image(&found), TextureOptions::LINEAR));
            self.shown = Some((inputs, texture));
        }
        if is_near(self.place) {
            return;
        }
        if now_s - since < REST_S {
            ui.ctx().request_repaint_after(Duration::from_secs_f64(REST_S));
            return;
        }
        self.place = Some(at);
        let Some(found) = light_probe::probe_at(volume, settings, response.rect, at) else {
            self.shown = None;
            return self.search.discard();
        };
        let size = response.rect.size();
        let inputs = PartInputs {
            component: ComponentCut::from_picked(settings, volume, found.point, found.value),
            camera: settings.camera.clone(),
            volume: identity,
            size: [size.x, size.y].map(|edge| edge.round().max(1.0) as usize),
        };
        let (volume, wanted) = (Arc::clone(volume), inputs.clone());
        let find = move |_: &_| {
            let PartInputs { component, camera, size, .. } = &wanted;
            ComponentSilhouette::new(&volume, component, camera, *size)
        };
        if let Err(err) = self.search.start(JobKind::PartSilhouette, ui.ctx(), inputs, find) {
            log::warn!("the part under the pointer is not outlined: {err}");
        }
    }

    /// Ends the search, and shows no outline.
    pub(super) fn clear(&mut self) {
        self.search.discard();
        (self.rest, self.place, self.shown) = (None, None, None);
    }

    /// Paints the outline over the picture.
    pub(super) fn paint(&self, painter: &Painter, picture: Rect) {
        if let Some((_, Some(texture))) = &self.shown {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(texture.id(), picture, whole, Color32::WHITE);
        }
    }
}

/// Returns the image of a silhouette: its contour, with a faint area inside.
fn highlight_image(silhouette: &ComponentSilhouette) -> ColorImage {
    let [columns, rows] = silhouette.size;
    let [r, g, b, _] = theme::ACCENT.to_array();
    let cover = Color32::from_rgba_unmultiplied(r, g, b, COVER_ALPHA);
    let color = |at: usize| match silhouette.is_covered[at] {
        _ if silhouette.is_contour(at % columns, at / columns) => theme::ACCENT,
        true => cover,
        false => Color32::TRANSPARENT,
    };
    ColorImage::new([columns, rows], (0..columns * rows).map(color).collect())
}
