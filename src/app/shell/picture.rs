//! The middle of the window: the picture, pixel for pixel, and the mouse on it.

use eframe::egui::{self, Rect, Role, Sense, Shape, WidgetInfo, pos2};

use crate::app::App;
use crate::app::common::commands::Command;
use crate::app::common::theme;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use crate::app::viewport::canvas::Canvas;
use crate::app::viewport::compare::Compare;
use crate::app::viewport::cut_handles::CutHandles;
use crate::app::viewport::hints::Hints;
use crate::app::viewport::light_handles::LightHandles;
use crate::app::viewport::light_probe::{LightProbe, Pointing};
use crate::app::viewport::orbit::Orbit;
use crate::app::viewport::overlay::Overlay;
use crate::app::viewport::overlay::ct_looks::CtLooks;
use crate::app::viewport::overlay::export_marks::ExportMarks;
use crate::app::viewport::turning::Turning;
use crate::app::viewport::view_projection::ViewProjection;
use crate::app::viewport::{Facts, Viewport, light_chips, light_probe, nothing_seen, orbit};
use crate::app::windows::slices::Slices;
use crate::gpu::GpuError;
use crate::model::auto::Outline;
use crate::model::{ImageSpec, Settings};

/// What the picture is shown with.
pub(crate) struct PictureInputs<'a> {
    /// The look; camera and lights may be changed by the mouse.
    pub settings: &'a mut Settings,
    /// What the volume was opened with.
    pub defaults: &'a Settings,
    /// The renderer's side.
    pub viewport: &'a mut Viewport,
    /// The handles of the lights.
    pub handles: &'a mut LightHandles,
    /// The handles of the crop box and the clip plane.
    pub cut_handles: &'a mut CutHandles,
    /// The light whose handle is marked.
    pub selected_light: &'a mut usize,
    /// Two looks in one picture.
    pub compare: &'a mut Compare,
    /// Chips of the lights, box, scale bar and cube.
    pub overlay: Overlay,
    /// What is under the pointer.
    pub probe: &'a mut LightProbe,
    /// How the eye goes round.
    pub orbit: &'a mut Orbit,
    /// What is shown on the way from view to view.
    pub turning: &'a mut Turning,
    /// Where the object ends, if that is known.
    pub outline: Option<&'a Outline>,
    /// The picture that would be exported, while somebody is asked.
    pub shot: Option<ImageSpec>,
    /// What would be written over it.
    pub export_marks: &'a mut ExportMarks,
    /// Cuts through the data, and their cursor.
    pub slices: &'a mut Slices,
    /// What the first picture says.
    pub hints: &'a mut Hints,
    /// What is mostly looked for in a CT.
    pub ct_looks: &'a mut CtLooks,
    /// The open volume.
    pub volume: Option<&'a VolumeFacts>,
    /// What is known of the renderer's work.
    pub facts: &'a Facts,
    /// What the user asks for.
    pub commands: &'a mut Vec<Command>,
}

/// Points at the edge of the picture that are the panels' borders.
const BORDER: f32 = 4.0;

