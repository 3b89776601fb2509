//! Executable `chiaroscuro`: the command line, and the window if no command is given.

use std::io::Write as _;
use std::process::ExitCode;

use chiaroscuro::cli::{self, CliError, ViewerRequest};
use chiaroscuro_files::one_line;

fn main() -> ExitCode {
    set_runtime_dir();
    let quiet = env_logger::Env::default().default_filter_or("warn,wgpu_hal=error,naga=error,rfd=off");
    // Log messages may quote untrusted text of drivers and files.
    env_logger::Builder::from_env(quiet)
        .format(|out, record| {
            let text = one_line(&record.args().to_string());
            let level = record.level().as_str().to_lowercase();
            // Users do not need to know the module that wrote a message.
            match record.target().split("::").next() {
                Some(other) if !other.starts_with(env!("CARGO_PKG_NAME")) => {
                    writeln!(out, "{level}: {text} ({other})")
                }
                _ => writeln!(out, "{level}: {text}"),
            }
        })
        .init();
    ExitCode::from(cli::main(open_window))
}

/// Sets the session's runtime directory if the environment does not, as in containers, on clusters and after `su`.
/// Graphics drivers look for a desktop there whether a window is needed or not, and without the variable they print
/// lines that begin with *error* in successful runs. A directory that does not exist is treated as empty.
#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "the environment is changed before anything else runs")]
fn set_runtime_dir() {
    use std::os::unix::fs::MetadataExt as _;

    const NAME: &str = "XDG_RUNTIME_DIR";
    if std::env::var_os(NAME).is_some_and(|folder| std::path::Path::new(&folder).is_absolute()) {
        return;
    }
    // The owner of a process is its user.
    let Ok(process) = std::fs::metadata("/proc/self") else { return };
    // SAFETY: called first in `main`, while no other thread exists that could read the environment.
    unsafe { std::env::set_var(NAME, format!("/run/user/{}", process.uid())) };
}

#[cfg(not(target_os = "linux"))]
fn set_runtime_dir() {}

/// Check of standard output before Rust's runtime opens /dev/null in place of a closed one (`>&-`), after which
/// output would be lost without an error.
#[cfg(target_os = "linux")]
#[expect(
    unsafe_code,
    reason = "safe code cannot run before the runtime, which hides that the output is closed"
)]
mod before_main {
    extern "C" fn look_at_output() {
        // SAFETY: only queries the flags of a file descriptor, which may be invalid, and changes nothing.
        if unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) } == -1 {
            chiaroscuro::cli::note_closed_output();
        }
    }

    // SAFETY: the loader calls each function of this section once, before `main` and on its thread; this one does not
    // use the runtime.
    #[used]
    #[unsafe(link_section = ".init_array")]
    static CHECK_OUTPUT: extern "C" fn() = look_at_output;
}

#[cfg(feature = "window")]
fn open_window(request: ViewerRequest) -> Result<(), CliError> {
    use chiaroscuro::app::{self, WindowOptions};
    use chiaroscuro_render::GpuContext;

    let options = WindowOptions {
        source: request.source,
        load: request.load,
        session: request.session,
        saves_on_close: request.saves_on_close,
        volume: request.volume,
        is_temporary: request.is_temporary,
        trust_paths: request.trust_paths,
        adjust: None,
        pipelines: None,
        storage: app::storage_folder(),
        light_search_limit_s: None,
    };
    app::run(options).map_err(|err| match GpuContext::headless() {
        // Without an adapter no window opens, and the window system's own message does not say so.
        Err(no_adapter) => {
            app::show_on_desktop(&no_adapter.to_string());
            CliError::Gpu(no_adapter)
        }
        Ok(_) => CliError::Window(err.to_string()),
    })
}

#[cfg(not(feature = "window"))]
fn open_window(_request: ViewerRequest) -> Result<(), CliError> {
    let why = "this program was built without its window (the Cargo feature `window`)";
    Err(CliError::Window(why.to_owned()))
}
