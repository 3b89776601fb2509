//! Central picture of the window, pixel for pixel, with its overlays and mouse input.

mod tools;

use eframe::egui::{self, Rect, Response, Role, Sense, Shape, WidgetInfo, pos2};

pub(crate) use self::tools::PictureTools;
use crate::app::common::commands::AppCommand;
use crate::app::common::theme;
use crate::app::document::Document;
use crate::app::shell::look_editor::LookEditor;
use crate::app::text;
use crate::app::viewport::canvas::Canvas;
use crate::app::viewport::light_probe::{ProbePointer, ProbedVolumes};
use crate::app::viewport::view_projection::ViewProjection;
use crate::app::viewport::{
    RendererStatus, Viewport, empty_picture_notice, light_chips, light_probe, mouse_navigation,
};
use crate::app::windows::slices::SlicesWindow;
use chiaroscuro_render::GpuError;
use chiaroscuro_scene::{ImageSpec, RenderMode, Settings, first_look::ObjectOutline};

/// Inputs of the picture: the state that it shows, and the values that the mouse changes.
struct PictureInputs<'a> {
    /// Look and volume; the mouse may change camera and lights.
    pub document: &'a mut Document,
    /// Render worker with its pictures.
    pub viewport: &'a mut Viewport,
    /// Tools over the picture.
    pub tools: &'a mut PictureTools,
    /// Window of orthogonal slices with its cursor.
    pub slices: &'a mut SlicesWindow,
    /// Outline of the object, if it is known.
    pub outline: Option<&'a ObjectOutline>,
    /// Size and annotations of the picture to export, while the export dialog is open.
    pub export_preview: Option<ImageSpec>,
    /// Statistics and state of the renderer.
    pub facts: &'a RendererStatus,
    /// Queue of the commands that the user issues.
    pub commands: &'a mut Vec<AppCommand>,
}

/// Width of the strip at the picture's edge that belongs to the panel borders, in points.
const BORDER: f32 = 4.0;

/// Shows the picture with its overlays, and handles the mouse on it.
fn show(ui: &mut egui::Ui, mut inputs: PictureInputs<'_>) -> (Canvas, Result<(), GpuError>) {
    let canvas = allocate_canvas(ui, inputs.export_preview.as_ref());
    // The resize handles of panels extend into the picture.
    let inside = canvas.rect.shrink(BORDER);
    let mut response = ui.interact(inside, ui.scope_id().with("picture"), Sense::click_and_drag());
    response.rect = canvas.rect;
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, text::picture::PICTURE));
    if inputs.document.volume.is_none() {
        ui.painter().rect_filled(canvas.rect, 0.0, theme::EMPTY_CANVAS);
        return (canvas, Ok(()));
    }
    inputs.handle_mouse(ui, &response);
    // Placeholder shapes, filled in after the lights have been moved: no frame of delay.
    let places = [(); 2].map(|()| ui.painter().add(Shape::Noop));
    inputs.show_handles(ui, &response);
    inputs.show_overlays(ui, canvas.rect);
    inputs.show_probe_and_notice(ui, &response);
    inputs.document.settings.sanitise();
    let result = inputs.request_picture(ui, canvas);
    inputs.tools.first_run_hints.show(ui, canvas.rect, &response);
    let pictures = inputs.viewport.pictures();
    inputs.viewport.compare.show(ui, canvas.rect, &pictures);
    for (place, (part, shape)) in
        places.into_iter().zip(inputs.viewport.compare.shapes(canvas.rect, &pictures))
    {
        ui.painter_at(part).set(place, shape);
    }
    (canvas, result)
}

/// Allocates the area of the picture, for an export preview in the aspect ratio of the exported picture.
fn allocate_canvas(ui: &mut egui::Ui, export_preview: Option<&ImageSpec>) -> Canvas {
    let whole = Canvas::inscribed(ui.available_rect_before_wrap(), ui.pixels_per_point());
    ui.allocate_rect(whole.rect, Sense::hover());
    match export_preview {
        Some(&ImageSpec { size: [width, height], .. }) => {
            ui.painter().rect_filled(whole.rect, 0.0, ui.visuals().extreme_bg_color);
            whole.with_aspect_ratio(f64::from(width) / f64::from(height.max(1)), ui.pixels_per_point())
        }
        None => whole,
    }
}

