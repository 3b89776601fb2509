//! Central picture of the window, pixel for pixel, with its overlays and mouse input.

use eframe::egui::{self, Rect, Role, Sense, Shape, WidgetInfo, pos2};

use crate::app::App;
use crate::app::common::commands::AppCommand;
use crate::app::common::theme;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use crate::app::viewport::camera_transition::CameraTransition;
use crate::app::viewport::canvas::Canvas;
use crate::app::viewport::compare::Compare;
use crate::app::viewport::cut_handles::CutHandles;
use crate::app::viewport::first_use_hints::FirstUseHints;
use crate::app::viewport::light_handles::LightHandles;
use crate::app::viewport::light_probe::{LightProbe, ProbePointer};
use crate::app::viewport::mouse_navigation::OrbitDrag;
use crate::app::viewport::overlay::ViewportOverlay;
use crate::app::viewport::overlay::ct_preset_row::CtPresetRow;
use crate::app::viewport::overlay::export_marks_preview::ExportMarksPreview;
use crate::app::viewport::view_projection::ViewProjection;
use crate::app::viewport::{
    RendererStatus, Viewport, empty_picture_notice, light_chips, light_probe, mouse_navigation,
};
use crate::app::windows::slices::SlicesWindow;
use chiaroscuro_render::GpuError;
use chiaroscuro_scene::{ImageSpec, Settings, first_look::ObjectOutline};

/// Inputs of the picture: the state that it shows, and the values that the mouse changes.
pub(crate) struct PictureInputs<'a> {
    /// Settings of the look; the mouse may change camera and lights.
    pub settings: &'a mut Settings,
    /// Settings of the first look, to which resets go back.
    pub defaults: &'a Settings,
    /// Render worker with its pictures.
    pub viewport: &'a mut Viewport,
    /// Handles of the lights in the picture.
    pub handles: &'a mut LightHandles,
    /// Handles of the crop box and the clip plane.
    pub cut_handles: &'a mut CutHandles,
    /// Index of the light whose handle is highlighted.
    pub selected_light: &'a mut usize,
    /// Comparison of two looks in one picture.
    pub compare: &'a mut Compare,
    /// Overlay of light chips, bounding box, scale bar and orientation cube.
    pub overlay: ViewportOverlay,
    /// Probe of the sample under the pointer.
    pub probe: &'a mut LightProbe,
    /// State of the current camera orbit.
    pub orbit: &'a mut OrbitDrag,
    /// Animated transition between two views.
    pub turning: &'a mut CameraTransition,
    /// Outline of the object, if it is known.
    pub outline: Option<&'a ObjectOutline>,
    /// Size and annotations of the picture to export, while the export dialog is open.
    pub export_preview: Option<ImageSpec>,
    /// Annotations that would be drawn over the exported picture.
    pub export_marks: &'a mut ExportMarksPreview,
    /// Window of orthogonal slices with its cursor.
    pub slices: &'a mut SlicesWindow,
    /// Hints over the picture on the first use of the program.
    pub hints: &'a mut FirstUseHints,
    /// Row of common CT presets.
    pub ct_looks: &'a mut CtPresetRow,
    /// Facts about the open volume.
    pub volume: Option<&'a VolumeFacts>,
    /// Statistics and state of the renderer.
    pub facts: &'a RendererStatus,
    /// Queue of the commands that the user issues.
    pub commands: &'a mut Vec<AppCommand>,
}

/// Width of the strip at the picture's edge that belongs to the panel borders, in points.
const BORDER: f32 = 4.0;

