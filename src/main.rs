//! The program: the command line, and the window when no command is given.

use std::process::ExitCode;

use chiaroscuro::cli::{self, CliError};

fn main() -> ExitCode {
    env_logger::Builder::from_env(
        env_logger::Env::default().default_filter_or("warn,wgpu_hal=error,naga=error"),
    )
    .init();
    ExitCode::from(cli::main(|_request| Err(CliError::Window("not built yet".to_owned()))))
}
