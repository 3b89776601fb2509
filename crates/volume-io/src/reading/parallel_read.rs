//! Multi-threaded reading of voxels that lie in a file as in memory, up to byte order; each thread takes the next
//! free block.
//!
//! The bottleneck is not the file, which the system usually has cached, but the first use of memory: the system
//! clears each page. On two cores this halves the time.

use std::fs::File;
use std::io::{self, Read};
use std::sync::{Mutex, PoisonError};

use super::LoadControl;
use super::input::InputFile;
use super::number::VoxelEncoding;
use super::samples::{BLOCK_BYTES, DecodeSample, ReadFault, VoxelLayout, alloc_zeroed, read_as, read_block};
use super::voxel_filter::skip_in_file;
use super::voxels::{ReadVoxels, ValueMapping};
use chiaroscuro_volume::{GridExtent, Samples, VoxelType};

/// Maximum number of threads: more do not copy faster, since memory bandwidth is the limit.
const MAX_THREADS: usize = 4;

/// Bytes that a thread takes at a time: large against the cost of taking them, small enough for all threads to end
/// together.
const PART_BYTES: usize = 4 << 20;

impl VoxelEncoding {
    /// Reads the selected voxels of an uncompressed grid, which begins at byte `at` of a file, as values. The file
    /// position afterwards is unspecified.
    pub(crate) fn read_from_file(
        &self,
        input: &mut InputFile,
        at: u64,
        extent: GridExtent,
        meant: &ValueMapping<'_>,
        control: &LoadControl,
    ) -> Result<ReadVoxels, ReadFault> {
        if extent.read.is_whole_grid() && self.matches_memory_layout() {
            let layout = VoxelLayout { extent, voxel_type: self.voxel_type(), endian: self.endian };
            let samples = read_file(input.reader.get_ref(), at, &layout, control)?;
            return Ok((meant.map)(samples)?.into());
        }
        input.seek(at).map_err(ReadFault::Io)?;
        self.read_values(&mut input.reader, Some(skip_in_file), extent, meant, control)
    }
}

/// Reads all voxels of a grid that begins at byte `at` of a file; bytes after them are not touched.
fn read_file(
    file: &File,
    at: u64,
    layout: &VoxelLayout,
    control: &LoadControl,
) -> Result<Samples, ReadFault> {
    control.start(layout.extent.bytes);
    read_as!(layout.voxel_type, read_parts(file, at, layout, control))
}

fn read_parts<T: DecodeSample>(
    file: &File,
    at: u64,
    layout: &VoxelLayout,
    control: &LoadControl,
) -> Result<Vec<T>, ReadFault> {
    let mut values = alloc_zeroed::<T>(layout.extent.voxels)?;
    // In file order, for the disk's sake, and so that all parts before the first one that fails have been read.
    let parts = Mutex::new(values.chunks_mut(PART_BYTES / size_of::<T>()).enumerate());
    let failed: Mutex<Option<(usize, ReadFault)>> = Mutex::new(None);
    let work = || {
        loop {
            let next = parts.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((number, part)) = next else { return };
            let mut done = (number * PART_BYTES) as u64;
            let mut within = PositionedReader { file, at: at.saturating_add(done) };
            let mut blocks = part.chunks_mut(BLOCK_BYTES / size_of::<T>());
            let read = blocks.try_for_each(|block| {
                done += read_block(&mut within, block, layout.endian, control)?;
                Ok(())
            });
            let Err(fault) = read else { continue };
            let mut failed = failed.lock().unwrap_or_else(PoisonError::into_inner);
            if failed.as_ref().is_none_or(|&(first, _)| number < first) {
                *failed = Some((number, ReadFault::with_bytes_before(fault, done)));
            }
            // Drains the queue, so that no thread takes another part.
            parts.lock().unwrap_or_else(PoisonError::into_inner).by_ref().for_each(drop);
            return;
        }
    };
    rayon::scope(|scope| {
        for _ in 1..rayon::current_num_threads().min(MAX_THREADS) {
            scope.spawn(|_| work());
        }
        work();
    });
    match failed.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some((_, fault)) => Err(fault),
        None => Ok(values),
    }
}

/// Reader of a file from an offset of its own, independent of the shared file position.
struct PositionedReader<'a> {
    file: &'a File,
    at: u64,
}

impl Read for PositionedReader<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        #[cfg(unix)]
        let count = std::os::unix::fs::FileExt::read_at(self.file, into, self.at)?;
        #[cfg(windows)]
        let count = std::os::windows::fs::FileExt::seek_read(self.file, into, self.at)?;
        self.at += count as u64;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;
    use crate::Endian;

    fn layout(voxels: u64, voxel_type: VoxelType, endian: Endian) -> VoxelLayout {
        VoxelLayout { extent: GridExtent::unchecked([voxels as usize, 1, 1], voxel_type), voxel_type, endian }
    }

    #[test]
    fn parts_of_a_file_come_to_their_places() {
        // Several parts, the last of them partial, after an offset of three bytes.
        let count = 3 * PART_BYTES / 2 + 12_345;
        let words: Vec<u16> =
            (0..count as u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 16) as u16).collect();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&[9; 3]).unwrap();
        file.write_all(&words.iter().flat_map(|word| word.to_be_bytes()).collect::<Vec<_>>()).unwrap();
        let of = |voxels| layout(voxels, VoxelType::U16, Endian::Big);
        let control = LoadControl::new();
        let read = read_file(&file, 3, &of(count as u64), &control);
        assert!(read.unwrap() == Samples::U16(words), "voxels are at other places, or in another order");
        assert_eq!(control.fraction(), Some(1.0));
        // One word more than there is: all bytes before it are counted, whichever thread has read them.
        let short = read_file(&file, 3, &of(count as u64 + 1), &control);
        assert!(matches!(short, Err(ReadFault::Short { got }) if got == 2 * count as u64));
        let early = read_file(&file, 3, &of(4 * count as u64), &control);
        assert!(
            matches!(early, Err(ReadFault::Short { got }) if got == 2 * count as u64),
            "the first that fails"
        );
        control.cancel();
        assert!(matches!(read_file(&file, 3, &of(count as u64), &control), Err(ReadFault::Stopped(_))));
    }
}