impl PictureInputs<'_> {
    /// Returns true if the whole picture shows one view, which the mouse can change.
    fn is_one_view(&self) -> bool {
        !self.viewport.compare.shows_two_views()
    }

    /// Navigates with the mouse; double clicks move the orbit centre, and clicks the cursor of the slices.
    fn handle_mouse(&mut self, ui: &egui::Ui, response: &Response) {
        let is_one_view = self.is_one_view();
        let Self { document, viewport, tools, .. } = self;
        let is_by_value = document.settings.layer().labels.is_empty();
        let dataset = viewport.dataset();
        if is_one_view
            && let Some(dataset) = &dataset
            && (tools.shape_cuts.handle_mouse(ui, response, &mut document.settings, dataset.volume())
                || tools.material_picker.handle_mouse(ui, response, &mut document.settings, dataset.volume()))
        {
            return;
        }
        mouse_navigation::navigate(
            ui,
            response,
            &mut document.settings,
            document.selected_light,
            !(tools.handles.captures_wheel || tools.cut_handles.captures_wheel),
            // Label maps have no window and level.
            dataset.map(|dataset| dataset.volume().shown_range()).filter(|_| is_by_value),
            (&mut tools.orbit, self.outline),
        );
        let settings = &mut document.settings;
        if response.double_clicked()
            && is_one_view
            && let (Some(at), Some(dataset)) = (response.interact_pointer_pos(), viewport.dataset())
            && let Some(found) = light_probe::probe_at(dataset.volume(), settings, response.rect, at)
        {
            settings.camera.set_orbit_centre(found.point);
        }
        if settings.render_mode() == RenderMode::Surface
            && !(tools.light_probe.is_active || self.slices.open)
            && is_one_view
            && response.clicked()
            && let (Some(at), Some(dataset)) = (response.interact_pointer_pos(), viewport.dataset())
            && let Some(value) = light_probe::material_value(dataset.volume(), settings, response.rect, at)
        {
            settings.mode.isovalue = Some(value);
        }
        if self.slices.open
            && is_one_view
            && response.clicked()
            && let (Some(at), Some(dataset)) = (response.interact_pointer_pos(), viewport.dataset())
            && let Some(found) = light_probe::probe_at(dataset.volume(), settings, response.rect, at)
        {
            self.slices.move_cursor_to(found.index, dataset.volume().dims());
        }
    }

    /// Shows the bounding box, the cursor of the slices, and the handles of cuts and lights.
    fn show_handles(&mut self, ui: &egui::Ui, response: &Response) {
        let (is_one_view, area) = (self.is_one_view(), response.rect);
        let Some(scene) = self.document.volume.as_ref().map(|volume| volume.scene) else { return };
        let (settings, tools) = (&mut self.document.settings, &mut *self.tools);
        let moving =
            ui.ctx().animate_bool_with_time(ui.scope_id().with("box"), response.dragged(), theme::FADE_S);
        if is_one_view {
            tools.overlay.show_bounding_box(ui, area, &settings.camera, &scene, moving);
            let view_projection = ViewProjection { camera: settings.camera.clone(), picture: area };
            self.slices.paint_cursor(&ui.painter_at(area), &view_projection, &scene);
        }
        tools.cut_handles.show(ui, area, settings, &scene, tools.handles.is_hidden || !is_one_view);
        // Lights have no effect on colours that are shown as they are.
        if is_one_view && !settings.is_unlit() {
            let selected = &mut self.document.selected_light;
            tools.handles.show(ui, area, settings, scene.support_radius(), selected);
        } else {
            tools.handles.clear_frame_state();
        }
    }

    /// Shows light chips, orientation and scale, and the row of CT presets; or the marks of the export preview.
    fn show_overlays(&mut self, ui: &mut egui::Ui, area: Rect) {
        let is_one_view = self.is_one_view();
        let Document { settings, volume, selected_light, .. } = &mut *self.document;
        let Some(volume) = volume else { return };
        let (tools, commands) = (&mut *self.tools, &mut *self.commands);
        if is_one_view {
            tools.shape_cuts.paint(ui, area, &settings.camera);
            tools.material_picker.paint(ui, area, &settings.camera);
        }
        // A comparison has captions at the top and at the bottom.
        let body = volume.is_anatomical.then(|| self.viewport.compare.area_without_labels(ui, area));
        let chips = tools
            .overlay
            .visible
            .then(|| light_chips::show(ui, area, settings, selected_light, self.facts, commands));
        if let Some(image_spec) = &self.export_preview {
            // Export preview: with the annotations of the exported picture, and without the window's overlays.
            if let Some(dataset) = self.viewport.dataset().filter(|_| is_one_view) {
                tools.export_marks.show(ui, area, image_spec, settings, dataset.volume());
            }
        } else if is_one_view {
            let body = body.map(|body| area_below_chips(body, chips));
            let scale = (&volume.scene, volume.has_unknown_scale);
            if let Some(view) = tools.overlay.show(ui, area, &settings.camera, scale, body) {
                commands.push(AppCommand::LookFrom(view));
            }
            // The hints of the first use are in the same place.
            if tools.overlay.visible && !tools.first_run_hints.visible {
                tools.ct_looks.show(ui, area, settings, volume, commands);
            }
        }
    }

    /// Shows the probe under the pointer, and the notice over an empty picture.
    fn show_probe_and_notice(&mut self, ui: &mut egui::Ui, response: &Response) {
        let is_one_view = self.is_one_view();
        let Document { settings, defaults, volume, .. } = &mut *self.document;
        let (Some(dataset), Some(facts)) = (self.viewport.dataset(), volume.as_ref()) else { return };
        let probe = &mut self.tools.light_probe;
        if probe.is_active && is_one_view {
            let pointer = response.hover_pos().filter(|_| !response.dragged());
            let clicked = response.clicked() && !response.double_clicked();
            let pointing = ProbePointer { pointer, clicked };
            probe.show(ui, response.rect, settings, ProbedVolumes { dataset: &dataset, facts }, pointing);
        }
        empty_picture_notice::show_empty_picture_notice(
            ui,
            response.rect,
            settings,
            defaults,
            dataset.volume(),
            self.facts,
        );
    }

    /// Requests the picture of the look, or of the next moment of a transition between two views.
    fn request_picture(&mut self, ui: &egui::Ui, canvas: Canvas) -> Result<(), GpuError> {
        // The old picture stays until the volume has been corrected as the settings say.
        if canvas.size.contains(&0) || self.document.is_correcting(self.viewport.dataset().as_ref()) {
            return Ok(());
        }
        let settings = &*self.document.shown_settings();
        let now_s = ui.input(|input| input.time);
        let looks = match self.tools.camera_animation.current_view(&settings.camera, now_s) {
            Some(camera) => {
                ui.ctx().request_repaint();
                self.viewport.compare.looks(&Settings { camera, ..settings.clone() })
            }
            None => self.viewport.compare.looks(settings),
        };
        self.viewport.update(looks, canvas.size, ui.ctx())
    }
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