/// Shows the picture with its overlays, and handles the mouse on it.
pub(crate) fn show(ui: &mut egui::Ui, inputs: PictureInputs<'_>) -> (Canvas, Result<(), GpuError>) {
    let PictureInputs {
        settings,
        defaults,
        viewport,
        handles,
        cut_handles,
        selected_light,
        compare,
        overlay,
        probe,
        orbit,
        turning,
        outline,
        export_preview: image_spec,
        export_marks,
        slices,
        hints,
        ct_looks,
        volume,
        facts,
        commands,
    } = inputs;
    let whole = Canvas::inscribed(ui.available_rect_before_wrap(), ui.pixels_per_point());
    ui.allocate_rect(whole.rect, Sense::hover());
    let canvas = match image_spec {
        // Export preview, in the aspect ratio of the exported picture.
        Some(ImageSpec { size: [width, height], .. }) => {
            ui.painter().rect_filled(whole.rect, 0.0, ui.visuals().extreme_bg_color);
            whole.with_aspect_ratio(f64::from(width) / f64::from(height.max(1)), ui.pixels_per_point())
        }
        None => whole,
    };
    // The resize handles of panels extend into the picture.
    let inside = canvas.rect.shrink(BORDER);
    let mut response = ui.interact(inside, ui.scope_id().with("picture"), Sense::click_and_drag());
    response.rect = canvas.rect;
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, text::picture::PICTURE));
    let Some(volume) = volume else {
        ui.painter().rect_filled(canvas.rect, 0.0, theme::EMPTY_CANVAS);
        return (canvas, Ok(()));
    };
    let &VolumeFacts { scene, is_anatomical, has_unknown_scale, .. } = volume;
    let is_by_value = settings.labels.is_empty();
    let is_one_view = !compare.shows_two_views();
    mouse_navigation::navigate(
        ui,
        &response,
        settings,
        *selected_light,
        !(handles.captures_wheel || cut_handles.captures_wheel),
        // Label maps have no window and level.
        viewport.dataset().map(|dataset| dataset.volume().shown_range()).filter(|_| is_by_value),
        (orbit, outline),
    );
    if response.double_clicked()
        && is_one_view
        && let (Some(at), Some(dataset)) = (response.interact_pointer_pos(), viewport.dataset())
        && let Some(found) = light_probe::probe_at(dataset.volume(), settings, canvas.rect, at)
    {
        settings.camera.set_orbit_centre(found.point);
    }
    if slices.open
        && is_one_view
        && response.clicked()
        && let (Some(at), Some(dataset)) = (response.interact_pointer_pos(), viewport.dataset())
        && let Some(found) = light_probe::probe_at(dataset.volume(), settings, canvas.rect, at)
    {
        slices.move_cursor_to(found.index, dataset.volume().dims());
    }
    // Placeholder shapes, filled in after the lights have been moved: no frame of delay.
    let places = [(); 2].map(|()| ui.painter().add(Shape::Noop));
    let moving =
        ui.ctx().animate_bool_with_time(ui.scope_id().with("box"), response.dragged(), theme::FADE_S);
    if is_one_view {
        overlay.show_bounding_box(ui, canvas.rect, &settings.camera, &scene, moving);
        let view_projection = ViewProjection { camera: settings.camera.clone(), picture: canvas.rect };
        slices.paint_cursor(&ui.painter_at(canvas.rect), &view_projection, &scene);
    }
    cut_handles.show(ui, canvas.rect, settings, &scene, handles.is_hidden || !is_one_view);
    if is_one_view {
        handles.show(ui, canvas.rect, settings, scene.support_radius(), selected_light);
    } else {
        handles.clear_frame_state();
    }
    // A comparison has captions at the top and at the bottom.
    let body = is_anatomical.then(|| compare.area_without_labels(ui, canvas.rect));
    let chips = overlay
        .visible
        .then(|| light_chips::show(ui, canvas.rect, settings, selected_light, facts, commands));
    if let Some(image_spec) = &image_spec {
        // Export preview: with the annotations of the exported picture, and without the window's overlays.
        if let Some(dataset) = viewport.dataset().filter(|_| is_one_view) {
            export_marks.show(ui, canvas.rect, image_spec, settings, dataset.volume());
        }
    } else if is_one_view {
        let body = body.map(|body| area_below_chips(body, chips));
        let scale = (&scene, has_unknown_scale);
        if let Some(view) = overlay.show(ui, canvas.rect, &settings.camera, scale, body) {
            commands.push(AppCommand::LookFrom(view));
        }
        // The hints of the first use are in the same place.
        if overlay.visible && !hints.visible {
            ct_looks.show(ui, canvas.rect, settings, volume, commands);
        }
    }
    if let Some(dataset) = viewport.dataset().filter(|_| probe.is_active && is_one_view) {
        let pointer = response.hover_pos().filter(|_| !response.dragged());
        let pointing = ProbePointer { pointer, clicked: response.clicked() && !response.double_clicked() };
        probe.show(ui, canvas.rect, settings, dataset.volume(), pointing);
    }
    if let Some(dataset) = viewport.dataset() {
        empty_picture_notice::show_empty_picture_notice(
            ui,
            canvas.rect,
            settings,
            defaults,
            dataset.volume(),
            facts,
        );
    }
    settings.sanitise();
    // The old picture stays until the volume has been corrected as the settings say.
    let is_correcting =
        viewport.dataset().is_some_and(|dataset| *dataset.volume().corrections() != settings.volume);
    let result = if canvas.size.contains(&0) || is_correcting {
        Ok(())
    } else {
        let now_s = ui.input(|input| input.time);
        let looks = match turning.current_view(&settings.camera, now_s) {
            Some(camera) => {
                ui.ctx().request_repaint();
                compare.looks(&Settings { camera, ..settings.clone() })
            }
            None => compare.looks(settings),
        };
        viewport.update(looks, canvas.size, ui.ctx())
    };
    hints.show(ui, canvas.rect, &response);
    let pictures = viewport.pictures();
    compare.show(ui, canvas.rect, &pictures);
    for (place, (part, shape)) in places.into_iter().zip(compare.shapes(canvas.rect, &pictures)) {
        ui.painter_at(part).set(place, shape);
    }
    (canvas, result)
}

