//! Menu bar with the commands, the name of the open volume and its channels.

use eframe::egui::{self, Button, ThemePreference};

use super::recent_files::recent_file_button;
use super::start_screen::scenes;
use crate::app::common::alternatives::Alternatives;
use crate::app::common::commands::AppCommand;
use crate::app::common::elide::{elide_middle, text_width};
use crate::app::common::{overlay_windows, theme};
use crate::app::persistence::{EarlierRun, RecentFile, RecentThumbnails};
use crate::app::text;
use crate::app::windows::recovery;
use chiaroscuro_scene::{
    LightingRig, MAX_LIGHTS, ObjectRotation, Projection, RenderMode, Settings, StandardView,
};
use chiaroscuro_volume::{ChoiceAspect, FileContents, FileDimension, synthetic};

/// Maximum width of a file name in a menu, in points: menus stay narrower than the smallest window.
const MAX_NAME_WIDTH: f32 = 300.0;

/// Inputs of the menu bar: the state that it shows, and the values that it changes.
pub(crate) struct MenuInputs<'a> {
    /// Settings of the current look.
    pub settings: &'a mut Settings,
    /// Name, dimensions and spacing of the open volume, for the right end of the bar.
    pub title: Option<VolumeTitle>,
    /// Describes the next undo (`true`) or redo (`false`); `None` where there is none.
    pub describe_step: &'a dyn Fn(bool) -> Option<String>,
    /// Visibility of the parts of the window.
    pub parts: WindowParts,
    /// Series, channels, time steps and components of the open file.
    pub alternatives: Option<&'a FileContents>,
    /// Recently opened files, the latest first.
    pub recent: &'a [RecentFile],
    /// Thumbnails of the recent files.
    pub recent_pictures: &'a mut RecentThumbnails,
    /// True if the next volume keeps the current look.
    pub keeps_look: bool,
    /// Looks of earlier runs, the latest first.
    pub earlier_runs: &'a [EarlierRun],
    /// Time budget of a preview frame, in ms; `None` is automatic.
    pub frame_ms: &'a mut Option<f64>,
    /// Queue of the commands that the user issues.
    pub commands: &'a mut Vec<AppCommand>,
}

/// Description of the open volume at the right end of the bar.
#[derive(Debug, Clone)]
pub(crate) struct VolumeTitle {
    /// Name of the open volume.
    pub name: String,
    /// Dimensions of the volume, and its voxel spacing.
    pub facts: String,
}

impl VolumeTitle {
    /// Shows the title in the space left in the bar: the facts in full, a long name elided in the middle.
    fn show(&self, ui: &mut egui::Ui) {
        let facts = text::menu::title("", &self.facts);
        let room = ui.available_width() - text_width(ui, &facts, &egui::TextStyle::Body);
        let name = elide_middle(ui, &self.name, &egui::TextStyle::Body, room);
        let words = egui::RichText::new(text::menu::title(&name, &self.facts)).weak();
        let label = ui.add(egui::Label::new(words).truncate());
        if name != self.name {
            label.on_hover_text(&self.name);
        }
    }
}

/// Visibility of the parts of the window that can be switched off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WindowParts {
    /// Visibility of the side panel.
    pub side: bool,
    /// Visibility of the transfer function editor.
    pub transfer: bool,
    /// Visibility of the strip of saved views and looks.
    pub strip: bool,
    /// Visibility of the light handles.
    pub handles: bool,
    /// True while two looks are compared.
    pub comparison: bool,
    /// Visibility of the light chips, bounding box, scale bar and orientation cube.
    pub overlay: bool,
    /// True while the probe explains the sample under the pointer.
    pub probe: bool,
}

