//! Panels around the picture: menu bar, status bar, transfer function editor, side panel and strip of kept views.

use eframe::egui;

use super::WindowLayout;
use crate::app::common::commands::AppCommand;
use crate::app::common::dock;
use crate::app::common::theme;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::document::Document;
use crate::app::kept_views::KeptStrip;
use crate::app::persistence::RecentThumbnails;
use crate::app::shell::look_editor::LookEditor;
use crate::app::shell::opening::OpeningState;
use crate::app::shell::picture_area::PictureTools;
use crate::app::shell::time_series::TimeSeries;
use crate::app::shell::tool_windows::ToolWindows;
use crate::app::shell::{menu, status};
use crate::app::transfer_editor::TransferEditor;
use crate::app::transfer_editor::plot::PlotMarks;
use crate::app::viewport::RendererStatus;
use crate::app::{panels, text};
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

/// Inputs of the panels: the state that they show and change.
pub(crate) struct OuterPanelInputs<'a> {
    /// Look that the panels edit, and the messages of the status bar.
    pub editor: &'a mut LookEditor,
    /// Files that are being opened.
    pub opening: &'a OpeningState,
    /// Tools over the picture, which the menu switches.
    pub picture: &'a PictureTools,
    /// Tool windows, among them the help that is shown without panels, too.
    pub windows: &'a mut ToolWindows,
    /// Panels and tool windows that are shown.
    pub layout: &'a mut WindowLayout,
    /// Statistics and state of the renderer.
    pub facts: &'a RendererStatus,
    /// Time steps of the open volume.
    pub time_series: &'a mut TimeSeries,
    /// Queue of the commands that the user issues.
    pub commands: &'a mut Vec<AppCommand>,
    /// True while the start screen is in place of the picture, whose panels are then hidden.
    pub shows_start: bool,
}

impl OuterPanels {
    /// Creates the panels of a window that draws with `painter`.
    pub(crate) fn new(painter: WindowPainter, recent_pictures: RecentThumbnails) -> Self {
        Self { editor: TransferEditor::new(painter), kept_strip: KeptStrip::default(), recent_pictures }
    }

    /// Shows the panels around the picture; while only the picture is shown, just the help windows.
    pub(crate) fn show(&mut self, ui: &mut egui::Ui, inputs: &mut OuterPanelInputs<'_>) {
        inputs.editor.document.clamp_selected_layer();
        inputs.layout.observe_theme(ui.ctx());
        inputs.windows.help.ui(ui.ctx(), inputs.facts, inputs.editor.document.settings.camera.up);
        if inputs.layout.picture_only {
            dock::hide(ui.ctx());
            return;
        }
        self.show_menu(ui, inputs);
        show_status(ui, inputs);
        if inputs.shows_start {
            dock::hide(ui.ctx());
            return;
        }
        self.show_transfer_editor(ui, inputs);
        show_side_panel(ui, inputs);
        self.render_missing_thumbnails(ui.ctx(), inputs);
        if inputs.layout.kept && inputs.editor.document.volume.is_some() {
            self.kept_strip.show(ui, &mut inputs.editor.document.settings, inputs.commands);
        }
        inputs.time_series.show_bar(ui);
        dock::reserve_space(ui);
        inputs.layout.observe_tools(ui.ctx(), inputs.windows);
    }

    /// Shows the menu bar, with the name of the open volume.
    fn show_menu(&mut self, ui: &mut egui::Ui, inputs: &mut OuterPanelInputs<'_>) {
        let OuterPanelInputs { editor, opening, picture, layout, commands, .. } = inputs;
        let step = editor.document.history_step();
        let history = &editor.document.history;
        let name_of_step = |is_back: bool| history.describe_next(&step, is_back);
        let shown = menu::WindowParts {
            side: layout.side,
            transfer: layout.transfer,
            strip: layout.kept,
            handles: !picture.handles.is_hidden,
            comparison: editor.viewport.compare.on,
            overlay: picture.overlay.visible,
            probe: picture.light_probe.is_active,
        };
        menu::show(
            ui,
            &mut menu::MenuInputs {
                settings: &mut editor.document.settings,
                title: editor.document.volume.as_ref().map(volume_title),
                describe_step: &name_of_step,
                parts: shown,
                alternatives: editor.document.volume.as_ref().map(|volume| &volume.held),
                recent: editor.memory.recent(),
                recent_pictures: &mut self.recent_pictures,
                keeps_look: opening.requests.keeps_look,
                earlier_runs: editor.memory.earlier_runs(),
                frame_ms: &mut editor.viewport.frame_ms,
                commands,
            },
        );
    }

