//! Section "Camera".

use eframe::egui::Ui;

use super::super::commands::Command;
use super::controls::{Number, advanced, choice};
use super::{Panels, sampling};
use crate::model::Projection;

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (camera, defaults) = (&mut panels.settings.camera, &panels.defaults.camera);
    let projections = [
        (Projection::Perspective, "Perspective", "Near things are larger: natural"),
        (
            Projection::Orthographic,
            "Orthographic",
            "Lengths compare across the picture: for measuring by eye",
        ),
    ];
    choice(ui, "Projection", "How the picture is projected", &mut camera.projection, &projections);
    // Stored as 0 … 360, shown around the middle.
    let mut azimuth_deg = (camera.azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
    let default_deg = (defaults.azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
    let tip = "Around the vertical axis; drag the picture sideways";
    let before_deg = azimuth_deg;
    Number::new("Azimuth", -180.0..=180.0, tip).unit("°").decimals(1).show(ui, &mut azimuth_deg, default_deg);
    if azimuth_deg != before_deg {
        camera.azimuth_deg = azimuth_deg;
    }
    let tip = "Above the horizontal plane; drag the picture up or down";
    Number::new("Elevation", -180.0..=180.0, tip).unit("°").decimals(1).show(
        ui,
        &mut camera.elevation_deg,
        defaults.elevation_deg,
    );
    let tip = "Turns the picture";
    Number::new("Roll", -180.0..=180.0, tip).unit("°").decimals(1).show(
        ui,
        &mut camera.roll_deg,
        defaults.roll_deg,
    );
    let tip = "From the eye to the middle of the view; the volume's longest edge is 2 long. The wheel does the same";
    Number::new("Distance", 0.05..=50.0, tip).log().show(ui, &mut camera.distance, defaults.distance);
    let tip = "Vertical angle of view: wide exaggerates depth";
    Number::new("Field of view", 1.0..=120.0, tip).unit("°").decimals(1).show(
        ui,
        &mut camera.fov_y_deg,
        defaults.fov_y_deg,
    );
    if ui.button("Reset view").on_hover_text("The view with which the volume was opened").clicked() {
        panels.commands.push(Command::ResetView);
    }
    advanced(ui, "advanced camera", |ui| {
        let eye = &mut panels.settings.sampling;
        let default_slab = panels.defaults.sampling.slab;
        sampling::show(ui, &mut eye.kernel, (&mut eye.slab, default_slab), &mut eye.quadrature);
        sampling::show_engine(ui, eye);
    });
}
