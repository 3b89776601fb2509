//! What commands write: never in place of what they read, nor of one another; and what they print.

use std::collections::{HashMap, HashSet};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use super::CliError;
use super::process::is_output_closed;
use crate::data::{one_line, without_controls};
use crate::export::{Destination, is_ours};

/// Refuses names under which a command would replace what it reads, or what else it writes, whatever they are called,
/// or, unless that is wanted (`force`), files that this program has not made. What is no file is refused when it is
/// written.
///
/// # Errors
/// Which file it is.
pub(super) fn keep_apart(inputs: &[&Path], outputs: &[&Path], force: bool) -> Result<(), CliError> {
    let inputs: HashMap<_, _> =
        inputs.iter().filter_map(|input| Some((Identity::of(input)?, *input))).collect();
    let mut written = HashSet::new();
    for output in outputs {
        let refused = |why: String| Err(CliError::Usage(format!("{} {why}", output.display())));
        if let Some(identity) = Identity::of(output) {
            if let Some(input) = inputs.get(&identity) {
                let input = input.display();
                return refused(format!("would replace {input}, which is read; another name helps"));
            }
            if !written.insert(identity) {
                return refused("would be written twice; two names help".to_owned());
            }
        }
        if !force && *output != Path::new("-") && output.is_file() && !is_ours(output) {
            let why = "is there already, and this program has not made it; another name, or --force, helps";
            return refused(why.to_owned());
        }
    }
    Ok(())
}

/// What two names of one file have in common: there is one of both, or there would be.
#[derive(Debug, PartialEq, Eq, Hash)]
enum Identity {
    /// Device and number of a file that is there; also of hard links.
    #[cfg(unix)]
    Found(u64, u64),
    /// The name from the root.
    Named(PathBuf),
}

impl Identity {
    /// That of a file; none where its folder is not there, so that nothing can be written.
    fn of(path: &Path) -> Option<Self> {
        #[cfg(unix)]
        if let Ok(found) = std::fs::metadata(path) {
            use std::os::unix::fs::MetadataExt as _;
            return Some(Self::Found(found.dev(), found.ino()));
        }
        let whole = path.canonicalize().ok().or_else(|| {
            let folder =
                path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            Some(folder.canonicalize().ok()?.join(path.file_name()?))
        })?;
        Some(Self::Named(whole))
    }
}

/// Where something goes: to a file of that name, or to standard output as a file of some ending.
///
/// # Errors
/// When the system has no room for temporary files, or standard output is closed.
pub(super) fn destination(name: &Path, ending: &str) -> Result<Destination, CliError> {
    let to = Destination::new(name, ending).map_err(CliError::Output)?;
    if to.is_standard_output() {
        check_output()?;
    }
    Ok(to)
}

/// Whether anything can be written to standard output.
///
/// # Errors
/// When it was closed before the program was started.
fn check_output() -> Result<(), CliError> {
    let closed = || CliError::Output(std::io::Error::other("it is closed"));
    if is_output_closed() { Err(closed()) } else { Ok(()) }
}

/// What has been written goes to standard output if it is for that.
///
/// # Errors
/// When what is behind it takes no more; a closed pipe is no error.
pub(super) fn hand_over(to: Destination) -> Result<(), CliError> {
    match to.hand_over() {
        Err(err) if err.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(err)),
        _ => Ok(()),
    }
}

/// As [`hand_over`]; what is in a file is said.
///
/// # Errors
/// As [`hand_over`].
pub(super) fn finish(to: Destination) -> Result<(), CliError> {
    if to.is_standard_output() { hand_over(to) } else { print_line(&to.path().display().to_string()) }
}

/// Prints a line to standard output; a closed pipe (`| head`) is no error.
///
/// # Errors
/// When what is behind it takes no more.
pub(super) fn print_line(text: &str) -> Result<(), CliError> {
    check_output()?;
    let mut out = std::io::stdout();
    match writeln!(out, "{}", without_controls(text)).and_then(|()| out.flush()) {
        Err(err) if err.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(err)),
        _ => Ok(()),
    }
}

/// Prints a message to standard error, on one line whatever is in it.
pub(super) fn warn_line(text: &str) {
    // Nothing can be done when it is closed.
    writeln!(std::io::stderr(), "{}", one_line(text)).ok();
}

/// Prints lines to standard error: what is said of wrong arguments.
pub(super) fn warn_lines(text: &str) {
    writeln!(std::io::stderr(), "{}", without_controls(text)).ok();
}

/// Says that pictures show nothing of a volume, and what helps.
pub(super) fn warn_of_nothing() {
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
        let is_same_file =
            |a: &Path, b: &Path| matches!((Identity::of(a), Identity::of(b)), (Some(a), Some(b)) if a == b);
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
            |inputs: &[&Path], outputs: &[&Path], force| keep_apart(inputs, outputs, force).is_err();
        assert!(!is_refused(&[&a], &[&b, &new], true) && is_refused(&[&a], &[&b, &new], false));
        assert!(is_refused(&[&a, &b], &[&new, &b], true) && is_refused(&[&a], &[&new, &new], true));
    }
}