/// Returns the part of the picture for orientation letters, of which the upper one is centred: below the light chips
/// where these reach the middle.
fn area_below_chips(body: Rect, chips: Option<Rect>) -> Rect {
    /// Half of the width that two letters need at the middle, in points.
    const LETTERS_HALF_WIDTH: f32 = 20.0;
    match chips {
        Some(chips) if chips.right() > body.center().x - LETTERS_HALF_WIDTH => {
            let top = body.top().max(chips.bottom()).min(body.center().y);
            Rect::from_min_max(pos2(body.left(), top), body.max)
        }
        _ => body,
    }
}

impl App {
    /// Shows the picture in the middle of the window.
    pub(crate) fn show_picture(
        &mut self,
        ui: &mut egui::Ui,
        facts: &RendererStatus,
        commands: &mut Vec<AppCommand>,
    ) {
        let outline = self.document.outline(self.viewport.dataset().as_ref());
        let inputs = PictureInputs {
            settings: &mut self.document.settings,
            defaults: &self.document.defaults,
            viewport: &mut self.viewport,
            handles: &mut self.handles,
            cut_handles: &mut self.cut_handles,
            selected_light: &mut self.document.selected_light,
            compare: &mut self.compare,
            overlay: self.overlay,
            probe: &mut self.light_probe,
            orbit: &mut self.orbit,
            turning: &mut self.camera_animation,
            outline: outline.as_deref(),
            export_preview: self.export.requested_image().filter(|_| !self.layout.picture_only),
            export_marks: &mut self.export_marks,
            slices: &mut self.slices,
            hints: &mut self.first_run_hints,
            ct_looks: &mut self.ct_looks,
            volume: self.document.volume.as_ref(),
            facts,
            commands,
        };
        let shown = egui::CentralPanel::no_frame().show(ui, |ui| show(ui, inputs));
        let (canvas, result) = shown.inner;
        self.canvas = Some(canvas);
        // At the top of the whole central area, clear of a dialog beside a smaller picture.
        self.messages.notice(ui.ctx(), shown.response.rect);
        self.messages.list(ui.ctx());
        if let Err(err) = result {
            self.handle_render_error(&err, ui.ctx());
        }
        self.document.update_shown_range(self.viewport.dataset().as_ref());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stand_beside_the_chips_of_lights() {
        let body = Rect::from_min_max(pos2(0.0, 20.0), pos2(300.0, 220.0));
        let chips = |right: f32| Some(Rect::from_min_max(pos2(8.0, 28.0), pos2(right, 52.0)));
        assert_eq!(area_below_chips(body, None), body);
        assert_eq!(area_below_chips(body, chips(120.0)), body, "they end left of the middle");
        let below = area_below_chips(body, chips(160.0));
        assert_eq!((below.top(), below.bottom(), below.x_range()), (52.0, 220.0, body.x_range()));
    }
}