    /// Shows the editor of the transfer function, or the table of labels, if a volume is open.
    fn show_transfer_editor(&mut self, ui: &mut egui::Ui, inputs: &mut OuterPanelInputs<'_>) {
        let OuterPanelInputs { editor, picture, layout, commands, .. } = inputs;
        let Document { settings, volume, selected_layer, .. } = &mut editor.document;
        let Some(volume) = volume else { return };
        // The label table and the plane of materials have default heights of their own.
        let of_layer = volume.of_layer(*selected_layer);
        let (name, height) = if of_layer.is_shown_by_label(settings) {
            ("labels", theme::LABEL_TABLE_HEIGHT)
        } else if settings.layer_at(of_layer.layer).has_materials() {
            ("materials", theme::LABEL_TABLE_HEIGHT)
        } else {
            ("transfer", theme::EDITOR_HEIGHT)
        };
        let panel = egui::Panel::bottom(name).resizable(true).default_size(height);
        let panel = panel.frame(theme::panel(ui));
        let panel = panel.size_range(90.0..=420.0);
        panel.show_collapsible(ui, &mut layout.transfer, |ui| {
            let value = picture.light_probe.value_in(of_layer.layer).or_else(|| settings.shown_isovalue());
            let marks = PlotMarks { value, hovered: picture.material_picker.hovered() };
            self.editor.ui(ui, settings, (volume, selected_layer), marks, commands);
        });
    }

    /// Renders missing thumbnails of kept items while nothing else is being computed.
    fn render_missing_thumbnails(&mut self, ctx: &egui::Context, inputs: &mut OuterPanelInputs<'_>) {
        self.kept_strip.collect_thumbnails(ctx);
        if !inputs.layout.kept {
            return;
        }
        let editor = &mut *inputs.editor;
        let id = editor.viewport.dataset().map(|dataset| dataset.id().content_id);
        let missing = self.kept_strip.missing_thumbnails(&editor.document.settings, id);
        let Some(wanted) = missing else { return };
        if !inputs.opening.is_opening()
            && editor.is_complete()
            && !inputs.windows.export.is_busy()
            && let Some(subject) = editor.export_subject()
        {
            self.kept_strip.render_thumbnails(wanted, subject, ctx);
        }
    }
}

/// Shows the status bar, with the tasks in progress.
fn show_status(ui: &mut egui::Ui, inputs: &mut OuterPanelInputs<'_>) {
    let OuterPanelInputs { editor, opening, windows, facts, commands, .. } = inputs;
    let file_progress = status::CancellableTasks {
        opening: opening.loader.progress(),
        reading: opening.file_tasks.path(),
        exporting: windows.export.background_progress(),
    };
    let status = status::StatusBar {
        facts,
        busy: file_progress,
        background_task: editor.background_task_name(),
        last_step: editor.document.history.last_step(&editor.document.settings),
    };
    status::show(ui, status, &mut editor.messages, commands);
}

/// Shows the side panel, whose sections edit the settings.
fn show_side_panel(ui: &mut egui::Ui, inputs: &mut OuterPanelInputs<'_>) {
    let OuterPanelInputs { editor, layout, facts, commands, .. } = inputs;
    let panel = egui::Panel::right("side").resizable(true).default_size(theme::SIDE_WIDTH);
    let panel = panel.size_range(theme::SIDE_WIDTHS).frame(theme::panel(ui));
    let treated_as = editor.document.kind_override.kind();
    panel.show_collapsible(ui, &mut layout.side, |ui| {
        panels::show(
            ui,
            &mut panels::PanelContext {
                settings: &mut editor.document.settings,
                first_look: &editor.document.defaults,
                volume: editor.document.volume.as_ref(),
                treated_as,
                selected_light: &mut editor.document.selected_light,
                selected_layer: &mut editor.document.selected_layer,
                compare: &mut editor.viewport.compare,
                facts,
                is_balancing: editor.look_tasks.balance.is_running(),
                commands,
            },
        );
    });
}

/// Returns the title in the menu bar: name, dimensions and spacing of a volume.
fn volume_title(volume: &VolumeFacts) -> menu::VolumeTitle {
    let facts = text::menu::facts(volume.dims, volume.spacing_mm, volume.has_unknown_scale);
    menu::VolumeTitle { name: volume.name.clone(), facts }
}
