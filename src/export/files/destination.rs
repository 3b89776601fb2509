//! Where a result goes: to a file, or to standard output.

use std::fs::File;
use std::path::{Path, PathBuf};

/// What is written for standard output is written to a file first, whole or not at all, as all others are.
#[derive(Debug)]
pub struct Destination {
    path: PathBuf,
    folder: Option<tempfile::TempDir>,
}

impl Destination {
    /// A file of that name; for `-`, standard output with a file of some ending.
    ///
    /// # Errors
    /// When the system has no room for temporary files.
    pub fn new(name: &Path, ending: &str) -> std::io::Result<Self> {
        if name != Path::new("-") {
            return Ok(Self { path: name.to_owned(), folder: None });
        }
        let folder = tempfile::Builder::new().prefix("chiaroscuro-").tempdir()?;
        Ok(Self { path: folder.path().join("output").with_extension(ending), folder: Some(folder) })
    }

    /// The file that is to be written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder from which what is written sees other files; none of standard output.
    pub fn folder(&self) -> Option<&Path> {
        self.path.parent().filter(|_| self.folder.is_none())
    }

    /// Whether it is standard output, on which nothing else is said then.
    pub fn is_standard_output(&self) -> bool {
        self.folder.is_some()
    }

    /// The file has been written: standard output gets it.
    ///
    /// # Errors
    /// When what is behind it takes no more.
    pub fn hand_over(self) -> std::io::Result<()> {
        if self.is_standard_output() {
            let mut out = std::io::stdout().lock();
            std::io::copy(&mut File::open(&self.path)?, &mut out)?;
            std::io::Write::flush(&mut out)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_files_and_a_dash_is_none() {
        let file = Destination::new(Path::new("a/b.png"), "png").unwrap();
        assert_eq!((file.path(), file.folder()), (Path::new("a/b.png"), Some(Path::new("a"))));
        assert!(!file.is_standard_output());
        file.hand_over().unwrap();
        let out = Destination::new(Path::new("-"), "exr").unwrap();
        assert!(out.is_standard_output() && out.folder().is_none());
        assert_eq!(out.path().extension().unwrap(), "exr");
        let folder = out.path().parent().unwrap().to_owned();
        assert!(folder.is_dir());
        drop(out);
        assert!(!folder.exists(), "nothing is left of it");
    }
}
