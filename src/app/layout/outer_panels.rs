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
        self.windows.help.ui(ui.ctx(), facts, self.editor.document.settings.camera.up);
        if self.layout.picture_only {
            dock::hide(ui.ctx());
            return;
        }
        let menu_title = self.menu_title();
        let step = self.editor.document.history_step();
        let history = &self.editor.document.history;
        let name_of_step = |is_back: bool| history.describe_next(&step, is_back);
        let shown = menu::WindowParts {
            side: self.layout.side,
            transfer: self.layout.transfer,
            strip: self.layout.kept,
            handles: !self.picture.handles.is_hidden,
            comparison: self.editor.viewport.compare.on,
            overlay: self.picture.overlay.visible,
            probe: self.picture.light_probe.is_active,
        };
        menu::show(
            ui,
            &mut menu::MenuInputs {
                settings: &mut self.editor.document.settings,
                title: menu_title,
                describe_step: &name_of_step,
                parts: shown,
                alternatives: self.editor.document.volume.as_ref().map(|volume| &volume.held),
                recent: self.editor.memory.recent(),
                recent_pictures: &mut self.panels.recent_pictures,
                keeps_look: self.opening.requests.keeps_look,
                earlier_runs: self.editor.memory.earlier_runs(),
                frame_ms: &mut self.editor.viewport.frame_ms,
                commands,
            },
        );
        let file_progress = status::CancellableTasks {
            opening: self.opening.loader.progress(),
            reading: self.opening.file_tasks.path(),
            exporting: self.windows.export.background_progress(),
        };
        let undone_step = self.editor.document.history.last_step(&self.editor.document.settings);
        let status = status::StatusBar {
            facts,
            busy: file_progress,
            background_task: self.editor.background_task_name(),
            last_step: undone_step,
        };
        status::show(ui, status, &mut self.editor.messages, commands);
        if let Some(volume) = &self.editor.document.volume {
            // The label table has a default height of its own.
            let (name, height) = if volume.is_shown_by_label(&self.editor.document.settings) {
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
                    &mut self.editor.document.settings,
                    volume,
                    self.picture.light_probe.value(),
                    commands,
                );
            });
        }
        let panel = egui::Panel::right("side").resizable(true).default_size(theme::SIDE_WIDTH);
        let panel = panel.size_range(theme::SIDE_WIDTHS).frame(theme::panel(ui));
        let treated_as = self.editor.document.kind_override.kind();
        panel.show_collapsible(ui, &mut self.layout.side, |ui| {
            panels::show(
                ui,
                &mut panels::PanelContext {
                    settings: &mut self.editor.document.settings,
                    first_look: &self.editor.document.defaults,
                    volume: self.editor.document.volume.as_ref(),
                    treated_as,
                    selected_light: &mut self.editor.document.selected_light,
                    compare: &mut self.editor.viewport.compare,
                    facts,
                    is_balancing: self.editor.look_tasks.balance.is_some(),
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
        let volume = self.editor.document.volume.as_ref()?;
        let facts = text::menu::facts(volume.dims, volume.spacing_mm, volume.has_unknown_scale);
        Some(menu::VolumeTitle { name: volume.name.clone(), facts })
    }

    /// Shows the strip of kept items, if it is visible and a volume is open.
    fn show_kept_strip(&mut self, ui: &mut egui::Ui, commands: &mut Vec<AppCommand>) {
        self.render_missing_thumbnails(ui.ctx());
        if self.layout.kept && self.editor.document.volume.is_some() {
            self.panels.kept_strip.show(ui, &mut self.editor.document.settings, commands);
        }
    }

    /// Renders missing thumbnails of kept items while nothing else is being computed.
    fn render_missing_thumbnails(&mut self, ctx: &egui::Context) {
        self.panels.kept_strip.collect_thumbnails(ctx);
        if !self.layout.kept {
            return;
        }
        let id = self.editor.viewport.dataset().map(|dataset| dataset.volume().content_id());
        let settings = &self.editor.document.settings;
        let Some(wanted) = self.panels.kept_strip.missing_thumbnails(settings, id) else { return };
        if !self.opening.is_opening()
            && self.editor.is_complete()
            && !self.windows.export.is_busy()
            && let Some(subject) = self.editor.export_subject()
        {
            self.panels.kept_strip.render_thumbnails(wanted, subject, ctx);
        }
    }
}
