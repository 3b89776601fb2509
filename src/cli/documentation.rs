//! Commands `chiaroscuro completions` and `chiaroscuro man-pages`: texts for shells and for `man`, made from the
//! definition of the arguments, so that they list what the program accepts.

use std::path::{Path, PathBuf};

use clap::{Args, Command, CommandFactory as _};
use clap_complete::Shell;
use clap_mangen::Man;

use super::output::{check_overwrites, print_line};
use super::{CliError, CommandLine};
use chiaroscuro_files::{WriteError, make_folder, write_atomically};

/// Section of the manual for programs of users.
const MANUAL_SECTION: &str = "1";

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// Shell that reads the definitions
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Arguments of `man-pages`.
#[derive(Debug, Args)]
pub(super) struct ManPagesArgs {
    #[arg(help = "Folder for the pages, one for each command; created if it does not exist")]
    folder: PathBuf,
    /// Replace pages that exist
    #[arg(long)]
    force: bool,
}

/// Manual page of one command.
struct ManualPage {
    /// Name of its file, such as `chiaroscuro-render.1`.
    file_name: String,
    /// Text for `man`, in the language roff.
    text: Vec<u8>,
}

/// Prints the definitions with which a shell completes arguments of the program.
pub(super) fn print_completions(args: &CompletionsArgs) -> Result<(), CliError> {
    let mut command = CommandLine::command();
    let program = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, program, &mut script);
    print_line(String::from_utf8_lossy(&script).trim_end())
}

/// Writes the manual pages of the program and of its commands, and prints their names.
pub(super) fn write_manual_pages(args: &ManPagesArgs) -> Result<(), CliError> {
    let mut program = CommandLine::command().disable_help_subcommand(true);
    program.build();
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set()).cloned();
    let commands: Vec<Command> = commands.chain([program.clone()]).collect();
    let pages = commands.into_iter().map(|command| manual_page(command, &args.folder));
    let pages = pages.collect::<Result<Vec<_>, CliError>>()?;

    let paths: Vec<PathBuf> = pages.iter().map(|page| args.folder.join(&page.file_name)).collect();
    let outputs: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
    check_overwrites(&[], &outputs, args.force)?;
    make_folder(&args.folder).map_err(WriteError::io_error_for(&args.folder))?;
    for (page, path) in pages.iter().zip(&paths) {
        write_atomically(path, &page.text)?;
        print_line(&path.display().to_string())?;
    }
    Ok(())
}

/// Returns the manual page of a command; an error names the folder for which it was made.
fn manual_page(command: Command, folder: &Path) -> Result<ManualPage, CliError> {
    let program = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));
    let page = Man::new(command).section(MANUAL_SECTION).source(program).manual("Chiaroscuro");
    let mut text = Vec::new();
    page.render(&mut text).map_err(WriteError::io_error_for(folder))?;
    Ok(ManualPage { file_name: page.get_filename(), text })
}
