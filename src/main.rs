//! The program: the command line, and the window when no command is given.

use std::io::Write as _;
use std::process::ExitCode;

use chiaroscuro::cli::{self, CliError, ViewerRequest};
use chiaroscuro::data::without_controls;

fn main() -> ExitCode {
    let quiet = env_logger::Env::default().default_filter_or("warn,wgpu_hal=error,naga=error,rfd=off");
    // Drivers and files have their words in it.
    env_logger::Builder::from_env(quiet)
        .format(|out, record| {
            let text = without_controls(&record.args().to_string());
            writeln!(out, "{}: {text} ({})", record.level().as_str().to_lowercase(), record.target())
        })
        .init();
    ExitCode::from(cli::main(open_window))
}

#[cfg(feature = "window")]
fn open_window(request: ViewerRequest) -> Result<(), CliError> {
    use chiaroscuro::app::{self, Options};
    use chiaroscuro::gpu::Context;

    let options = Options {
        source: request.source,
        load: request.load,
        session: request.session,
        volume: request.volume,
        trust_paths: request.trust_paths,
        adjust: None,
        storage: app::storage_folder(),
    };
    app::run(options).map_err(|err| match Context::headless() {
        // Without an adapter no window opens, and the window system's own words do not say so.
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
