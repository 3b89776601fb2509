//! Start of a window: construction of an empty one, and opening of the volume and look that were named.

use std::path::PathBuf;

use super::carried::Legacy;
use super::error::AppError;
use super::options::Options;
use crate::app::common::give_up::GiveUp;
use crate::app::common::input_pacing::InputPacing;
use crate::app::common::theme;
use crate::app::kept::Strip;
use crate::app::layout::Layout;
use crate::app::memory::Memory;
use crate::app::shell::file_tasks::FileTasks;
use crate::app::shell::first_lights::FirstLights;
use crate::app::shell::history::{History, Listed};
use crate::app::shell::keep_balanced::KeepBalanced;
use crate::app::shell::messages::Messages;
use crate::app::shell::object::corrected::Corrected;
use crate::app::shell::object::framed::Framed;
use crate::app::shell::object::treat_as::Treated;
use crate::app::shell::object::upright::Upright;
use crate::app::shell::session::Session;
use crate::app::shell::status_file::StatusFile;
use crate::app::transfer_editor::TransferEditor;
use crate::app::viewport::Viewport;
use crate::app::viewport::compare::Compare;
use crate::app::viewport::cut_handles::CutHandles;
use crate::app::viewport::hints::Hints;
use crate::app::viewport::light_handles::LightHandles;
use crate::app::viewport::light_probe::LightProbe;
use crate::app::viewport::orbit::Orbit;
use crate::app::viewport::overlay::Overlay;
use crate::app::viewport::overlay::ct_looks::CtLooks;
use crate::app::viewport::overlay::export_marks::ExportMarks;
use crate::app::viewport::turning::Turning;
use crate::app::windows::chooser::Chooser;
use crate::app::windows::contact_sheet::ContactSheet;
use crate::app::windows::export::Export;
use crate::app::windows::files::Files;
use crate::app::windows::foreign_path::ForeignPath;
use crate::app::windows::help::Help;
use crate::app::windows::light_slice::LightSlice;
use crate::app::windows::lost_again::LostAgain;
use crate::app::windows::palette::Palette;
use crate::app::windows::quit::Quit;
use crate::app::windows::raw_dialog::RawDialog;
use crate::app::windows::recovery::Recovery;
use crate::app::windows::roomy::Roomy;
use crate::app::windows::slices::Slices;
use crate::app::worker::loader::Loader;
use crate::app::{App, text};
use crate::data::load::LoadOptions;
use crate::fault::{self, Count, Fault, Place, may_panic};
use crate::gpu::{Context, GpuError, WindowPainter};
use crate::model::{Quality, Settings};

/// Counter of the frames of all windows, for fault injection.
static FRAMES: Count = Count::new();

impl App {
    /// Starts the program in a window, and begins to open the first volume.
    ///
    /// # Errors
    /// When the window's device cannot be used.
    pub fn new(cc: &eframe::CreationContext<'_>, options: Options) -> Result<Self, AppError> {
        Self::begin(cc, options, Legacy::default())
    }

    /// Starts as [`Self::new`] does; the state for a successor window is left in `legacy`.
    pub(in crate::app) fn begin(
        cc: &eframe::CreationContext<'_>,
        options: Options,
        legacy: Legacy,
    ) -> Result<Self, AppError> {
        let Options { source, load, session, volume, trust_paths, adjust, storage } = options;
        let memory = Memory::new(storage.as_deref(), &cc.egui_ctx);
        if memory.is_troubled() {
            return Self::begin_safely(cc, storage, memory, legacy);
        }
        let mut app = Self::build(cc, load, storage, memory, legacy)?;
        app.recovery = Recovery::of(app.memory.earlier(), &cc.egui_ctx);
        app.hints = Hints { on: app.memory.is_first() };
        (app.slices.open, app.light_slice.open) = (app.layout.slices, app.layout.light_slice);
        app.slices.convention = app.layout.slice_convention;
        app.session_is_due = session.is_some();
        app.session = session.map(Session::named);
        app.adjust = adjust;
        app.trusts_paths = trust_paths;
        let is_named = source.is_some() || volume.is_some() || app.session.is_some();
        if is_named || !app.recovery.asks() {
            app.open_first(source.as_deref(), volume.as_deref(), &cc.egui_ctx);
        } else {
            app.first_waits = true;
        }
        Ok(app)
    }

