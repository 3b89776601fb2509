//! Destinations of the files of a hierarchy: a temporary folder, or the memory of a test.

use std::collections::HashSet;
use std::io::Result;
use std::path::PathBuf;

use chiaroscuro_files::TemporaryFolder;

/// Destination of files, each of which grows at its end.
pub(super) trait HierarchySink {
    /// Appends bytes to the file of a key, a path of slashes.
    fn append(&mut self, key: &str, bytes: &[u8]) -> Result<()>;
}

/// Folder with the files, which knows in which order they were begun.
#[derive(Debug)]
pub(super) struct FolderSink {
    folder: TemporaryFolder,
    keys: Vec<String>,
    known_keys: HashSet<String>,
}

impl FolderSink {
    pub(super) fn new(folder: TemporaryFolder) -> Self {
        Self { folder, keys: Vec::new(), known_keys: HashSet::new() }
    }

    /// Keys of all files, in the order in which they were begun: those of metadata first.
    pub(super) fn keys(&self) -> &[String] {
        &self.keys
    }

    /// Path of the file of a key.
    pub(super) fn path(&self, key: &str) -> PathBuf {
        self.folder.path().join(key)
    }

    /// Returns the folder.
    pub(super) fn into_folder(self) -> TemporaryFolder {
        self.folder
    }
}

impl HierarchySink for FolderSink {
    fn append(&mut self, key: &str, bytes: &[u8]) -> Result<()> {
        if !self.known_keys.contains(key) {
            self.known_keys.insert(key.to_owned());
            self.keys.push(key.to_owned());
        }
        self.folder.append(key, bytes)
    }
}
