//! Command line: arguments become the same [`Settings`](chiaroscuro_scene::Settings) and go to the same renderer as
//! in the window.

mod animation;
mod bench;
mod compare;
mod convert;
mod documentation;
mod error;
mod image_args;
mod info;
mod light_volume;
mod output;
mod process;
mod render;
mod replay;
mod scene;

use std::path::{Path, PathBuf};

use clap::{Parser, Subcommand};

#[cfg(feature = "faults")]
use chiaroscuro_files::fault::{self, InjectedFault};
use chiaroscuro_media::may_carry_record;
pub use error::CliError;
use output::{print_line, warn_line, warn_lines};
pub use process::note_closed_output;
use scene::LoadArgs;

/// See the shape of volume data, with true volumetric shadows.
#[derive(Debug, Parser)]
#[command(name = "chiaroscuro", version, args_conflicts_with_subcommands = true)]
struct CommandLine {
    #[command(subcommand)]
    command: Option<CliCommand>,
    #[arg(help = "Volume, session or exported picture to open: a file, or builtin:NAME[:N]")]
    file: Option<PathBuf>,
    /// Session to continue; Ctrl+S saves to it
    #[arg(long, value_name = "FILE")]
    session: Option<PathBuf>,
    /// Write the session when the window is closed
    #[arg(long, requires = "session")]
    save_on_close: bool,
    /// Volume of the session or picture (FILE or --session), if it is not at the recorded path
    #[arg(long, value_name = "FILE")]
    volume: Option<PathBuf>,
    /// FILE is deleted when the window is closed: do not list it among the recent files
    #[arg(long, requires = "file")]
    temporary: bool,
    /// Open volumes at the paths recorded in sessions and pictures, without asking
    #[arg(long)]
    trust_paths: bool,
    #[command(flatten)]
    load: LoadArgs,
    /// Inject a fault, for tests of error handling; may be repeated
    #[cfg(feature = "faults")]
    #[arg(long, value_name = "FAULT", global = true, hide = true)]
    fault: Vec<InjectedFault>,
}

impl CommandLine {
    /// Returns the request with which the window is opened.
    fn viewer_request(self) -> Result<ViewerRequest, CliError> {
        let Self {
            command: _,
            file,
            session,
            save_on_close,
            volume,
            temporary,
            trust_paths,
            load,
            #[cfg(feature = "faults")]
                fault: _,
        } = self;
        if let (Some(file), Some(volume)) = (&file, &volume)
            && !is_look(file)
        {
            return Err(CliError::Usage(format!(
                "--volume: {} is a volume itself, so {} cannot be shown; use --volume with a session or a picture",
                file.display(),
                volume.display()
            )));
        }
        Ok(ViewerRequest {
            source: file,
            load: load.load_options()?,
            session,
            saves_on_close: save_on_close,
            volume,
            is_temporary: temporary,
            trust_paths,
        })
    }
}

/// Returns true if a file's name indicates a look (session or picture) and not a volume.
fn is_look(path: &Path) -> bool {
    may_carry_record(path) || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Render a picture to a PNG or EXR file
    Render(render::RenderArgs),
    /// Render an animation of one turn of the camera or of a light
    Turntable(animation::TurntableArgs),
    /// Render an animation of the time steps of a volume
    TimeSeries(animation::TimeSeriesArgs),
    /// Render an exported picture again from its embedded settings, and compare the two
    Replay(replay::ReplayArgs),
    /// Render several looks side by side, and print the distance of each from the first
    Compare(compare::CompareArgs),
    /// Write a light's attenuation volume as NRRD, or a slice of it as PNG
    LightVolume(light_volume::LightVolumeArgs),
    /// Convert a volume, or a part of it, to another file format
    Convert(convert::ConvertArgs),
    /// Print a volume's size, values, kind of data and metadata
    Info(info::InfoArgs),
    /// Measure the times of rendering, light volumes and loading
    Bench(bench::BenchArgs),
    /// Print the definitions with which a shell completes arguments
    Completions(documentation::CompletionsArgs),
    /// Write the manual pages of all commands
    ManPages(documentation::ManPagesArgs),
}

/// Request with which the window is opened.
#[derive(Debug, Clone)]
pub struct ViewerRequest {
    /// Path of a file, or name of a built-in volume.
    pub source: Option<PathBuf>,
    /// Options for reading the volume.
    pub load: chiaroscuro_volume_io::LoadOptions,
    /// Session to continue, from `--session`.
    pub session: Option<PathBuf>,
    /// True if the session is written when the window is closed, from `--save-on-close`.
    pub saves_on_close: bool,
    /// Volume of a look, from `--volume`.
    pub volume: Option<PathBuf>,
    /// True if `source` is not listed among the recent files, from `--temporary`.
    pub is_temporary: bool,
    /// True if recorded paths of volumes are trusted, from `--trust-paths`.
    pub trust_paths: bool,
}

/// Actions on termination signals: the window's look is saved.
#[cfg(feature = "window")]
const TERMINATION_ACTIONS: &[fn()] = &[crate::app::save_before_termination];
#[cfg(not(feature = "window"))]
const TERMINATION_ACTIONS: &[fn()] = &[];

/// Runs the command line; `open_window` runs the viewer. Returns the exit code.
pub fn main(open_window: impl FnOnce(ViewerRequest) -> Result<(), CliError>) -> u8 {
    let args = match CommandLine::try_parse() {
        Ok(args) => args,
        Err(err) => {
            let text = err.render().to_string();
            if err.use_stderr() {
                warn_lines(text.trim_end());
                return 2;
            }
            // Help and version are not errors.
            return exit_code(print_line(text.trim_end()));
        }
    };
    #[cfg(feature = "faults")]
    fault::set_faults(args.fault.clone());
    process::listen_for_signals(TERMINATION_ACTIONS);
    let result = process::start_thread_pool().and_then(|()| match args.command {
        Some(CliCommand::Render(args)) => render::run(&args),
        Some(CliCommand::Turntable(args)) => animation::run_turntable(&args),
        Some(CliCommand::TimeSeries(args)) => animation::run_time_series(&args),
        Some(CliCommand::Replay(args)) => replay::run(&args),
        Some(CliCommand::Compare(args)) => compare::run(&args),
        Some(CliCommand::LightVolume(args)) => light_volume::run(&args),
        Some(CliCommand::Convert(args)) => convert::run(&args),
        Some(CliCommand::Info(args)) => info::run(&args),
        Some(CliCommand::Bench(args)) => bench::run(&args),
        Some(CliCommand::Completions(args)) => documentation::print_completions(&args),
        Some(CliCommand::ManPages(args)) => documentation::write_manual_pages(&args),
        None => args.viewer_request().and_then(open_window),
    });
    exit_code(result)
}

/// Returns the exit code of a finished command, and prints its error message.
fn exit_code(result: Result<(), CliError>) -> u8 {
    match result {
        Ok(()) => 0,
        Err(err) => {
            warn_line(&format!("error: {err}"));
            err.exit_code()
        }
    }
}
