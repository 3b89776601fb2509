//! Start of a window: construction of an empty one, and opening of the volume and look that were named.

use std::path::PathBuf;

use super::error::AppError;
use super::handover::{HandoverSlot, WindowHandover};
use super::options::WindowOptions;
use super::window_device::WindowDevice;
use crate::app::common::drag_cancel::DragCancel;
use crate::app::common::input_pacing::InputPacing;
use crate::app::common::theme;
use crate::app::document::light_placement::SEARCH_LIMIT_S;
use crate::app::document::session::SessionFile;
use crate::app::layout::WindowLayout;
use crate::app::layout::outer_panels::OuterPanels;
use crate::app::persistence::PersistentState;
use crate::app::shell::look_editor::LookEditor;
use crate::app::shell::opening::OpeningState;
use crate::app::shell::status_file::StatusFile;
use crate::app::shell::tool_windows::AppDialogs;
use crate::app::viewport::Viewport;
use crate::app::viewport::first_use_hints::FirstUseHints;
use crate::app::windows::recovery::RecoveryDialog;
use crate::app::worker::jobs::Jobs;
use crate::app::worker::loader::Loader;
use crate::app::{App, text};
use chiaroscuro_render::{GpuContext, ShaderLibrary, WindowPainter};
use chiaroscuro_scene::QualityPreset;
use chiaroscuro_volume_io::LoadOptions;

impl App {
    /// Starts the program in a window, and begins to open the first volume.
    ///
    /// # Errors
    /// When the window's device cannot be used.
    pub fn new(cc: &eframe::CreationContext<'_>, options: WindowOptions) -> Result<Self, AppError> {
        Self::start(cc, options, HandoverSlot::default())
    }

    /// Starts as [`Self::new`] does; the state for a successor window is left in `legacy`.
    pub(crate) fn start(
        cc: &eframe::CreationContext<'_>,
        options: WindowOptions,
        legacy: HandoverSlot,
    ) -> Result<Self, AppError> {
        let WindowOptions {
            source,
            load,
            session,
            saves_on_close,
            volume,
            is_temporary,
            trust_paths,
            adjust,
            light_search_limit_s,
            pipelines,
            storage,
        } = options;
        let memory = PersistentState::new(storage.as_deref(), &cc.egui_ctx);
        if memory.needs_safe_start() {
            return Self::start_safely(cc, storage, memory, legacy);
        }
        let mut app = Self::build(cc, load, storage, memory, legacy, pipelines)?;
        app.dialogs.recovery = RecoveryDialog::from_runs(app.editor.memory.earlier_runs(), &cc.egui_ctx);
        app.picture.first_run_hints = FirstUseHints { visible: app.editor.memory.is_first_use() };
        (app.windows.slices.open, app.windows.light_slice.open) = (app.layout.slices, app.layout.light_slice);
        app.windows.slices.convention = app.layout.slice_convention;
        app.opening.requests.session_is_due = session.is_some();
        app.editor.document.session =
            session.map(|path| SessionFile::from_command_line(path, saves_on_close));
        app.opening.adjust_first_look = adjust;
        app.editor.light_search_limit_s = light_search_limit_s.unwrap_or(SEARCH_LIMIT_S);
        app.opening.requests.trusts_paths = trust_paths;
        if let Some(source) = source.as_deref().filter(|_| is_temporary) {
            app.editor.memory.set_temporary_file(source);
        }
        app.opener(&cc.egui_ctx).open_first(source.as_deref(), volume.as_deref());
        Ok(app)
    }

    /// Starts safely after several failed starts: without the file and the session that were named, without the
    /// pipeline cache, and with the least work for the driver.
    fn start_safely(
        cc: &eframe::CreationContext<'_>,
        storage: Option<PathBuf>,
        mut memory: PersistentState,
        legacy: HandoverSlot,
    ) -> Result<Self, AppError> {
        memory.add_notice(text::persistence::SAFE_START.to_owned());
        let mut app = Self::build(cc, LoadOptions::default(), None, memory, legacy, None)?;
        app.device.storage = storage;
        app.dialogs.recovery = RecoveryDialog::from_runs(app.editor.memory.earlier_runs(), &cc.egui_ctx);
        app.opening.adjust_first_look = Some(Box::new(|mut settings| {
            QualityPreset::Fast.apply(&mut settings);
            settings
        }));
        Ok(app)
    }

    /// Starts a successor window with the state of a window whose device was lost. After losses in short succession
    /// (`asks`) the user is asked first.
    pub(crate) fn resume(
        cc: &eframe::CreationContext<'_>,
        carried: WindowHandover,
        legacy: HandoverSlot,
        asks: bool,
    ) -> Result<Self, AppError> {
        carried.jobs.hand_to(&cc.egui_ctx);
        let mut app = Self::build(cc, carried.load, carried.storage, carried.memory, legacy, None)?;
        app.editor.document = carried.document.restarted();
        app.opening.requests = carried.requests;
        app.device.handed_over_dataset = carried.dataset;
        carried.layout.apply(&cc.egui_ctx);
        (app.editor.messages, app.layout) = (carried.messages, carried.layout);
        (app.editor.viewport.compare, app.picture.light_probe.is_active) =
            (carried.compare, carried.probe_on);
        app.windows.export = carried.export;
        if asks {
            app.dialogs.device_loss.open();
        } else {
            app.editor.messages.note(text::messages::DEVICE_REPLACED);
            let dataset = app.device.handed_over_dataset.take();
            app.opener(&cc.egui_ctx).restore(dataset);
        }
        if let Some((source, reading)) = carried.opening {
            app.opener(&cc.egui_ctx).start_loading(&source, reading);
        } else if app.editor.document.volume.is_none() {
            app.opener(&cc.egui_ctx).open_first(None, None);
        }
        Ok(app)
    }

    /// Builds an empty window without a volume.
    pub(crate) fn build(
        cc: &eframe::CreationContext<'_>,
        load: LoadOptions,
        storage: Option<PathBuf>,
        memory: PersistentState,
        legacy: HandoverSlot,
        pipelines: Option<ShaderLibrary>,
    ) -> Result<Self, AppError> {
        let paint = cc.wgpu_render_state.clone().ok_or(AppError::NoDevice)?;
        // The window's own device draws only the window: pictures are rendered on a second device.
        let painter = WindowPainter::new(&paint.device, &paint.queue, paint.target_format)?;
        let window_context = GpuContext::new(&paint.adapter, paint.device, paint.queue)?;
        let loader = match pipelines {
            Some(pipelines) => Loader::with_pipelines(pipelines, load),
            None => Loader::new(window_context.second_device()?, load, storage.as_deref(), &cc.egui_ctx)?,
        };
        let context = loader.shaders().context();
        theme::apply(&cc.egui_ctx);
        cc.egui_ctx.add_plugin(InputPacing::default());
        let layout = WindowLayout::restore(cc.storage);
        layout.apply(&cc.egui_ctx);
        let viewport = Viewport::new(context.clone(), painter.clone(), &cc.egui_ctx)?;
        Ok(Self {
            opening: OpeningState::new(loader),
            picture: Box::default(),
            windows: Box::default(),
            dialogs: AppDialogs::default(),
            jobs: Jobs::from_context(&cc.egui_ctx),
            panels: OuterPanels::new(painter.clone(), memory.recent_pictures()),
            editor: Box::new(LookEditor::new(viewport, memory)),
            layout,
            drag_cancel: DragCancel::default(),
            device: WindowDevice::new(painter, window_context, storage, legacy),
            status_file: StatusFile::from_environment(),
            start_screen: Box::default(),
            time_series: Box::default(),
        })
    }
}
