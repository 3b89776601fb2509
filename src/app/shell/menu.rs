//! Menu bar with the commands, the name of the open volume and its channels.

use eframe::egui::{self, Button, ThemePreference};

use crate::app::common::aspect::Alternatives;
use crate::app::common::commands::Command;
use crate::app::common::elide::{elide_middle, text_width};
use crate::app::common::{frame, theme};
use crate::app::memory::{EarlierRun, RecentFile, RecentPictures};
use crate::app::text;
use crate::app::windows::recovery;
use crate::data::load::{Aspect, Dimension, Held};
use crate::data::{plain, synthetic};
use crate::model::{MAX_LIGHTS, MAX_NAME, ObjectTurn, Projection, Rig, Settings, StandardView};

/// Maximum number of characters of a path in a tooltip: the longest path that systems allow.
const LONGEST_PATH: usize = 4096;

/// Maximum width of a file name in a menu, in points: menus stay narrower than the smallest window.
const LONGEST_NAME: f32 = 300.0;

/// Longer edge of a recent file's thumbnail, in points: its subject is recognisable, and the list fits on low
/// screens.
const RECENT_EDGE: f32 = 48.0;

/// Inputs of the menu bar: the state that it shows, and the values that it changes.
pub(crate) struct Menu<'a> {
    /// Settings of the current look.
    pub settings: &'a mut Settings,
    /// Name, dimensions and spacing of the open volume, for the right end of the bar.
    pub title: Option<Title>,
    /// Describes the next undo (`true`) or redo (`false`); `None` where there is none.
    pub step: &'a dyn Fn(bool) -> Option<String>,
    /// Visibility of the parts of the window.
    pub shown: Shown,
    /// Series, channels, time steps and components of the open file.
    pub several: Option<&'a Held>,
    /// Recently opened files, the latest first.
    pub recent: &'a [RecentFile],
    /// Thumbnails of the recent files.
    pub recent_pictures: &'a mut RecentPictures,
    /// True if the next volume keeps the current look.
    pub keeps_look: bool,
    /// Looks of earlier runs, the latest first.
    pub earlier: &'a [EarlierRun],
    /// Time budget of a preview frame, in ms; `None` is automatic.
    pub frame_ms: &'a mut Option<f64>,
    /// Queue of the commands that the user issues.
    pub commands: &'a mut Vec<Command>,
}

/// Description of the open volume at the right end of the bar.
#[derive(Debug, Clone)]
pub(crate) struct Title {
    /// Name of the open volume.
    pub name: String,
    /// Dimensions of the volume, and its voxel spacing.
    pub facts: String,
}

