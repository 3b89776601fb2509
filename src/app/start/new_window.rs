//! Start of a window: construction of an empty one, and opening of the volume and look that were named.

use std::path::PathBuf;

use super::error::AppError;
use super::handover::HandoverSlot;
use super::options::WindowOptions;
use crate::app::common::drag_cancel::DragCancel;
use crate::app::common::input_pacing::InputPacing;
use crate::app::common::theme;
use crate::app::kept_views::KeptStrip;
use crate::app::layout::WindowLayout;
use crate::app::persistence::PersistentState;
use crate::app::shell::auto_balance::AutoBalance;
use crate::app::shell::file_tasks::FileTasks;
use crate::app::shell::history::{History, HistoryWindow};
use crate::app::shell::light_placement::LightPlacement;
use crate::app::shell::messages::MessageLog;
use crate::app::shell::object::corrections::CorrectionState;
use crate::app::shell::object::data_kind::KindOverride;
use crate::app::shell::object::orientation::OrientationTasks;
use crate::app::shell::object::outline::OutlineCache;
use crate::app::shell::session::SessionFile;
use crate::app::shell::status_file::StatusFile;
use crate::app::transfer_editor::TransferEditor;
use crate::app::viewport::Viewport;
use crate::app::viewport::camera_transition::CameraTransition;
use crate::app::viewport::compare::Compare;
use crate::app::viewport::cut_handles::CutHandles;
use crate::app::viewport::first_use_hints::FirstUseHints;
use crate::app::viewport::light_handles::LightHandles;
use crate::app::viewport::light_probe::LightProbe;
use crate::app::viewport::mouse_navigation::OrbitDrag;
use crate::app::viewport::overlay::ViewportOverlay;
use crate::app::viewport::overlay::ct_preset_row::CtPresetRow;
use crate::app::viewport::overlay::export_marks_preview::ExportMarksPreview;
use crate::app::windows::contact_sheet::ContactSheetWindow;
use crate::app::windows::device_loss::DeviceLossDialog;
use crate::app::windows::export::ExportWindow;
use crate::app::windows::file_dialogs::FileDialogs;
use crate::app::windows::help::HelpWindows;
use crate::app::windows::large_volume::LargeVolumeDialog;
use crate::app::windows::light_slice::LightSliceWindow;
use crate::app::windows::palette::CommandPalette;
use crate::app::windows::quit_dialog::QuitDialog;
use crate::app::windows::raw_dialog::RawDialog;
use crate::app::windows::recovery::RecoveryDialog;
use crate::app::windows::slices::SlicesWindow;
use crate::app::windows::untrusted_path::UntrustedPathDialog;
use crate::app::windows::volume_chooser::VolumeChooser;
use crate::app::worker::loader::Loader;
use crate::app::{App, text};
use chiaroscuro_files::fault::{self, FaultCounter, FaultThread, InjectedFault, panic_if_injected};
use chiaroscuro_render::{GpuContext, WindowPainter};
use chiaroscuro_scene::{QualityPreset, Settings};
use chiaroscuro_volume_io::LoadOptions;

