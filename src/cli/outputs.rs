//! What commands write: never in place of what they read, nor of one another; and what they print.

use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use super::CliError;
use crate::data::without_controls;
use crate::export::{Destination, is_ours};

/// Refuses names under which a command would replace what it reads, or what else it writes, whatever they are called.
///
/// # Errors
/// Which file it is.
pub(super) fn keep_apart(inputs: &[&Path], outputs: &[&Path]) -> Result<(), CliError> {
    for (at, output) in outputs.iter().enumerate() {
        let is_same = |other: &&&Path| is_same_file(output, other);
        if let Some(input) = inputs.iter().find(is_same) {
            return Err(CliError::Usage(format!(
                "{} would replace {}, which is read; another name helps",
                output.display(),
                input.display()
            )));
        }
        if outputs[..at].iter().any(|other| is_same_file(output, other)) {
            return Err(CliError::Usage(format!(
                "{} would be written twice; two names help",
                output.display()
            )));
        }
    }
    Ok(())
}

/// Refuses names of files that this program has not made. What is no file is refused when it is written.
///
/// # Errors
/// Which file it is.
pub(super) fn spare_others(outputs: &[&Path]) -> Result<(), CliError> {
    let theirs = |path: &&&Path| **path != Path::new("-") && path.is_file() && !is_ours(path);
    match outputs.iter().find(theirs) {
        None => Ok(()),
        Some(path) => Err(CliError::Usage(format!(
            "{} is there already, and this program has not made it; another name, or --force, helps",
            path.display()
        ))),
    }
}

/// Whether two names stand for one file: there is one of both, or there would be.
fn is_same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        // Also of hard links.
        if let (Ok(a), Ok(b)) = (std::fs::metadata(a), std::fs::metadata(b)) {
            return (a.dev(), a.ino()) == (b.dev(), b.ino());
        }
    }
    matches!((whole_name(a), whole_name(b)), (Some(a), Some(b)) if a == b)
}

/// The name from the root of a file that may not be there yet; none where its folder is not there.
fn whole_name(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().or_else(|| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    })
}

/// Where something goes: to a file of that name, or to standard output as a file of some ending.
///
/// # Errors
/// When the system has no room for temporary files.
pub(super) fn destination(name: &Path, ending: &str) -> Result<Destination, CliError> {
    Destination::new(name, ending).map_err(CliError::Output)
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
    match writeln!(std::io::stdout(), "{}", without_controls(text)) {
        Err(err) if err.kind() != ErrorKind::BrokenPipe => Err(CliError::Output(err)),
        _ => Ok(()),
    }
}

/// Prints a line to standard error.
pub(super) fn warn_line(text: &str) {
    // Nothing can be done when it is closed.
    writeln!(std::io::stderr(), "{}", without_controls(text)).ok();
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
        assert!(keep_apart(&[&a], &[&b, &new]).is_ok());
        assert!(keep_apart(&[&a, &b], &[&new, &b]).is_err() && keep_apart(&[&a], &[&b, &b]).is_err());
    }
}
