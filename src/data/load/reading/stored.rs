//! Voxels that lie in a file as they lie in memory, but for the order of their bytes: several threads read them, each the
//! next block that nobody has taken.
//!
//! What takes time is not the file, which the system has read before, but memory that is used for the first time: the system
//! clears each page of it. On two cores that takes half as long.

use std::fs::File;
use std::io::{self, Read};
use std::sync::{Mutex, PoisonError};

use super::LoadControl;
use super::samples::{BLOCK_BYTES, Fault, Layout, Sample, read_as, read_block, zeroed};
use crate::data::{Samples, VoxelType};

/// More threads than these do not copy faster: memory is the limit.
const MOST_THREADS: usize = 4;

/// Reads voxels that begin at a byte of a file; what follows them is left alone.
pub(super) fn read_file(
    file: &File,
    at: u64,
    layout: &Layout,
    control: &LoadControl,
) -> Result<Samples, Fault> {
    control.start(layout.extent.bytes);
    read_as!(layout.voxel_type, read_parts(file, at, layout, control))
}

fn read_parts<T: Sample>(
    file: &File,
    at: u64,
    layout: &Layout,
    control: &LoadControl,
) -> Result<Vec<T>, Fault> {
    let mut values = zeroed::<T>(layout.extent.voxels)?;
    // In order, as disks like it; and before the first block that fails none is left out.
    let blocks = Mutex::new(values.chunks_mut(BLOCK_BYTES / size_of::<T>()).enumerate());
    let failed: Mutex<Option<(usize, Fault)>> = Mutex::new(None);
    let work = || {
        loop {
            let next = blocks.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((number, block)) = next else { return };
            let before = (number * BLOCK_BYTES) as u64;
            let Err(fault) = read_block(&mut Within { file, at: at + before }, block, layout.endian, control)
            else {
                continue;
            };
            let mut failed = failed.lock().unwrap_or_else(PoisonError::into_inner);
            if failed.as_ref().is_none_or(|&(first, _)| number < first) {
                *failed = Some((number, fault.after(before)));
            }
            // Nobody takes another one.
            blocks.lock().unwrap_or_else(PoisonError::into_inner).by_ref().for_each(drop);
            return;
        }
    };
    rayon::scope(|scope| {
        for _ in 1..rayon::current_num_threads().min(MOST_THREADS) {
            scope.spawn(|_| work());
        }
        work();
    });
    match failed.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some((_, fault)) => Err(fault),
        None => Ok(values),
    }
}

/// A file from a byte on, whatever others read of it meanwhile.
struct Within<'a> {
    file: &'a File,
    at: u64,
}

impl Read for Within<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        #[cfg(unix)]
        let count = std::os::unix::fs::FileExt::read_at(self.file, into, self.at)?;
        #[cfg(windows)]
        let count = std::os::windows::fs::FileExt::seek_read(self.file, into, self.at)?;
        self.at += count as u64;
        Ok(count)
    }
}
