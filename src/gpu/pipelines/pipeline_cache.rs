//! Compiled pipelines kept on disk, where the backend can (Vulkan): the next start finds them.

use std::path::{Path, PathBuf};

use crate::data::read_bounded;
use crate::export::{ExportError, make_folder, write_atomically};
use crate::gpu::Context;

/// Most bytes that are read: what drivers keep for our three dozen shaders is far less.
const MOST_BYTES: u64 = 64 << 20;

/// What a driver keeps of the pipelines that it made.
#[derive(Debug, Clone)]
pub(crate) struct PipelineCache {
    pub(crate) cache: wgpu::PipelineCache,
    path: PathBuf,
}

impl PipelineCache {
    /// Opens the cache of an adapter in a folder; empty if there is none, or a damaged one. `None` where
    /// the backend keeps nothing.
    #[expect(unsafe_code, reason = "the driver is handed bytes from a file")]
    pub(crate) fn open(context: &Context, folder: &Path) -> Option<Self> {
        let name = wgpu::util::pipeline_cache_key(&context.info)?;
        if !context.device.features().contains(wgpu::Features::PIPELINE_CACHE) {
            return None;
        }
        let path = folder.join(name);
        let data = read(&path);
        // SAFETY: the bytes are those that `save` got from `get_data`: `read` returns none whose sum is not
        // theirs. That adapter, driver and library are the same is checked by wgpu, which falls back to an
        // empty cache.
        let cache = unsafe {
            context.device.create_pipeline_cache(&wgpu::PipelineCacheDescriptor {
                label: Some("PipelineCache"),
                data: data.as_deref(),
                fallback: true,
            })
        };
        Some(Self { cache, path })
    }

    /// Writes what the driver keeps, whole or not at all.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub(crate) fn save(&self) -> Result<(), ExportError> {
        let Some(data) = self.cache.get_data() else { return Ok(()) };
        let folder = self.path.parent().unwrap_or(Path::new("."));
        make_folder(folder).map_err(|source| ExportError::Write { path: folder.to_owned(), source })?;
        write_atomically(&self.path, &[&sum(&data).to_le_bytes(), &data[..]].concat())
    }
}

/// The bytes of a file that `save` has written; `None` if it was not, or is damaged.
fn read(path: &Path) -> Option<Vec<u8>> {
    let mut bytes = read_bounded(path, MOST_BYTES).ok()??;
    let (stated, data) = bytes.split_first_chunk::<8>()?;
    if u64::from_le_bytes(*stated) != sum(data) {
        log::warn!("{} is damaged: pipelines are made anew", path.display());
        return None;
    }
    bytes.drain(..8);
    Some(bytes)
}

/// Fletcher's sum: notices any single changed byte, and bytes that changed places.
fn sum(bytes: &[u8]) -> u64 {
    let (mut a, mut b) = (1_u64, 0_u64);
    for &byte in bytes {
        a = a.wrapping_add(u64::from(byte));
        b = b.wrapping_add(a);
    }
    (b << 32) ^ a ^ (bytes.len() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn damaged_files_are_not_handed_to_drivers() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("cache");
        assert_eq!(read(&path), None, "no file");
        let data = b"what a driver keeps".to_vec();
        let mut whole = sum(&data).to_le_bytes().to_vec();
        whole.extend(&data);
        std::fs::write(&path, &whole).expect("written");
        assert_eq!(read(&path), Some(data));
        for at in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[at] ^= 4;
            std::fs::write(&path, &damaged).expect("written");
            assert_eq!(read(&path), None, "byte {at}");
        }
        // A file without an end, and one that is longer than any cache.
        #[cfg(target_os = "linux")]
        {
            let link = folder.path().join("link");
            std::os::unix::fs::symlink("/dev/zero", &link).expect("a link");
            assert_eq!(read(&link), None);
            let pipe = folder.path().join("pipe");
            let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
            assert!(made.success());
            assert_eq!(read(&pipe), None);
        }
        std::fs::File::create(folder.path().join("long"))
            .and_then(|file| file.set_len(MOST_BYTES + 1))
            .expect("made");
        assert_eq!(read(&folder.path().join("long")), None);
        for short in [0, 7, 8, whole.len() - 1] {
            std::fs::write(&path, &whole[..short]).expect("written");
            assert_eq!(read(&path), None, "{short} bytes");
        }
    }
}
