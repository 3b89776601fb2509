//! Store in a ZIP archive, whose entries are the values.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use super::input::InputFile;
use super::zip::{ZipEntry, read_central_directory, read_entry_range};
use super::{ByteRange, LoadError, MAX_CHILDREN, Store, StoreError, is_document, resolve_range};
use chiaroscuro_volume::LoadContext;

/// Archive with a Zarr hierarchy.
pub(crate) struct ZipStore {
    path: PathBuf,
    input: Mutex<InputFile>,
    /// Entries by their keys.
    entries: BTreeMap<String, ZipEntry>,
}

impl ZipStore {
    /// Opens an archive, in which the hierarchy may lie in a folder.
    ///
    /// # Errors
    /// `BadInput` where the archive is broken, or holds no metadata of Zarr.
    pub(crate) fn new(context: LoadContext<'_>, mut input: InputFile) -> Result<Self, LoadError> {
        let directory = read_central_directory(context, &mut input)?;
        let of_document = |name: &str| {
            let (folder, document) = name.rsplit_once('/').unwrap_or(("", name));
            is_document(document).then(|| folder.to_owned())
        };
        let names = || directory.entries.iter().map(|entry| entry.name.as_str());
        let Some(root) = names().filter_map(of_document).min_by_key(String::len) else {
            return Err(context.bad_input_error(
                "entries",
                "the archive holds no metadata of Zarr: neither zarr.json nor .zattrs",
                "open the array or image as a folder, or pack the folder anew",
            ));
        };
        let key_of = |name: &str| match root.as_str() {
            "" => Some(name.to_owned()),
            root => name.strip_prefix(root)?.strip_prefix('/').map(str::to_owned),
        };
        let entries = directory.entries.into_iter();
        let entries = entries.filter_map(|entry| key_of(&entry.name).map(|key| (key, entry))).collect();
        Ok(Self { path: context.path.to_owned(), input: Mutex::new(input), entries })
    }
}

impl Store for ZipStore {
    fn read(&self, key: &str, range: ByteRange) -> Result<Option<Vec<u8>>, StoreError> {
        let Some(entry) = self.entries.get(key) else { return Ok(None) };
        let (start, count) = resolve_range(entry.bytes, range)?;
        let context = LoadContext { operation: "read the Zarr archive", path: &self.path };
        let mut input = self.input.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes = read_entry_range(context, &mut input, entry, start, count).map_err(StoreError::Load)?;
        if (bytes.len() as u64) < count {
            return Err(super::length_error(start + bytes.len() as u64, range));
        }
        Ok(Some(bytes))
    }

    fn children(&self, key: &str) -> Result<Vec<String>, StoreError> {
        let prefix = if key.is_empty() { String::new() } else { format!("{key}/") };
        let below = self.entries.range(prefix.clone()..).take_while(|(name, _)| name.starts_with(&prefix));
        let folders = below.filter_map(|(name, _)| name[prefix.len()..].split_once('/'));
        let names: BTreeSet<String> = folders.map(|(folder, _)| folder.to_owned()).collect();
        Ok(names.into_iter().take(MAX_CHILDREN).collect())
    }
}
