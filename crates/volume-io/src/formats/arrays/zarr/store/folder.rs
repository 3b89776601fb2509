//! Store in a folder, whose files are the values.

use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{ErrorKind, Read as _, Seek as _, SeekFrom};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use super::{ByteRange, MAX_CHILDREN, Store, StoreError, resolve_range};

/// Folder with a Zarr hierarchy. Links below it are not followed: they could lead anywhere.
#[derive(Debug)]
pub(crate) struct FolderStore {
    root: PathBuf,
    /// Keys of folders that are known to be no links.
    checked_folders: Mutex<HashSet<String>>,
}

impl FolderStore {
    pub(crate) fn new(root: PathBuf) -> Self {
        Self { root, checked_folders: Mutex::default() }
    }

    /// Returns true if a key names a file; an error where it, or a folder above it, is a link.
    fn is_file(&self, key: &str) -> Result<bool, StoreError> {
        let folder = key.rsplit_once('/').map_or("", |(folder, _)| folder);
        Ok(self.is_folder(folder)? && self.entry(key)?.is_some_and(|metadata| metadata.is_file()))
    }

    /// Returns true if a key names a folder; an error where it, or one above it, is a link.
    fn is_folder(&self, key: &str) -> Result<bool, StoreError> {
        let checked = || self.checked_folders.lock().unwrap_or_else(PoisonError::into_inner);
        if key.is_empty() || checked().contains(key) {
            return Ok(true);
        }
        let above = key.rsplit_once('/').map_or("", |(folder, _)| folder);
        let is_folder = self.is_folder(above)? && self.entry(key)?.is_some_and(|metadata| metadata.is_dir());
        if is_folder {
            checked().insert(key.to_owned());
        }
        Ok(is_folder)
    }

    /// Metadata of a file or folder; `None` if there is none, an error where it is a link.
    fn entry(&self, key: &str) -> Result<Option<fs::Metadata>, StoreError> {
        match fs::symlink_metadata(self.root.join(key)) {
            Ok(metadata) if metadata.is_symlink() => Err(StoreError::Unusable(
                "it is a link, and could lead out of the folder".to_owned(),
                "copy the folder with the files that its links name: cp -rL FOLDER COPY",
            )),
            Ok(metadata) => Ok(Some(metadata)),
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }
}

impl Store for FolderStore {
    fn read(&self, key: &str, range: ByteRange) -> Result<Option<Vec<u8>>, StoreError> {
        if !self.is_file(key)? {
            return Ok(None);
        }
        let mut file = match File::open(self.root.join(key)) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            opened => opened?,
        };
        let (start, count) = resolve_range(file.metadata()?.len(), range)?;
        if start > 0 {
            file.seek(SeekFrom::Start(start))?;
        }
        let mut bytes = Vec::new();
        let count_in_memory = usize::try_from(count).unwrap_or(usize::MAX);
        bytes.try_reserve_exact(count_in_memory).map_err(std::io::Error::other)?;
        file.take(count).read_to_end(&mut bytes)?;
        if bytes.len() < count_in_memory {
            // It has become shorter meanwhile.
            return Err(super::length_error(start + bytes.len() as u64, range));
        }
        Ok(Some(bytes))
    }

    fn children(&self, key: &str) -> Result<Vec<String>, StoreError> {
        if !self.is_folder(key)? {
            return Ok(Vec::new());
        }
        let mut names = Vec::new();
        for entry in fs::read_dir(self.root.join(key))?.take(MAX_CHILDREN) {
            let entry = entry?;
            if entry.file_type()?.is_dir()
                && let Ok(name) = entry.file_name().into_string()
            {
                names.push(name);
            }
        }
        names.sort();
        Ok(names)
    }
}
