//! The program: the command line, and the window when no command is given.

use std::process::ExitCode;

use chiaroscuro::cli::{self, CliError, ViewerRequest};

fn main() -> ExitCode {
    let quiet = env_logger::Env::default().default_filter_or("warn,wgpu_hal=error,naga=error");
    env_logger::Builder::from_env(quiet).init();
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
        adjust: None,
        storage: app::storage_folder(),
    };
    app::run(options).map_err(|err| match Context::headless() {
        // Without an adapter no window opens, and the window system's own words do not say so.
        Err(no_adapter) => CliError::Gpu(no_adapter),
        Ok(_) => CliError::Window(err.to_string()),
    })
}

#[cfg(not(feature = "window"))]
fn open_window(_request: ViewerRequest) -> Result<(), CliError> {
    let why = "this program was built without its window (the Cargo feature `window`)";
    Err(CliError::Window(why.to_owned()))
}