impl PictureTools {
    /// Returns the value of the material under the pointer, if it is over the picture.
    pub(crate) fn value_under_pointer(&self, editor: &LookEditor, ctx: &egui::Context) -> Option<f64> {
        let (picture, at) = (self.canvas.as_ref()?.rect, ctx.pointer_hover_pos()?);
        let dataset = editor.viewport.dataset().filter(|_| picture.contains(at))?;
        light_probe::material_value(dataset.volume(), &editor.document.settings, picture, at)
    }

    /// Shows the picture in the middle of the window, with the messages over it. `slices` is the window that shares
    /// its cursor, and `export_preview` the picture to export, while its dialog is open.
    pub(crate) fn show_picture(
        &mut self,
        ui: &mut egui::Ui,
        editor: &mut LookEditor,
        slices: &mut SlicesWindow,
        export_preview: Option<ImageSpec>,
        facts: &RendererStatus,
        commands: &mut Vec<AppCommand>,
    ) -> Result<(), GpuError> {
        let outline = editor.document.outline(editor.viewport.dataset().as_ref());
        let inputs = PictureInputs {
            document: &mut editor.document,
            viewport: &mut editor.viewport,
            tools: self,
            slices,
            outline: outline.as_deref(),
            export_preview,
            facts,
            commands,
        };
        let shown = egui::CentralPanel::no_frame().show(ui, |ui| show(ui, inputs));
        let (canvas, result) = shown.inner;
        self.canvas = Some(canvas);
        // At the top of the whole central area, clear of a dialog beside a smaller picture.
        editor.messages.notice(ui.ctx(), shown.response.rect);
        editor.messages.list(ui.ctx());
        result
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
