//! Pipeline cache on disk, for backends that support it (Vulkan): the next start skips compilation.

use std::path::{Path, PathBuf};

use crate::GpuContext;
use chiaroscuro_files::{WriteError, make_folder, read_bounded, write_atomically};

/// Maximum size of a cache file that is read, in bytes; caches of this program's three dozen shaders are far smaller.
const MAX_CACHE_BYTES: u64 = 64 << 20;

/// Driver's cache of compiled pipelines, with its file.
#[derive(Debug, Clone)]
pub(crate) struct PipelineCache {
    pub(crate) cache: wgpu::PipelineCache,
    path: PathBuf,
}

impl PipelineCache {
    /// Opens the cache of an adapter in a folder; empty if the file is missing or damaged. `None` where the backend
    /// has no pipeline cache.
    #[expect(unsafe_code, reason = "the driver is handed bytes from a file")]
    pub(crate) fn open(context: &GpuContext, folder: &Path) -> Option<Self> {
        let name = wgpu::util::pipeline_cache_key(&context.info)?;
        if !context.device.features().contains(wgpu::Features::PIPELINE_CACHE) {
            return None;
        }
        let path = folder.join(name);
        let data = read_checked(&path);
        // SAFETY: the bytes are those that `save` got from `get_data`: `read_checked` returns none whose checksum
        // differs. wgpu checks that adapter, driver and library are the same, and falls back to an empty cache.
        let cache = unsafe {
            context.device.create_pipeline_cache(&wgpu::PipelineCacheDescriptor {
                label: Some("PipelineCache"),
                data: data.as_deref(),
                fallback: true,
            })
        };
        Some(Self { cache, path })
    }

    /// Writes the driver's cache to its file, atomically.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub(crate) fn save(&self) -> Result<(), WriteError> {
        let Some(data) = self.cache.get_data() else { return Ok(()) };
        let folder = self.path.parent().unwrap_or(Path::new("."));
        make_folder(folder).map_err(WriteError::io_error_for(folder))?;
        write_atomically(&self.path, &[&fletcher_checksum(&data).to_le_bytes(), &data[..]].concat())
    }
}

/// Reads a file that `save` has written; `None` if it is missing or damaged.
fn read_checked(path: &Path) -> Option<Vec<u8>> {
    let mut bytes = read_bounded(path, MAX_CACHE_BYTES).ok()??;
    let (stated, data) = bytes.split_first_chunk::<8>()?;
    if u64::from_le_bytes(*stated) != fletcher_checksum(data) {
        log::warn!("{} is damaged: pipelines are compiled again", path.display());
        return None;
    }
    bytes.drain(..8);
    Some(bytes)
}

/// Fletcher's checksum with 32-bit sums: detects any single changed byte, and swapped bytes.
fn fletcher_checksum(bytes: &[u8]) -> u64 {
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
        assert_eq!(read_checked(&path), None, "no file");
        let data = b"what a driver keeps".to_vec();
        let mut whole = fletcher_checksum(&data).to_le_bytes().to_vec();
        whole.extend(&data);
        std::fs::write(&path, &whole).expect("written");
        assert_eq!(read_checked(&path), Some(data));
        for at in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[at] ^= 4;
            std::fs::write(&path, &damaged).expect("written");
            assert_eq!(read_checked(&path), None, "byte {at}");
        }
        // An endless file, a pipe and a file longer than any cache are rejected.
        #[cfg(target_os = "linux")]
        {
            let link = folder.path().join("link");
            std::os::unix::fs::symlink("/dev/zero", &link).expect("a link");
            assert_eq!(read_checked(&link), None);
            let pipe = folder.path().join("pipe");
            let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
            assert!(made.success());
            assert_eq!(read_checked(&pipe), None);
        }
        std::fs::File::create(folder.path().join("long"))
            .and_then(|file| file.set_len(MAX_CACHE_BYTES + 1))
            .expect("made");
        assert_eq!(read_checked(&folder.path().join("long")), None);
        for short in [0, 7, 8, whole.len() - 1] {
            std::fs::write(&path, &whole[..short]).expect("written");
            assert_eq!(read_checked(&path), None, "{short} bytes");
        }
    }
}
