//! Output of commands: protection of files against being overwritten, and printing to the standard streams.

use std::collections::{HashMap, HashSet};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use super::CliError;
use super::process::is_output_closed;
use chiaroscuro_files::{OutputDestination, is_written_by_us, one_line, without_controls};

/// Rejects output names under which a command would replace one of its inputs or another of its outputs, under any
/// alias of the file, or, without `force`, a file that this program has not made. Names that are not regular files
/// fail later, when they are written.
///
/// # Errors
/// Names the file that would be replaced.
pub(super) fn check_overwrites(inputs: &[&Path], outputs: &[&Path], force: bool) -> Result<(), CliError> {
    let inputs: HashMap<_, _> =
        inputs.iter().filter_map(|input| Some((FileIdentity::from_path(input)?, *input))).collect();
    let mut written = HashSet::new();
    for output in outputs {
        let refused = |why: String| Err(CliError::Usage(format!("{} {why}", output.display())));
        if let Some(identity) = FileIdentity::from_path(output) {
            if let Some(input) = inputs.get(&identity) {
                let input = input.display();
                return refused(format!("would replace {input}, which is read; choose another name"));
            }
            if !written.insert(identity) {
                return refused("would be written twice; choose two different names".to_owned());
            }
        }
        if !force && *output != Path::new("-") && output.is_file() && !is_written_by_us(output) {
            let why =
                "exists already, and was not written by this program; choose another name, or use --force";
            return refused(why.to_owned());
        }
    }
    Ok(())
}

/// Identity of a file, equal for all of its names, whether it exists yet or not.
#[derive(Debug, PartialEq, Eq, Hash)]
enum FileIdentity {
    /// Device and inode of an existing file; equal for hard links.
    #[cfg(unix)]
    Inode(u64, u64),
    /// Absolute path, with its folder canonicalised.
    AbsolutePath(PathBuf),
}

impl FileIdentity {
    /// Returns the identity of a file; `None` if its folder does not exist, so that it cannot be written.
    fn from_path(path: &Path) -> Option<Self> {
        #[cfg(unix)]
        if let Ok(found) = std::fs::metadata(path) {
            use std::os::unix::fs::MetadataExt as _;
            return Some(Self::Inode(found.dev(), found.ino()));
        }
        let whole = path.canonicalize().ok().or_else(|| {
            let folder =
                path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            Some(folder.canonicalize().ok()?.join(path.file_name()?))
        })?;
        Some(Self::AbsolutePath(whole))
    }
}

/// Opens a destination: a file with that name, or standard output with the format of an extension.
///
/// # Errors
/// When no temporary file can be created, or standard output is closed.
pub(super) fn open_destination(name: &Path, ending: &str) -> Result<OutputDestination, CliError> {
    let to = OutputDestination::new(name, ending).map_err(CliError::Output)?;
    if to.is_standard_output() {
        check_stdout_open()?;
    }
    Ok(to)
}

/// Checks that standard output can be written to.
///
/// # Errors
/// When it was closed before the program was started.
fn check_stdout_open() -> Result<(), CliError> {
    let closed = || CliError::Output(std::io::Error::other("it is closed"));
    if is_output_closed() { Err(closed()) } else { Ok(()) }
}

/// Copies a finished output to standard output, if that is its destination.
///
/// # Errors
/// When the reader of standard output accepts no more data; a closed pipe is not an error.
pub(super) fn copy_to_stdout(to: OutputDestination) -> Result<(), CliError> {
    match to.copy_to_stdout() {
        Err(err) if err.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(err)),
        _ => Ok(()),
    }
}

/// Completes an output like [`copy_to_stdout`], and prints the name of a written file.
///
/// # Errors
/// Under the conditions of [`copy_to_stdout`].
pub(super) fn finish_output(to: OutputDestination) -> Result<(), CliError> {
    if to.is_standard_output() { copy_to_stdout(to) } else { print_line(&to.path().display().to_string()) }
}

/// Prints a line to standard output; a closed pipe (`| head`) is not an error.
///
/// # Errors
/// When the reader of standard output accepts no more data.
pub(super) fn print_line(text: &str) -> Result<(), CliError> {
    check_stdout_open()?;
    let mut out = std::io::stdout();
    match writeln!(out, "{}", without_controls(text)).and_then(|()| out.flush()) {
        Err(err) if err.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(err)),
        _ => Ok(()),
    }
}

/// Prints a message to standard error, on a single line whatever it contains.
pub(super) fn warn_line(text: &str) {
    // A closed standard error cannot be reported anywhere.
    writeln!(std::io::stderr(), "{}", one_line(text)).ok();
}

/// Prints several lines to standard error: the explanation of invalid arguments.
pub(super) fn warn_lines(text: &str) {
    writeln!(std::io::stderr(), "{}", without_controls(text)).ok();
}

/// Warns that pictures show nothing of a volume, and suggests remedies.
pub(super) fn warn_empty_picture() {
    warn_line(
        "warning: nothing of the volume is visible; --set range=full, another --preset or none, another --look, a larger \
         --size or another view (--set camera...) may help",
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_known_by_all_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("a"), "a").unwrap();
        std::fs::write(path("b"), "a").unwrap();
        std::fs::create_dir(path("sub")).unwrap();
        let is_same_file = |a: &Path, b: &Path| matches!((FileIdentity::from_path(a), FileIdentity::from_path(b)), (Some(a), Some(b)) if a == b);
        assert!(is_same_file(&path("a"), &path("sub/../a")) && !is_same_file(&path("a"), &path("b")));
        assert!(
            is_same_file(&path("new"), &path("sub/../new")) && !is_same_file(&path("new"), &path("newer"))
        );
        assert!(!is_same_file(&path("no/such"), &path("no/such")), "nothing can be written there");
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("a", path("link")).unwrap();
            std::fs::hard_link(path("a"), path("hard")).unwrap();
            assert!(is_same_file(&path("link"), &path("a")) && is_same_file(&path("hard"), &path("link")));
        }
        let (a, b, new) = (path("a"), path("b"), path("new"));
        let is_refused =
            |inputs: &[&Path], outputs: &[&Path], force| check_overwrites(inputs, outputs, force).is_err();
        assert!(!is_refused(&[&a], &[&b, &new], true) && is_refused(&[&a], &[&b, &new], false));
        assert!(is_refused(&[&a, &b], &[&new, &b], true) && is_refused(&[&a], &[&new, &new], true));
    }
}