/// Shows the picture and everything that is done with the mouse on it.
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
        shot,
        export_marks,
        slices,
        hints,
        ct_looks,
        volume,
        facts,
        commands,
    } = inputs;
    let whole = Canvas::within(ui.available_rect_before_wrap(), ui.pixels_per_point());
    ui.allocate_rect(whole.rect, Sense::hover());
    let canvas = match shot {
        // What is seen is what would be exported.
        Some(ImageSpec { size: [width, height], .. }) => {
            ui.painter().rect_filled(whole.rect, 0.0, ui.visuals().extreme_bg_color);
            whole.of_shape(f64::from(width) / f64::from(height.max(1)), ui.pixels_per_point())
        }
        None => whole,
    };
    // The borders of panels are taken from both of their sides.
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
    orbit::navigate(
        ui,
        &response,
        settings,
        *selected_light,
        !(handles.takes_wheel || cut_handles.takes_wheel),
        // Labels have no window of values.
        viewport.dataset().map(|dataset| dataset.volume().shown_range()).filter(|_| is_by_value),
        (orbit, outline),
    );
    if response.double_clicked()
        && is_one_view
        && let (Some(at), Some(dataset)) = (response.interact_pointer_pos(), viewport.dataset())
        && let Some(found) = light_probe::seen_at(dataset.volume(), settings, canvas.rect, at)
    {
        settings.camera.turn_about(found.point);
    }
    if slices.open
        && is_one_view
        && response.clicked()
        && let (Some(at), Some(dataset)) = (response.interact_pointer_pos(), viewport.dataset())
        && let Some(found) = light_probe::seen_at(dataset.volume(), settings, canvas.rect, at)
    {
        slices.point_at(found.index, dataset.volume().dims());
    }
    // Painted first, filled in when the lights have been moved: no frame of delay.
    let places = [(); 2].map(|()| ui.painter().add(Shape::Noop));
    let moving =
        ui.ctx().animate_bool_with_time(ui.scope_id().with("box"), response.dragged(), theme::FADE_S);
    if is_one_view {
        overlay.outline(ui, canvas.rect, &settings.camera, &scene, moving);
        let view_projection = ViewProjection { camera: settings.camera.clone(), picture: canvas.rect };
        slices.mark(&ui.painter_at(canvas.rect), &view_projection, &scene);
    }
    cut_handles.show(ui, canvas.rect, settings, &scene, handles.hidden || !is_one_view);
    if is_one_view {
        handles.show(ui, canvas.rect, settings, scene.support_radius(), selected_light);
    } else {
        handles.leave();
    }
    // Two looks have words of their own at the top and at the bottom.
    let body = is_anatomical.then(|| compare.beside_words(ui, canvas.rect));
    let chips =
        overlay.on.then(|| light_chips::show(ui, canvas.rect, settings, selected_light, facts, commands));
    if let Some(shot) = &shot {
        // As it would be exported: with the marks of that picture, and none of the window.
        if let Some(dataset) = viewport.dataset().filter(|_| is_one_view) {
            export_marks.show(ui, canvas.rect, shot, settings, dataset.volume());
        }
    } else if is_one_view {
        let body = body.map(|body| beside_chips(body, chips));
        let scale = (&scene, has_unknown_scale);
        if let Some(view) = overlay.show(ui, canvas.rect, &settings.camera, scale, body) {
            commands.push(Command::LookFrom(view));
        }
        // The first hints of all lie there.
        if overlay.on && !hints.on {
            ct_looks.show(ui, canvas.rect, settings, volume, commands);
        }
    }
    if let Some(dataset) = viewport.dataset().filter(|_| probe.on && is_one_view) {
        let pointer = response.hover_pos().filter(|_| !response.dragged());
        let pointing = Pointing { pointer, clicked: response.clicked() && !response.double_clicked() };
        probe.show(ui, canvas.rect, settings, dataset.volume(), pointing);
    }
    if let Some(dataset) = viewport.dataset() {
        nothing_seen::show(ui, canvas.rect, settings, defaults, dataset.volume(), facts);
    }
    settings.sanitise();
    // Until the volume is there that the settings are for, the picture stays.
    let is_correcting =
        viewport.dataset().is_some_and(|dataset| *dataset.volume().corrections() != settings.volume);
    let result = if canvas.size.contains(&0) || is_correcting {
        Ok(())
    } else {
        let now_s = ui.input(|input| input.time);
        let looks = match turning.shown(&settings.camera, now_s) {
            Some(camera) => {
                ui.ctx().request_repaint();
                compare.looks(&Settings { camera, ..settings.clone() })
            }
            None => compare.looks(settings),
        };
        viewport.advance(looks, canvas.size, ui.ctx())
    };
    hints.show(ui, canvas.rect, &response);
    let pictures = viewport.pictures();
    compare.ui(ui, canvas.rect, &pictures);
    for (place, (part, shape)) in places.into_iter().zip(compare.shapes(canvas.rect, &pictures)) {
        ui.painter_at(part).set(place, shape);
    }
    (canvas, result)
}

/// The part of the picture for letters of orientation, of which the upper one stands in the middle: below the chips of the
/// lights where they reach that far.
fn beside_chips(body: Rect, chips: Option<Rect>) -> Rect {
    /// Points to both sides of the middle, for two letters.
    const LETTERS: f32 = 20.0;
    match chips {
        Some(chips) if chips.right() > body.center().x - LETTERS => {
            let top = body.top().max(chips.bottom()).min(body.center().y);
            Rect::from_min_max(pos2(body.left(), top), body.max)
        }
        _ => body,
    }
}

impl App {
    /// The picture.
    pub(in crate::app) fn picture(&mut self, ui: &mut egui::Ui, facts: &Facts, commands: &mut Vec<Command>) {
        let outline = self.outline();
        let inputs = PictureInputs {
            settings: &mut self.settings,
            defaults: &self.defaults,
            viewport: &mut self.viewport,
            handles: &mut self.handles,
            cut_handles: &mut self.cut_handles,
            selected_light: &mut self.selected_light,
            compare: &mut self.compare,
            overlay: self.overlay,
            probe: &mut self.probe,
            orbit: &mut self.orbit,
            turning: &mut self.turning,
            outline: outline.as_deref(),
            shot: self.export.asked().filter(|_| !self.layout.picture_only),
            export_marks: &mut self.export_marks,
            slices: &mut self.slices,
            hints: &mut self.hints,
            ct_looks: &mut self.ct_looks,
            volume: self.volume.as_ref(),
            facts,
            commands,
        };
        let shown = egui::CentralPanel::no_frame().show(ui, |ui| show(ui, inputs));
        let (canvas, result) = shown.inner;
        self.canvas = Some(canvas);
        // At the top of all the room, away from a question that is asked beside a smaller picture.
        self.messages.notice(ui.ctx(), shown.response.rect);
        self.messages.list(ui.ctx());
        if let Err(err) = result {
            self.rendering_failed(&err, ui.ctx());
        }
        self.follow_range();
    }

    /// Editor and panels show the values that the picture does.
    fn follow_range(&mut self) {
        if let (Some(dataset), Some(facts)) = (self.viewport.dataset(), &mut self.volume)
            && dataset.volume().shown() != facts.shown
        {
            facts.follow(&dataset);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stand_beside_the_chips_of_lights() {
        let body = Rect::from_min_max(pos2(0.0, 20.0), pos2(300.0, 220.0));
        let chips = |right: f32| Some(Rect::from_min_max(pos2(8.0, 28.0), pos2(right, 52.0)));
        assert_eq!(beside_chips(body, None), body);
        assert_eq!(beside_chips(body, chips(120.0)), body, "they end left of the middle");
        let below = beside_chips(body, chips(160.0));
        assert_eq!((below.top(), below.bottom(), below.x_range()), (52.0, 220.0, body.x_range()));
    }
}