/// Shows the menu bar at the top of the window.
pub(crate) fn show(ui: &mut egui::Ui, menu: &mut MenuInputs<'_>) {
    egui::Panel::top("menu").resizable(false).frame(theme::panel(ui)).show(ui, |ui| {
        egui::MenuBar::new().ui(ui, |ui| {
            overlay_windows::scrolling_menu(ui, text::menu::FILE, |ui| file(ui, menu));
            overlay_windows::scrolling_menu(ui, text::menu::EDIT, |ui| {
                history_item(ui, menu, AppCommand::Undo, true);
                history_item(ui, menu, AppCommand::Redo, false);
                item(ui, menu, AppCommand::ToggleHistory, true);
                ui.separator();
                item(ui, menu, AppCommand::ShowPalette, true);
            });
            overlay_windows::scrolling_menu(ui, text::menu::VIEW, |ui| view(ui, menu));
            overlay_windows::scrolling_menu(ui, text::menu::LIGHT, |ui| light(ui, menu));
            overlay_windows::scrolling_menu(ui, text::menu::HELP, |ui| {
                item(ui, menu, AppCommand::ShowHelp, true);
                item(ui, menu, AppCommand::ToggleMessages, true);
                item(ui, menu, AppCommand::ShowAbout, true);
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                alternatives(ui, menu);
                if let Some(title) = &menu.title {
                    title.show(ui);
                }
            });
        });
    });
}

/// Shows the current series, channel, time step or component beside the file name, where it cannot be missed.
fn alternatives(ui: &mut egui::Ui, menu: &mut MenuInputs<'_>) {
    let Some(held) = menu.alternatives else { return };
    for aspect in ChoiceAspect::ALL.into_iter().rev() {
        let Some(all) = Alternatives::new(held, aspect) else { continue };
        let at = all.current();
        let named = match aspect {
            ChoiceAspect::Component => Some(all.name(at)),
            // Names of series and time steps are long or missing.
            ChoiceAspect::Dimension(FileDimension::Channel | FileDimension::Array) => {
                all.name_in_file(at).map(str::to_owned)
            }
            ChoiceAspect::Dimension(_) => None,
        };
        let label = text::chooser::title_suffix(aspect, at, all.count(), named.as_deref());
        if ui.button(label).on_hover_text(text::chooser::command(aspect)).clicked() {
            menu.commands.push(AppCommand::ShowChooser(aspect));
        }
    }
}

fn item(ui: &mut egui::Ui, menu: &mut MenuInputs<'_>, command: AppCommand, enabled: bool) {
    let button = Button::new(&*command.label()).shortcut_text(command.shortcut_text(ui.ctx()));
    if ui.add_enabled(enabled, button).clicked() {
        menu.commands.push(command);
    }
}

/// Shows the entry of undo or redo, with the change that it affects.
fn history_item(ui: &mut egui::Ui, menu: &mut MenuInputs<'_>, command: AppCommand, is_back: bool) {
    let what = (menu.describe_step)(is_back);
    let label = text::menu::history_entry(&command.label(), what.as_deref());
    let button = Button::new(label).shortcut_text(command.shortcut_text(ui.ctx()));
    if ui.add_enabled(what.is_some(), button).clicked() {
        menu.commands.push(command);
    }
}

