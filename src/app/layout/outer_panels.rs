//! Panels around the picture: menu bar, status bar, transfer function editor, side panel and strip of kept views.

use eframe::egui;

use crate::app::common::commands::AppCommand;
use crate::app::common::dock;
use crate::app::common::theme;
use crate::app::kept_views::KeptStrip;
use crate::app::persistence::RecentThumbnails;
use crate::app::shell::{menu, status};
use crate::app::transfer_editor::TransferEditor;
use crate::app::viewport::RendererStatus;
use crate::app::{App, panels, text};
use chiaroscuro_render::WindowPainter;

/// State of the panels around the picture.
pub(crate) struct OuterPanels {
    /// Editor of the transfer function.
    pub editor: TransferEditor,
    /// Strip of kept views and looks.
    pub kept_strip: KeptStrip,
    /// Thumbnails of recent files, in the menu.
    pub recent_pictures: RecentThumbnails,
}

impl OuterPanels {
    /// Creates the panels of a window that draws with `painter`.
    pub(crate) fn new(painter: WindowPainter, recent_pictures: RecentThumbnails) -> Self {
        Self { editor: TransferEditor::new(painter), kept_strip: KeptStrip::default(), recent_pictures }
    }
}

impl App {
    /// Shows the panels around the picture; while only the picture is shown, just the help windows.
    pub(crate) fn show_outer_panels(
        &mut self,
        ui: &mut egui::Ui,
        facts: &RendererStatus,
        commands: &mut Vec<AppCommand>,
    ) {
        self.layout.theme = ui.ctx().options(|options| options.theme_preference);
        self.windows.help.ui(ui.ctx(), facts, self.document.settings.camera.up);
        if self.layout.picture_only {
            dock::hide(ui.ctx());
            return;
        }
        let menu_title = self.menu_title();
        let step = self.document.history_step();
        let history = &self.document.history;
        let name_of_step = |is_back: bool| history.describe_next(&step, is_back);
        let shown = menu::WindowParts {
            side: self.layout.side,
            transfer: self.layout.transfer,
            strip: self.layout.kept,
            handles: !self.picture.handles.is_hidden,
            comparison: self.picture.compare.on,
            overlay: self.picture.overlay.visible,
            probe: self.picture.light_probe.is_active,
        };
        menu::show(
            ui,
            &mut menu::MenuInputs {
                settings: &mut self.document.settings,
                title: menu_title,
                describe_step: &name_of_step,
                parts: shown,
                alternatives: self.document.volume.as_ref().map(|volume| &volume.held),
                recent: self.memory.recent(),
                recent_pictures: &mut self.panels.recent_pictures,
                keeps_look: self.opening.requests.keeps_look,
                earlier_runs: self.memory.earlier_runs(),
                frame_ms: &mut self.viewport.frame_ms,
                commands,
            },
        );
        let file_progress = status::CancellableTasks {
            opening: self.loader.progress(),
            reading: self.opening.file_tasks.path(),
            exporting: self.windows.export.background_progress(),
        };
        let undone_step = self.document.history.last_step(&self.document.settings);
        let status = status::StatusBar {
            facts,
            busy: file_progress,
            background_task: self.background_task_name(),
            last_step: undone_step,
        };
        status::show(ui, status, &mut self.messages, commands);
        if let Some(volume) = &self.document.volume {
            // The label table has a default height of its own.
            let (name, height) = if volume.is_shown_by_label(&self.document.settings) {
                ("labels", theme::LABEL_TABLE_HEIGHT)
            } else {
                ("transfer", theme::EDITOR_HEIGHT)
            };
            let panel = egui::Panel::bottom(name).resizable(true).default_size(height);
            let panel = panel.frame(theme::panel(ui));
            let panel = panel.size_range(90.0..=420.0);
            panel.show_collapsible(ui, &mut self.layout.transfer, |ui| {
                self.panels.editor.ui(
                    ui,
                    &mut self.document.settings,
                    volume,
                    self.picture.light_probe.value(),
                    commands,
                );
            });
        }
        let panel = egui::Panel::right("side").resizable(true).default_size(theme::SIDE_WIDTH);
        let panel = panel.size_range(theme::SIDE_WIDTHS).frame(theme::panel(ui));
        let treated_as = self.document.kind_override.kind();
        panel.show_collapsible(ui, &mut self.layout.side, |ui| {
            panels::show(
                ui,
                &mut panels::PanelContext {
                    settings: &mut self.document.settings,
                    first_look: &self.document.defaults,
                    volume: self.document.volume.as_ref(),
                    treated_as,
                    selected_light: &mut self.document.selected_light,
                    compare: &mut self.picture.compare,
                    facts,
                    is_balancing: self.look_tasks.balance.is_running(),
                    commands,
                },
            );
        });
        self.show_kept_strip(ui, commands);
        dock::reserve_space(ui);
        self.layout.docked = dock::docked_titles(ui.ctx());
        (self.layout.slices, self.layout.light_slice) =
            (self.windows.slices.open, self.windows.light_slice.open);
        self.layout.slice_convention = self.windows.slices.convention;
    }

    /// Title in the menu bar: name, dimensions and spacing of the open volume.
    fn menu_title(&self) -> Option<menu::VolumeTitle> {
        let volume = self.document.volume.as_ref()?;
        let facts = text::menu::facts(volume.dims, volume.spacing_mm, volume.has_unknown_scale);
        Some(menu::VolumeTitle { name: volume.name.clone(), facts })
    }

    /// Task beside the pictures that the user waits for, in words; the first that is running.
    fn background_task_name(&self) -> Option<&'static str> {
        [
            (self.document.is_correcting(self.viewport.dataset().as_ref()), text::status::CORRECTING),
            (self.document.is_making_look(), text::status::PREPARING_LOOK),
            (self.look_tasks.light_search.is_running(), text::status::PLACING_LIGHTS),
            (self.look_tasks.balance.is_running(), text::status::BALANCING),
        ]
        .into_iter()
        .find_map(|(is_made, words)| is_made.then_some(words))
    }
}