    /// Starts safely after several failed starts: without the file and the session that were named, without the
    /// pipeline cache, and with the least work for the driver.
    fn begin_safely(
        cc: &eframe::CreationContext<'_>,
        storage: Option<PathBuf>,
        mut memory: Memory,
        legacy: Legacy,
    ) -> Result<Self, AppError> {
        memory.add_notice(text::memory::STARTED_SAFELY.to_owned());
        let mut app = Self::build(cc, LoadOptions::default(), None, memory, legacy)?;
        app.storage = storage;
        app.recovery = Recovery::of(app.memory.earlier(), &cc.egui_ctx);
        app.adjust = Some(Box::new(|mut settings| {
            Quality::Fast.apply(&mut settings);
            settings
        }));
        if app.recovery.asks() {
            app.first_waits = true;
        } else {
            app.open_first(None, None, &cc.egui_ctx);
        }
        Ok(app)
    }

    /// Builds an empty window without a volume.
    pub(in crate::app) fn build(
        cc: &eframe::CreationContext<'_>,
        load: LoadOptions,
        storage: Option<PathBuf>,
        memory: Memory,
        legacy: Legacy,
    ) -> Result<Self, AppError> {
        let no_wgpu = || GpuError::Refused(text::messages::NO_DEVICE.to_owned());
        let paint = cc.wgpu_render_state.clone().ok_or_else(no_wgpu)?;
        // The window's own device draws only the window: pictures are rendered on a second device.
        let window = WindowPainter::new(&paint.device, &paint.queue, paint.target_format)?;
        let window_context = Context::new(&paint.adapter, paint.device, paint.queue)?;
        let context = window_context.sibling()?;
        theme::apply(&cc.egui_ctx);
        cc.egui_ctx.add_plugin(InputPacing::default());
        let layout = Layout::kept(cc.storage);
        layout.apply(&cc.egui_ctx);
        Ok(Self {
            settings: Settings::default(),
            defaults: Settings::default(),
            volume: None,
            treated: Treated::default(),
            upright: Upright::default(),
            corrected: Corrected::default(),
            framed: Framed::default(),
            viewport: Viewport::new(context.clone(), window.clone(), &cc.egui_ctx)?,
            canvas: None,
            loader: Loader::new(context, load, storage.as_deref())?,
            recent_pictures: memory.recent_pictures(),
            memory,
            keeps_look: false,
            pending: None,
            balance: None,
            file_tasks: FileTasks::default(),
            keep_balanced: KeepBalanced::new(&Settings::default(), true),
            first_lights: FirstLights::default(),
            light_search: None,
            export: Export::default(),
            files: Files::default(),
            session_is_due: false,
            session: None,
            recovery: Recovery::default(),
            first_waits: false,
            quit: Quit::default(),
            lost_again: LostAgain::default(),
            adjust: None,
            history: History::default(),
            listed: Listed::default(),
            handles: LightHandles::default(),
            cut_handles: CutHandles::default(),
            compare: Compare::default(),
            overlay: Overlay::default(),
            export_marks: ExportMarks::default(),
            orbit: Orbit::default(),
            turning: Turning::default(),
            probe: LightProbe::default(),
            palette: Palette::default(),
            light_slice: LightSlice::default(),
            slices: Slices::default(),
            raw_dialog: RawDialog::default(),
            roomy: Roomy::default(),
            foreign_path: ForeignPath::default(),
            trusts_paths: false,
            contact_sheet: ContactSheet::default(),
            chooser: Chooser::default(),
            give_up: GiveUp::default(),
            neighbour: None,
            editor: TransferEditor::new(window.clone()),
            window,
            window_context,
            storage,
            legacy,
            waiting: None,
            is_ending: false,
            wants_cpu: false,
            selected_light: 0,
            layout,
            strip: Strip::default(),
            help: Help::default(),
            hints: Hints::default(),
            ct_looks: CtLooks::default(),
            messages: Messages::default(),
            longest_ui_ms: 0.0,
            status_file: StatusFile::from_environment(),
        })
    }

    /// Injects the faults that `--fault` asks for.
    pub(in crate::app) fn fail_on_purpose(&self) {
        may_panic(Place::Window);
        std::thread::sleep(fault::frame_delay());
        let frame = FRAMES.next();
        if fault::is_on(Fault::Lost(frame)) {
            self.window_context.lose();
        }
        if fault::is_on(Fault::Lost(frame)) || fault::is_on(Fault::PicturesLost(frame)) {
            self.viewport.context().lose();
        }
    }
}