fn file(ui: &mut egui::Ui, menu: &mut MenuInputs<'_>) {
    item(ui, menu, AppCommand::ShowStart, true);
    item(ui, menu, AppCommand::OpenDialog, true);
    item(ui, menu, AppCommand::OpenFolder, true);
    item(ui, menu, AppCommand::OpenPath, true);
    let has_volume = menu.title.is_some();
    item(ui, menu, AppCommand::AddLayer, has_volume);
    item(ui, menu, AppCommand::NextFile, true);
    item(ui, menu, AppCommand::PreviousFile, true);
    ui.add_enabled_ui(!menu.recent.is_empty(), |ui| {
        overlay_windows::scrolling_menu(ui, text::menu::OPEN_RECENT, |ui| {
            for recent in menu.recent {
                let button = recent_file_button(ui, recent, menu.recent_pictures, MAX_NAME_WIDTH);
                if button.clicked() {
                    menu.commands.push(AppCommand::OpenAgain(recent.path.clone(), recent.choice.clone()));
                }
            }
        });
    });
    item(ui, menu, AppCommand::ReopenLast, !menu.earlier_runs.is_empty());
    ui.add_enabled_ui(!menu.earlier_runs.is_empty(), |ui| {
        overlay_windows::scrolling_menu(ui, text::menu::EARLIER_LOOKS, |ui| {
            for run in menu.earlier_runs {
                let name =
                    elide_middle(ui, &recovery::run_name(run), &egui::TextStyle::Button, MAX_NAME_WIDTH);
                if ui.button(name).on_hover_text(&run.source).clicked() {
                    menu.commands.push(AppCommand::Open(run.look.clone()));
                }
            }
        });
    });
    overlay_windows::scrolling_menu(ui, text::commands::OPEN_BUILT_IN, |ui| {
        for name in synthetic::BUILTIN_NAMES {
            if ui.button(name).clicked() {
                let scene = scenes().find(|(_, volume)| *volume == name).map(|(scene, _)| scene);
                let open = || AppCommand::Open(format!("builtin:{name}").into());
                menu.commands.push(scene.map_or_else(open, AppCommand::OpenScene));
            }
        }
    });
    ui.separator();
    item(ui, menu, AppCommand::SaveSettings, true);
    item(ui, menu, AppCommand::LoadSettings, true);
    ui.separator();
    let mut keeps_look = menu.keeps_look;
    let switch = ui.checkbox(&mut keeps_look, &*AppCommand::ToggleKeepLook.label());
    if switch.on_hover_text(text::menu::KEEP_LOOK_TIP).clicked() {
        menu.commands.push(AppCommand::ToggleKeepLook);
    }
    ui.separator();
    item(ui, menu, AppCommand::Export, true);
    item(ui, menu, AppCommand::CopyPicture, true);
    ui.separator();
    item(ui, menu, AppCommand::Quit, true);
}

