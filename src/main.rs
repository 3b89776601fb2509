//! The program: the command line, and the window when no command is given.

use std::process::ExitCode;

use chiaroscuro::app::{self, Options};
use chiaroscuro::cli::{self, CliError};
use chiaroscuro::gpu::Context;

fn main() -> ExitCode {
    let quiet = env_logger::Env::default().default_filter_or("warn,wgpu_hal=error,naga=error");
    env_logger::Builder::from_env(quiet).init();
    ExitCode::from(cli::main(|request| {
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
    }))
}