/// Counter of the frames of all windows, for fault injection.
static FRAMES: FaultCounter = FaultCounter::new();

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
        let WindowOptions { source, load, session, volume, trust_paths, adjust, storage } = options;
        let memory = PersistentState::new(storage.as_deref(), &cc.egui_ctx);
        if memory.needs_safe_start() {
            return Self::start_safely(cc, storage, memory, legacy);
        }
        let mut app = Self::build(cc, load, storage, memory, legacy)?;
        app.recovery_dialog = RecoveryDialog::from_runs(app.memory.earlier_runs(), &cc.egui_ctx);
        app.first_run_hints = FirstUseHints { visible: app.memory.is_first_use() };
        (app.slices.open, app.light_slice.open) = (app.layout.slices, app.layout.light_slice);
        app.slices.convention = app.layout.slice_convention;
        app.session_is_due = session.is_some();
        app.session = session.map(SessionFile::from_command_line);
        app.adjust_first_look = adjust;
        app.trusts_paths = trust_paths;
        let is_named = source.is_some() || volume.is_some() || app.session.is_some();
        if is_named || !app.recovery_dialog.is_open() {
            app.open_first(source.as_deref(), volume.as_deref(), &cc.egui_ctx);
        } else {
            app.default_open_waits = true;
        }
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
        let mut app = Self::build(cc, LoadOptions::default(), None, memory, legacy)?;
        app.storage = storage;
        app.recovery_dialog = RecoveryDialog::from_runs(app.memory.earlier_runs(), &cc.egui_ctx);
        app.adjust_first_look = Some(Box::new(|mut settings| {
            QualityPreset::Fast.apply(&mut settings);
            settings
        }));
        if app.recovery_dialog.is_open() {
            app.default_open_waits = true;
        } else {
            app.open_first(None, None, &cc.egui_ctx);
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
    ) -> Result<Self, AppError> {
        let paint = cc.wgpu_render_state.clone().ok_or(AppError::NoDevice)?;
        // The window's own device draws only the window: pictures are rendered on a second device.
        let window = WindowPainter::new(&paint.device, &paint.queue, paint.target_format)?;
        let window_context = GpuContext::new(&paint.adapter, paint.device, paint.queue)?;
        let context = window_context.second_device()?;
        theme::apply(&cc.egui_ctx);
        cc.egui_ctx.add_plugin(InputPacing::default());
        let layout = WindowLayout::restore(cc.storage);
        layout.apply(&cc.egui_ctx);
        Ok(Self {
            settings: Settings::default(),
            defaults: Settings::default(),
            volume: None,
            kind_override: KindOverride::default(),
            orientation_task: OrientationTasks::default(),
            corrections_task: CorrectionState::default(),
            outline_task: OutlineCache::default(),
            viewport: Viewport::new(context.clone(), window.clone(), &cc.egui_ctx)?,
            canvas: None,
            loader: Loader::new(context, load, storage.as_deref())?,
            recent_pictures: memory.recent_pictures(),
            memory,
            keeps_look_for_next: false,
            pending_look: None,
            balance: None,
            file_tasks: FileTasks::default(),
            keep_balanced: AutoBalance::new(&Settings::default(), true),
            first_lights: LightPlacement::default(),
            light_search: None,
            export: ExportWindow::default(),
            files: FileDialogs::default(),
            session_is_due: false,
            session: None,
            recovery_dialog: RecoveryDialog::default(),
            default_open_waits: false,
            quit_dialog: QuitDialog::default(),
            device_loss_dialog: DeviceLossDialog::default(),
            adjust_first_look: None,
            history: History::default(),
            history_list: HistoryWindow::default(),
            handles: LightHandles::default(),
            cut_handles: CutHandles::default(),
            compare: Compare::default(),
            overlay: ViewportOverlay::default(),
            export_marks: ExportMarksPreview::default(),
            orbit: OrbitDrag::default(),
            camera_animation: CameraTransition::default(),
            light_probe: LightProbe::default(),
            palette: CommandPalette::default(),
            light_slice: LightSliceWindow::default(),
            slices: SlicesWindow::default(),
            raw_dialog: RawDialog::default(),
            large_volume_dialog: LargeVolumeDialog::default(),
            untrusted_path_dialog: UntrustedPathDialog::default(),
            trusts_paths: false,
            contact_sheet: ContactSheetWindow::default(),
            volume_chooser: VolumeChooser::default(),
            drag_cancel: DragCancel::default(),
            next_file_search: None,
            editor: TransferEditor::new(window.clone()),
            window,
            window_context,
            storage,
            handover: legacy,
            handed_over_dataset: None,
            is_device_lost: false,
            wants_cpu: false,
            selected_light: 0,
            layout,
            kept_strip: KeptStrip::default(),
            help: HelpWindows::default(),
            first_run_hints: FirstUseHints::default(),
            ct_looks: CtPresetRow::default(),
            messages: MessageLog::default(),
            longest_ui_ms: 0.0,
            status_file: StatusFile::from_environment(),
        })
    }

    /// Injects the faults that `--fault` asks for.
    pub(crate) fn inject_faults(&self) {
        panic_if_injected(FaultThread::Window);
        std::thread::sleep(fault::frame_delay());
        let frame = FRAMES.next();
        if fault::is_on(InjectedFault::DeviceLost(frame)) {
            self.window_context.destroy_device();
        }
        if fault::is_on(InjectedFault::DeviceLost(frame))
            || fault::is_on(InjectedFault::RendererDeviceLost(frame))
        {
            self.viewport.context().destroy_device();
        }
    }
}
