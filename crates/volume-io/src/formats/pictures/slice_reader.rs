//! Assembly of a volume from slices that are decoded one by one, from one file or from many.
//!
//! Several slices are decoded at a time, on all cores; besides the volume only these are in memory.

use std::io::{self, Read};

use crate::reading::number::VoxelEncoding;
use crate::reading::samples::{ReadFault, VoxelLayout};
use crate::reading::voxels::{ReadVoxels, ValueMapping};
use chiaroscuro_volume::{GridExtent, LoadContext, LoadControl, LoadError};

/// Bytes of slices that are decoded at a time: enough for all cores, small against a volume.
const AT_ONCE_BYTES: u64 = 32 << 20;

/// Reads the selected voxels of slices, each stored as `stored` gives. `decode` returns the bytes of slices, given by
/// index; slices without selected voxels are not requested.
///
/// # Errors
/// Errors of `decode`; `BadInput` where a slice has an unexpected length, `Limit` where memory is exhausted.
pub(super) fn read_slices(
    context: LoadContext<'_>,
    stored: &VoxelEncoding,
    extent: GridExtent,
    meant: &ValueMapping<'_>,
    control: &LoadControl,
    decode: impl FnMut(&[usize]) -> Result<Vec<Vec<u8>>, LoadError>,
) -> Result<ReadVoxels, LoadError> {
    let [width, height, _] = extent.dims;
    let slices: Vec<usize> = extent.read.slices().collect();
    let count = slices.len();
    let slice_bytes = (width as u64 * height as u64).saturating_mul(stored.voxel_bytes());
    let at_once = usize::try_from(AT_ONCE_BYTES / slice_bytes.max(1)).unwrap_or(count).clamp(1, count);
    let mut pile = SliceReader { decode, slices, at_once, next: 0, ready: Vec::new(), at: 0, failed: None };
    let needed = extent.restricted_to_slices(stored.voxel_type());
    let read = stored.read_values(&mut pile, None, needed, meant, control);
    let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    match (read, pile.failed) {
        (_, Some(error)) => Err(error),
        (read, None) => read.map_err(|fault: ReadFault| {
            fault.into_error(context, &layout, "bytes", "copy the file again, or save it anew")
        }),
    }
}

/// Reader of the concatenated bytes of all slices.
struct SliceReader<F> {
    decode: F,
    /// Indices of the slices that are needed.
    slices: Vec<usize>,
    at_once: usize,
    /// Position in `slices` after those that are ready.
    next: usize,
    /// Decoded slices in reverse order, so that the next one is last.
    ready: Vec<Vec<u8>>,
    /// Bytes of the next slice that were handed out.
    at: usize,
    /// Error that ended the stream, since [`Read`] can only return [`io::Error`].
    failed: Option<LoadError>,
}

impl<F: FnMut(&[usize]) -> Result<Vec<Vec<u8>>, LoadError>> Read for SliceReader<F> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        loop {
            if let Some(slice) = self.ready.last() {
                let count = out.len().min(slice.len() - self.at);
                if count > 0 {
                    out[..count].copy_from_slice(&slice[self.at..self.at + count]);
                    self.at += count;
                    return Ok(count);
                }
                self.ready.pop();
                self.at = 0;
            } else if self.next < self.slices.len() {
                let end = self.slices.len().min(self.next + self.at_once);
                match (self.decode)(&self.slices[self.next..end]) {
                    Ok(slices) => self.ready = slices,
                    Err(error) => {
                        self.failed = Some(error);
                        return Err(io::Error::other("a slice is not there"));
                    }
                }
                self.ready.reverse();
                self.next = end;
            } else {
                return Ok(0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Endian;
    use crate::reading::number::FileNumberType;
    use chiaroscuro_volume::{Portion, ResolvedPortion, Samples};

    #[test]
    fn slices_follow_each_other_and_one_that_fails_ends_it() {
        let context = LoadContext { operation: "test", path: Path::new("t") };
        let stored = VoxelEncoding::scalar(FileNumberType::U8, Endian::Little);
        let extent = GridExtent::unchecked([2, 1, 3], stored.voxel_type());
        let (control, meant) = (LoadControl::new(), ValueMapping::identity(None));
        let slices = |some: &[usize]| Ok(some.iter().map(|&z| vec![z as u8, 10 + z as u8]).collect());
        let read = read_slices(context, &stored, extent, &meant, &control, slices);
        assert_eq!(read.unwrap().samples, Samples::U8(vec![0, 10, 1, 11, 2, 12]));
        let half = ResolvedPortion::resolve(&Portion::with_stride(2), [2, 1, 3], false).unwrap();
        let half = GridExtent { wanted: half, read: half, ..extent };
        let read = read_slices(context, &stored, half, &meant, &control, |some| {
            assert_eq!(some, [0, 2], "of the second slice nothing is kept");
            slices(some)
        });
        assert_eq!(read.unwrap().samples, Samples::U8(vec![0, 2]));
        let short = |some: &[usize]| Ok(some.iter().map(|&z| vec![z as u8]).collect());
        let error = read_slices(context, &stored, extent, &meant, &control, short).unwrap_err();
        assert!(error.to_string().contains("6 bytes expected"), "{error}");
        let fails = |_: &[usize]| Err(context.bad_input_error("page 1", "it is broken", "mend it"));
        let error = read_slices(context, &stored, extent, &meant, &control, fails).unwrap_err();
        assert!(error.to_string().contains("it is broken"), "{error}");
    }
}
