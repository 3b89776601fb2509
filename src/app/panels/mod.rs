//! The side panel. Panels see settings and read-only facts, never the renderer.

mod camera;
mod compare;
pub(super) mod controls;
mod cuts;
mod data;
mod floor;
mod lights;
mod sampling;
mod scattering;
mod sections;
mod shading;
mod shadows;
mod sky;

use eframe::egui;

use self::controls::{Header, SceneUnit};
use super::common::commands::Command;
use super::common::volume_facts::VolumeFacts;
use super::text;
use super::text::common::LengthUnit;
use super::viewport::Facts;
use super::viewport::compare::Compare;
use crate::data::KindName;
use crate::model::Settings;

pub(super) use lights::add_light;
pub(super) use shadows::set_linked;

/// What panels work with.
pub(super) struct Panels<'a> {
    /// The look.
    pub settings: &'a mut Settings,
    /// What reset buttons put back.
    pub defaults: &'a Settings,
    /// The open volume.
    pub volume: Option<&'a VolumeFacts>,
    /// The kind of data that it is treated as, if not its own.
    pub treated_as: Option<KindName>,
    /// The light whose handle is marked.
    pub selected_light: &'a mut usize,
    /// Two looks in one picture.
    pub compare: &'a mut Compare,
    /// What is known of the renderer's work.
    pub facts: &'a Facts,
    /// A balance is being measured.
    pub balancing: bool,
    /// What the user asks for.
    pub commands: &'a mut Vec<Command>,
}

impl Panels<'_> {
    /// The unit in which lengths are shown.
    fn scene_unit(&self) -> SceneUnit {
        let per_mm = |unit: LengthUnit, mm: f64| SceneUnit { per_scene: mm / unit.mm, suffix: unit.suffix };
        match self.volume {
            Some(volume) => per_mm(volume.length_unit(), volume.scene.mm_per_unit),
            None => per_mm(LengthUnit::showing(1.0, true), 1.0),
        }
    }
}

/// Shows all sections, in the order in which people work. Whatever they hold, the panel is as wide as it was made.
pub(super) fn show(ui: &mut egui::Ui, panels: &mut Panels<'_>) {
    let room = ui.available_rect_before_wrap();
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(room));
    inside.shrink_clip_rect(room);
    sections::tabs::show(&mut inside, |title| sections::is_active(title, panels.settings, panels.compare.on));
    inside.separator();
    all_sections(&mut inside, panels);
    ui.allocate_rect(room, egui::Sense::hover());
}

fn all_sections(ui: &mut egui::Ui, panels: &mut Panels<'_>) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(2.0);
        section(ui, text::sections::LIGHTS, true, panels, lights::show);
        section(ui, text::sections::SHADOWS, true, panels, shadows::show);
        section(ui, text::sections::SOFT_LIGHT, false, panels, |ui, panels| {
            sky::show(ui, panels);
            ui.separator();
            scattering::show(ui, panels);
        });
        section(ui, text::sections::SHADING, false, panels, shading::show);
        section(ui, text::sections::CUTS, false, panels, cuts::show);
        section(ui, text::sections::FLOOR, false, panels, floor::show);
        section(ui, text::sections::CAMERA, false, panels, camera::show);
        section(ui, text::sections::COMPARE, false, panels, |ui, panels| {
            compare::show(ui, panels.compare, panels.settings, panels.commands);
        });
        section(ui, text::sections::DATA, false, panels, data::show);
    });
}

/// A section with what its header says.
fn section(
    ui: &mut egui::Ui,
    title: &'static str,
    open: bool,
    panels: &mut Panels<'_>,
    show: impl FnOnce(&mut egui::Ui, &mut Panels<'_>),
) {
    let header = Header {
        open,
        is_active: sections::is_active(title, panels.settings, panels.compare.on),
        can_reset: sections::differs(title, panels.settings, panels.defaults),
    };
    if controls::section(ui, title, header, |ui| show(ui, panels)) {
        sections::put_back(title, panels.settings, panels.defaults);
    }
}
