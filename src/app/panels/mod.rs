//! Side panel of the main window. Panels see settings and read-only facts, never the renderer.

mod camera;
mod clipping;
mod compare;
pub(super) mod controls;
mod data;
mod floor;
mod lights;
mod render_mode;
mod sampling;
mod scattering;
mod sections;
mod shading;
mod shadows;
mod sky_light;

use eframe::egui;

use self::controls::{SceneUnit, SectionHeader};
use super::common::commands::AppCommand;
use super::common::volume_facts::VolumeFacts;
use super::text;
use super::text::common::LengthUnit;
use super::viewport::RendererStatus;
use super::viewport::compare::Compare;
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::KindName;

pub(super) use lights::add_light;
pub(super) use shadows::set_linked;

/// Context of the panels: the settings that they edit, and facts that they show.
pub(super) struct PanelContext<'a> {
    /// Current settings, edited in place.
    pub settings: &'a mut Settings,
    /// First look, which the reset buttons restore.
    pub first_look: &'a Settings,
    /// Facts about the open volume, if there is one.
    pub volume: Option<&'a VolumeFacts>,
    /// Kind of data that the volume is treated as, if not its own.
    pub treated_as: Option<KindName>,
    /// Index of the light whose handle is marked.
    pub selected_light: &'a mut usize,
    /// Index of the layer whose curve and range are edited.
    pub selected_layer: &'a mut usize,
    /// State of the comparison of two looks.
    pub compare: &'a mut Compare,
    /// Figures about the renderer's work: adapter, costs, memory.
    pub facts: &'a RendererStatus,
    /// True while a balance is being measured.
    pub is_balancing: bool,
    /// Commands that the user has given in this frame.
    pub commands: &'a mut Vec<AppCommand>,
}

impl PanelContext<'_> {
    /// Unit in which lengths are shown: that of the volume, or voxels where its scale is unknown.
    fn scene_unit(&self) -> SceneUnit {
        let per_mm = |unit: LengthUnit, mm: f64| SceneUnit { per_scene: mm / unit.mm, suffix: unit.suffix };
        match self.volume {
            Some(volume) => per_mm(volume.length_unit(), volume.scene.mm_per_unit),
            None => per_mm(LengthUnit::for_length(1.0, true), 1.0),
        }
    }
}

/// Shows all sections, in the usual order of work. The panel keeps its width, whatever its contents need.
pub(super) fn show(ui: &mut egui::Ui, panels: &mut PanelContext<'_>) {
    let room = ui.available_rect_before_wrap();
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(room));
    inside.shrink_clip_rect(room);
    sections::tabs::show(&mut inside, |title| {
        sections::is_section_active(title, panels.settings, panels.compare.on)
    });
    inside.separator();
    all_sections(&mut inside, panels);
    ui.allocate_rect(room, egui::Sense::hover());
}

fn all_sections(ui: &mut egui::Ui, panels: &mut PanelContext<'_>) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(2.0);
        section(ui, text::sections::LIGHTS, true, panels, lights::show);
        section(ui, text::sections::SHADOWS, true, panels, shadows::show);
        section(ui, text::sections::SOFT_LIGHT, false, panels, |ui, panels| {
            sky_light::show(ui, panels);
            ui.separator();
            scattering::show(ui, panels);
        });
        section(ui, text::sections::SHADING, false, panels, shading::show);
        section(ui, text::sections::CUTS, false, panels, clipping::show);
        section(ui, text::sections::FLOOR, false, panels, floor::show);
        section(ui, text::sections::CAMERA, false, panels, camera::show);
        section(ui, text::sections::COMPARE, false, panels, |ui, panels| {
            compare::show(ui, panels.compare, panels.settings, panels.commands);
        });
        section(ui, text::sections::DATA, false, panels, data::show);
    });
}

/// Shows a section and the state of its header, and resets it on request.
fn section(
    ui: &mut egui::Ui,
    title: &'static str,
    open: bool,
    panels: &mut PanelContext<'_>,
    show: impl FnOnce(&mut egui::Ui, &mut PanelContext<'_>),
) {
    let header = SectionHeader {
        open,
        is_active: sections::is_section_active(title, panels.settings, panels.compare.on),
        can_reset: sections::can_reset(title, panels.settings, panels.first_look),
    };
    if controls::section(ui, title, header, |ui| show(ui, panels)) {
        sections::reset_section(title, panels.settings, panels.first_look);
    }
}
