//! The program: the command line, and the window when no command is given.

use std::process::ExitCode;

use chiaroscuro::app::{self, Options};
use chiaroscuro::cli::{self, CliError};

fn main() -> ExitCode {
    let quiet = env_logger::Env::default().default_filter_or("warn,wgpu_hal=error,naga=error");
    env_logger::Builder::from_env(quiet).init();
    ExitCode::from(cli::main(|request| {
        let options =
            Options { source: request.source, load: request.load, session: request.session, adjust: None };
        app::run(options).map_err(|err| CliError::Window(err.to_string()))
    }))
}
