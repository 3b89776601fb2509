//! Section "Floor": the floor on which shadows fall.

use eframe::egui::Ui;

use super::Panels;
use super::controls::{Number, color, row, switch};

/// Shows the section.
pub(super) fn show(ui: &mut Ui, panels: &mut Panels<'_>) {
    let (ground, defaults) = (&mut panels.settings.ground, &panels.defaults.ground);
    let tip = "A floor under the volume that shows its shadows; seen from above";
    switch(ui, "Floor under the volume", tip, &mut ground.on);
    let mm = panels.volume.map_or(1.0, |volume| volume.scene.mm_per_unit);
    ui.add_enabled_ui(ground.on, |ui| {
        let tip = "Above the middle of the volume; at first under what was shown when it was opened";
        let (mut height_mm, reach) =
            (ground.height * mm, panels.volume.map_or(1.0, |v| v.scene.support_radius()));
        let before_mm = height_mm;
        Number::new("Height", -reach * mm..=reach * mm, tip).unit(" mm").decimals(1).show(
            ui,
            &mut height_mm,
            defaults.height * mm,
        );
        if height_mm != before_mm {
            ground.height = height_mm / mm;
        }
        let tip = "Where the floor has faded out, from the middle; the volume's longest edge is 2 long";
        Number::new("Radius", 0.5..=20.0, tip).log().show(ui, &mut ground.radius, defaults.radius);
        let tip = "How much of the background the floor covers";
        Number::new("Floor opacity", 0.0..=1.0, tip).show(ui, &mut ground.opacity, defaults.opacity);
        row(ui, "Floor colour", "Its own colour, in white light", |ui| {
            ui.add_enabled_ui(!ground.shadow_only, |ui| color(ui, "Floor colour", &mut ground.color));
        });
        let tip = "Only what darkens the floor is seen: for light backgrounds and transparent pictures";
        switch(ui, "Shadow alone", tip, &mut ground.shadow_only);
    });
}
