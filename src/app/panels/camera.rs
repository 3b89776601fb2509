//! Section "Camera" of the side panel: projection, orientation, view angles, distance and sampling.

use eframe::egui::Ui;

use super::super::text::common::DEGREES;
use super::super::text::{self, ControlText};
use super::controls::{NumberRow, advanced_group, choice_row};
use super::{PanelContext, sampling};
use crate::app::common::commands::AppCommand;
use chiaroscuro_scene::{FovReference, ObjectRotation, Projection, SamplingSettings, SceneAxis};

const PROJECTIONS: [(Projection, ControlText); 2] = [
    (Projection::Perspective, text::camera::PERSPECTIVE),
    (Projection::Orthographic, text::camera::ORTHOGRAPHIC),
];

const FITS: [(FovReference, ControlText); 2] =
    [(FovReference::Frame, text::camera::FRAME), (FovReference::Height, text::camera::HEIGHT)];

/// Shows the section "Camera" of the side panel.
pub(super) fn show(ui: &mut Ui, panels: &mut PanelContext<'_>) {
    let unit = panels.scene_unit();
    let (camera, first) = (&mut panels.settings.camera, &panels.first_look.camera);
    // If the object stands another way up than at first, no angle of the first look applies.
    let of_view = if camera.up == first.up { first.clone() } else { camera.clone() };
    choice_row(ui, text::camera::PROJECTION, &mut camera.projection, &PROJECTIONS);
    // Lights and floor turn with the object.
    let mut up = camera.up;
    if choice_row(ui, text::camera::UP, &mut up, &SceneAxis::ALL.map(|axis| (axis, text::camera::axis(axis))))
    {
        panels.commands.push(AppCommand::TurnObject(ObjectRotation::MakeUpright(up)));
    }
    // Stored as 0° … 360°, shown as −180° … 180°.
    let mut azimuth_deg = (camera.azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
    let default_deg = (of_view.azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
    let before_deg = azimuth_deg;
    let turn = |named| NumberRow::new(named, -180.0..=180.0).unit(DEGREES).decimals(1);
    turn(text::camera::AZIMUTH).show(ui, &mut azimuth_deg, default_deg);
    if azimuth_deg != before_deg {
        camera.azimuth_deg = azimuth_deg;
    }
    turn(text::camera::ELEVATION).show(ui, &mut camera.elevation_deg, of_view.elevation_deg);
    turn(text::camera::ROLL).show(ui, &mut camera.roll_deg, first.roll_deg);
    let distance = NumberRow::new(text::camera::DISTANCE, 0.05..=50.0).logarithmic();
    distance.show_length(ui, &mut camera.distance, of_view.distance, unit);
    let angle = NumberRow::new(text::camera::FIELD_OF_VIEW, 1.0..=120.0).unit(DEGREES).decimals(1);
    angle.show(ui, &mut camera.fov_y_deg, first.fov_y_deg);
    choice_row(ui, text::camera::FIT, &mut camera.fit, &FITS);
    let reset = text::camera::RESET_VIEW;
    if ui.button(reset.name).on_hover_text(reset.tooltip).clicked() {
        panels.commands.push(AppCommand::ResetView);
    }
    advanced_group(ui, "advanced camera", |ui| {
        let eye = &mut panels.settings.sampling;
        let SamplingSettings { kernel, slab, .. } = panels.first_look.sampling;
        let first = sampling::SamplingDefaults { kernel, slab };
        sampling::show_kernel_and_slab(ui, &mut eye.kernel, &mut eye.slab, first, &mut eye.quadrature);
        sampling::show_slabs(ui, &mut eye.slabs);
        sampling::show_engine(ui, eye);
    });
}