fn view(ui: &mut egui::Ui, menu: &mut MenuInputs<'_>) {
    item(ui, menu, AppCommand::TryLooks, true);
    ui.separator();
    item(ui, menu, AppCommand::ResetView, true);
    item(ui, menu, AppCommand::FrameAll, true);
    item(ui, menu, AppCommand::TurnObject(ObjectRotation::TipBack), true);
    item(ui, menu, AppCommand::RotateObject, true);
    overlay_windows::scrolling_menu(ui, text::menu::LOOK_FROM, |ui| {
        for view in StandardView::ALL {
            let command = AppCommand::LookFrom(view);
            let button = Button::new(view.name(menu.settings.camera.up))
                .shortcut_text(command.shortcut_text(ui.ctx()));
            if ui.add(button).clicked() {
                menu.commands.push(command);
            }
        }
    });
    overlay_windows::scrolling_menu(ui, text::menu::SAVED_VIEWS, |ui| {
        item(ui, menu, AppCommand::SaveView, true);
        item(ui, menu, AppCommand::SaveLookInStrip, true);
        item(ui, menu, AppCommand::ExportContactSheet, !menu.settings.kept.is_empty());
        if !menu.settings.kept.is_empty() {
            ui.separator();
        }
        for (at, kept) in menu.settings.kept.iter().enumerate() {
            let key = kept.digit.map(text::saved_views::shortcut).unwrap_or_default();
            let name = text::saved_views::thumbnail_name(&kept.name);
            if ui.add(Button::new(name).shortcut_text(key)).clicked() {
                menu.commands.push(AppCommand::GoToSaved(at, false));
            }
        }
    });
    item(ui, menu, AppCommand::ToggleFullScreen, true);
    ui.separator();
    item(ui, menu, AppCommand::ShowSlices, true);
    item(ui, menu, AppCommand::FacePlane, true);
    ui.separator();
    let projection = &mut menu.settings.camera.projection;
    ui.radio_value(projection, Projection::Perspective, text::menu::PERSPECTIVE);
    ui.radio_value(projection, Projection::Orthographic, text::menu::ORTHOGRAPHIC);
    let is_by_value = menu.settings.layer().labels.is_empty();
    let named =
        text::menu::with_key(text::menu::RENDER_MODE, &AppCommand::NextRenderMode.shortcut_text(ui.ctx()));
    ui.add_enabled_ui(is_by_value, |ui| {
        overlay_windows::scrolling_menu(ui, &named, |ui| {
            for mode in RenderMode::ALL {
                let named = text::shading::mode_text(mode);
                ui.radio_value(&mut menu.settings.mode.kind, mode, named.name).on_hover_text(named.tooltip);
            }
        });
    });
    ui.separator();
    let cuts = &menu.settings.cuts;
    let switches = [
        (AppCommand::ToggleCrop, cuts.crop.on),
        (AppCommand::TogglePlane, cuts.plane.on),
        (AppCommand::ToggleFloor, menu.settings.floor.on),
        (AppCommand::ToggleTable, menu.settings.volume.hidden_table.is_some()),
        (AppCommand::ToggleSide, menu.parts.side),
        (AppCommand::ToggleTransfer, menu.parts.transfer),
        (AppCommand::ToggleStrip, menu.parts.strip),
        (AppCommand::TogglePictureOnly, false),
        (AppCommand::ToggleHandles, menu.parts.handles),
        (AppCommand::ToggleOverlay, menu.parts.overlay),
        (AppCommand::ToggleProbe, menu.parts.probe),
        (AppCommand::ToggleCompare, menu.parts.comparison),
    ];
    for (command, mut shown) in switches {
        let label = text::menu::with_key(&command.label(), &command.shortcut_text(ui.ctx()));
        if ui.checkbox(&mut shown, label).clicked() {
            menu.commands.push(command);
        }
    }
    ui.separator();
    overlay_windows::scrolling_menu(ui, text::menu::PREVIEW_BUDGET, |ui| {
        for (choice, name) in FRAME_MS {
            ui.radio_value(menu.frame_ms, choice, name);
        }
    });
    ui.separator();
    overlay_windows::scrolling_menu(ui, text::menu::SIZE, |ui| {
        for by in [1, -1, 0] {
            item(ui, menu, AppCommand::Scale(by), true);
        }
    });
    overlay_windows::scrolling_menu(ui, text::menu::THEME, |ui| {
        let mut theme = ui.ctx().options(|options| options.theme_preference);
        for (choice, name) in [
            (ThemePreference::Dark, text::menu::DARK),
            (ThemePreference::Light, text::menu::LIGHT_THEME),
            (ThemePreference::System, text::menu::AS_SYSTEM),
        ] {
            if ui.radio_value(&mut theme, choice, name).changed() {
                ui.ctx().set_theme(choice);
            }
        }
    });
}

/// Time budgets of a frame, in ms: 60, 30, 15 and 5 frames per second.
const FRAME_MS: [(Option<f64>, &str); 5] = [
    (None, text::menu::AUTOMATIC),
    (Some(16.0), text::menu::SMOOTH),
    (Some(33.0), text::menu::BALANCED),
    (Some(66.0), text::menu::SHARP),
    (Some(200.0), text::menu::SHARPEST),
];

fn light(ui: &mut egui::Ui, menu: &mut MenuInputs<'_>) {
    let room = menu.settings.lights.len() < MAX_LIGHTS;
    item(ui, menu, AppCommand::AddLight, room);
    overlay_windows::scrolling_menu(ui, text::menu::USE_RIG, |ui| {
        for rig in LightingRig::ALL {
            if ui.button(rig.name()).clicked() {
                menu.commands.push(AppCommand::UseRig(rig));
            }
        }
    });
    item(ui, menu, AppCommand::TryLights, true);
    let has_light = !menu.settings.lights.is_empty();
    item(ui, menu, AppCommand::SuggestLight, has_light);
    item(ui, menu, AppCommand::UseEnvironmentMap, true);
    item(ui, menu, AppCommand::NextLight, true);
    item(ui, menu, AppCommand::Solo, true);
    item(ui, menu, AppCommand::Mute, true);
    ui.separator();
    item(ui, menu, AppCommand::Balance, true);
    item(ui, menu, AppCommand::ShowLightVolume, true);
    ui.separator();
    for light in &mut menu.settings.lights {
        ui.checkbox(&mut light.on, &light.name);
    }
}