impl Title {
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
pub(crate) struct Shown {
    /// Visibility of the side panel.
    pub side: bool,
    /// Visibility of the transfer function editor.
    pub transfer: bool,
    /// Visibility of the strip of saved views and looks.
    pub kept: bool,
    /// Visibility of the light handles.
    pub handles: bool,
    /// True while two looks are compared.
    pub compares: bool,
    /// Visibility of the light chips, bounding box, scale bar and orientation cube.
    pub overlay: bool,
    /// True while the probe explains the sample under the pointer.
    pub probe: bool,
}

/// Shows the menu bar at the top of the window.
pub(crate) fn show(ui: &mut egui::Ui, menu: &mut Menu<'_>) {
    egui::Panel::top("menu").resizable(false).frame(theme::panel(ui)).show(ui, |ui| {
        egui::MenuBar::new().ui(ui, |ui| {
            frame::scrolling_menu(ui, text::menu::FILE, |ui| file(ui, menu));
            frame::scrolling_menu(ui, text::menu::EDIT, |ui| {
                step(ui, menu, Command::Undo, true);
                step(ui, menu, Command::Redo, false);
                item(ui, menu, Command::ToggleHistory, true);
                ui.separator();
                item(ui, menu, Command::ShowPalette, true);
            });
            frame::scrolling_menu(ui, text::menu::VIEW, |ui| view(ui, menu));
            frame::scrolling_menu(ui, text::menu::LIGHT, |ui| light(ui, menu));
            frame::scrolling_menu(ui, text::menu::HELP, |ui| {
                item(ui, menu, Command::ShowHelp, true);
                item(ui, menu, Command::ToggleMessages, true);
                item(ui, menu, Command::ShowAbout, true);
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                several(ui, menu);
                if let Some(title) = &menu.title {
                    title.show(ui);
                }
            });
        });
    });
}

/// Shows the current series, channel, time step or component beside the file name, where it cannot be missed.
fn several(ui: &mut egui::Ui, menu: &mut Menu<'_>) {
    let Some(held) = menu.several else { return };
    for aspect in Aspect::ALL.into_iter().rev() {
        let Some(all) = Alternatives::of(held, aspect) else { continue };
        let at = all.at();
        let named = match aspect {
            Aspect::Component => Some(all.name(at)),
            // Names of series and time steps are long or missing.
            Aspect::Of(Dimension::Channel | Dimension::Array) => all.name_in_file(at).map(str::to_owned),
            Aspect::Of(_) => None,
        };
        let label = text::chooser::beside_title(aspect, at, all.count(), named.as_deref());
        if ui.button(label).on_hover_text(text::chooser::command(aspect)).clicked() {
            menu.commands.push(Command::Choose(aspect));
        }
    }
}

fn item(ui: &mut egui::Ui, menu: &mut Menu<'_>, command: Command, enabled: bool) {
    let button = Button::new(&*command.label()).shortcut_text(command.shortcut_text(ui.ctx()));
    if ui.add_enabled(enabled, button).clicked() {
        menu.commands.push(command);
    }
}

/// Shows the entry of undo or redo, with the change that it affects.
fn step(ui: &mut egui::Ui, menu: &mut Menu<'_>, command: Command, is_back: bool) {
    let what = (menu.step)(is_back);
    let label = text::menu::step(&command.label(), what.as_deref());
    let button = Button::new(label).shortcut_text(command.shortcut_text(ui.ctx()));
    if ui.add_enabled(what.is_some(), button).clicked() {
        menu.commands.push(command);
    }
}

fn file(ui: &mut egui::Ui, menu: &mut Menu<'_>) {
    item(ui, menu, Command::OpenDialog, true);
    item(ui, menu, Command::OpenFolder, true);
    item(ui, menu, Command::OpenPath, true);
    item(ui, menu, Command::NextFile, true);
    item(ui, menu, Command::PreviousFile, true);
    ui.add_enabled_ui(!menu.recent.is_empty(), |ui| {
        frame::scrolling_menu(ui, text::menu::OPEN_RECENT, |ui| {
            for recent in menu.recent {
                let path = &recent.path;
                let whole = path.to_string_lossy();
                let name = path.file_name().map(|name| name.to_string_lossy());
                let name = plain(name.as_ref().unwrap_or(&whole), MAX_NAME);
                let name = elide_middle(ui, &name, &egui::TextStyle::Button, LONGEST_NAME);
                let picture = menu.recent_pictures.get(path, ui.ctx());
                let button = match &picture {
                    Some(picture) => {
                        let size = picture.size_vec2();
                        let size = size * (RECENT_EDGE / size.max_elem());
                        Button::image_and_text((picture.id(), size), &name)
                    }
                    None => Button::new(&name),
                };
                let button = ui.add(button.image_tint_follows_text_color(false));
                button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                if button.on_hover_text(plain(&whole, LONGEST_PATH)).clicked() {
                    menu.commands.push(Command::OpenAgain(path.clone(), recent.choice.clone()));
                }
            }
        });
    });
    item(ui, menu, Command::GoOn, !menu.earlier.is_empty());
    ui.add_enabled_ui(!menu.earlier.is_empty(), |ui| {
        frame::scrolling_menu(ui, text::menu::EARLIER_LOOKS, |ui| {
            for run in menu.earlier {
                let name = elide_middle(ui, &recovery::name(run), &egui::TextStyle::Button, LONGEST_NAME);
                if ui.button(name).on_hover_text(&run.source).clicked() {
                    menu.commands.push(Command::Open(run.look.clone()));
                }
            }
        });
    });
    frame::scrolling_menu(ui, text::commands::OPEN_BUILT_IN, |ui| {
        for name in synthetic::NAMES {
            if ui.button(name).clicked() {
                menu.commands.push(Command::Open(format!("builtin:{name}").into()));
            }
        }
    });
    ui.separator();
    item(ui, menu, Command::SaveSettings, true);
    item(ui, menu, Command::LoadSettings, true);
    ui.separator();
    let mut keeps_look = menu.keeps_look;
    let switch = ui.checkbox(&mut keeps_look, &*Command::KeepLook.label());
    if switch.on_hover_text(text::menu::KEEP_LOOK_TIP).clicked() {
        menu.commands.push(Command::KeepLook);
    }
    ui.separator();
    item(ui, menu, Command::Export, true);
    item(ui, menu, Command::CopyPicture, true);
    ui.separator();
    item(ui, menu, Command::Quit, true);
}

fn view(ui: &mut egui::Ui, menu: &mut Menu<'_>) {
    item(ui, menu, Command::TryLooks, true);
    ui.separator();
    item(ui, menu, Command::ResetView, true);
    item(ui, menu, Command::FrameAll, true);
    item(ui, menu, Command::TurnObject(ObjectTurn::Over), true);
    item(ui, menu, Command::TurnRound, true);
    frame::scrolling_menu(ui, text::menu::LOOK_FROM, |ui| {
        for view in StandardView::ALL {
            let command = Command::LookFrom(view);
            let button = Button::new(view.name(menu.settings.camera.up))
                .shortcut_text(command.shortcut_text(ui.ctx()));
            if ui.add(button).clicked() {
                menu.commands.push(command);
            }
        }
    });
    frame::scrolling_menu(ui, text::menu::KEPT, |ui| {
        item(ui, menu, Command::KeepView, true);
        item(ui, menu, Command::KeepInStrip, true);
        item(ui, menu, Command::ExportKept, !menu.settings.kept.is_empty());
        if !menu.settings.kept.is_empty() {
            ui.separator();
        }
        for (at, kept) in menu.settings.kept.iter().enumerate() {
            let key = kept.digit.map(text::kept::key).unwrap_or_default();
            let name = text::kept::go_to(&kept.name);
            if ui.add(Button::new(name).shortcut_text(key)).clicked() {
                menu.commands.push(Command::GoToKept(at, false));
            }
        }
    });
    item(ui, menu, Command::ToggleFullScreen, true);
    ui.separator();
    item(ui, menu, Command::ShowSlices, true);
    item(ui, menu, Command::FacePlane, true);
    ui.separator();
    let projection = &mut menu.settings.camera.projection;
    ui.radio_value(projection, Projection::Perspective, text::menu::PERSPECTIVE);
    ui.radio_value(projection, Projection::Orthographic, text::menu::ORTHOGRAPHIC);
    ui.separator();
    let cuts = &menu.settings.cuts;
    let switches = [
        (Command::ToggleCrop, cuts.crop.on),
        (Command::TogglePlane, cuts.plane.on),
        (Command::ToggleFloor, menu.settings.floor.on),
        (Command::ToggleSide, menu.shown.side),
        (Command::ToggleTransfer, menu.shown.transfer),
        (Command::ToggleKept, menu.shown.kept),
        (Command::TogglePictureOnly, false),
        (Command::ToggleHandles, menu.shown.handles),
        (Command::ToggleOverlay, menu.shown.overlay),
        (Command::ToggleProbe, menu.shown.probe),
        (Command::ToggleCompare, menu.shown.compares),
    ];
    for (command, mut shown) in switches {
        let label = text::menu::with_key(&command.label(), &command.shortcut_text(ui.ctx()));
        if ui.checkbox(&mut shown, label).clicked() {
            menu.commands.push(command);
        }
    }
    ui.separator();
    frame::scrolling_menu(ui, text::menu::WHILE_MOVING, |ui| {
        for (choice, name) in FRAME_MS {
            ui.radio_value(menu.frame_ms, choice, name);
        }
    });
    ui.separator();
    frame::scrolling_menu(ui, text::menu::SIZE, |ui| {
        for by in [1, -1, 0] {
            item(ui, menu, Command::Scale(by), true);
        }
    });
    frame::scrolling_menu(ui, text::menu::THEME, |ui| {
        let mut theme = ui.ctx().options(|options| options.theme_preference);
        for (choice, name) in [
            (ThemePreference::Dark, text::menu::DARK),
            (ThemePreference::Light, text::menu::BRIGHT),
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

fn light(ui: &mut egui::Ui, menu: &mut Menu<'_>) {
    let room = menu.settings.lights.len() < MAX_LIGHTS;
    item(ui, menu, Command::AddLight, room);
    frame::scrolling_menu(ui, text::menu::USE_RIG, |ui| {
        for rig in Rig::ALL {
            if ui.button(rig.name()).clicked() {
                menu.commands.push(Command::UseRig(rig));
            }
        }
    });
    item(ui, menu, Command::TryLights, true);
    let has_light = !menu.settings.lights.is_empty();
    item(ui, menu, Command::SuggestLight, has_light);
    item(ui, menu, Command::UseSurroundings, true);
    item(ui, menu, Command::NextLight, true);
    item(ui, menu, Command::Solo, true);
    item(ui, menu, Command::Mute, true);
    ui.separator();
    item(ui, menu, Command::Balance, true);
    item(ui, menu, Command::ShowLightVolume, true);
    ui.separator();
    for light in &mut menu.settings.lights {
        ui.checkbox(&mut light.on, &light.name);
    }
}
