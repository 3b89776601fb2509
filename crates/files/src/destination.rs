//! Destination of a command's result: a file, or standard output.

use std::fs::File;
use std::path::{Path, PathBuf};

/// Destination of an output. For standard output, the result is first written atomically to a temporary file.
#[derive(Debug)]
pub struct OutputDestination {
    path: PathBuf,
    folder: Option<tempfile::TempDir>,
}

impl OutputDestination {
    /// Creates a destination for a file name; `-` stands for standard output, with the format of an extension.
    ///
    /// # Errors
    /// When no temporary folder can be created.
    pub fn new(name: &Path, ending: &str) -> std::io::Result<Self> {
        if name != Path::new("-") {
            return Ok(Self { path: name.to_owned(), folder: None });
        }
        let folder = tempfile::Builder::new().prefix("chiaroscuro-").tempdir()?;
        Ok(Self { path: folder.path().join("output").with_extension(ending), folder: Some(folder) })
    }

    /// Path of the file to be written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Folder that relative paths in the output refer to; `None` for standard output.
    pub fn folder(&self) -> Option<&Path> {
        self.path.parent().filter(|_| self.folder.is_none())
    }

    /// Returns true if it is standard output, to which nothing else is printed then.
    pub fn is_standard_output(&self) -> bool {
        self.folder.is_some()
    }

    /// Copies the written file to standard output, if that is the destination.
    ///
    /// # Errors
    /// When the reader of standard output accepts no more data.
    pub fn copy_to_stdout(self) -> std::io::Result<()> {
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
        let file = OutputDestination::new(Path::new("a/b.png"), "png").unwrap();
        assert_eq!((file.path(), file.folder()), (Path::new("a/b.png"), Some(Path::new("a"))));
        assert!(!file.is_standard_output());
        file.copy_to_stdout().unwrap();
        let out = OutputDestination::new(Path::new("-"), "exr").unwrap();
        assert!(out.is_standard_output() && out.folder().is_none());
        assert_eq!(out.path().extension().unwrap(), "exr");
        let folder = out.path().parent().unwrap().to_owned();
        assert!(folder.is_dir());
        drop(out);
        assert!(!folder.exists(), "nothing is left of it");
    }
}
