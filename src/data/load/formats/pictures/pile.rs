//! Slices that lie one by one, in a file or in files of their own, to the voxels of a volume.
//!
//! Some are decoded at a time, on all cores; besides the volume itself no more than those are in memory.

use std::io::{self, Read};
use std::ops::Range;

use crate::data::Samples;
use crate::data::attempt::{Attempt, Extent};
use crate::data::load::reading::number::Stored;
use crate::data::load::reading::samples::{Fault, Layout};
use crate::data::load::{LoadControl, LoadError};

/// Bytes of slices that are decoded at a time: enough for all cores, little beside a volume.
const AT_ONCE_BYTES: u64 = 32 << 20;

/// Reads the voxels of slices, each stored as `stored` says. `decode` gives the bytes of some of them.
///
/// # Errors
/// What `decode` says; `BadInput` where a slice has other bytes than it should, `Limit` without memory.
pub(super) fn read_pile(
    attempt: Attempt<'_>,
    stored: &Stored,
    extent: Extent,
    control: &LoadControl,
    decode: impl FnMut(Range<usize>) -> Result<Vec<Vec<u8>>, LoadError>,
) -> Result<Samples, LoadError> {
    let [width, height, count] = extent.dims;
    let slice_bytes = (width as u64 * height as u64).saturating_mul(stored.bytes_of_voxel());
    let at_once = usize::try_from(AT_ONCE_BYTES / slice_bytes.max(1)).unwrap_or(count).clamp(1, count);
    let mut pile = Pile { decode, count, at_once, next: 0, ready: Vec::new(), at: 0, failed: None };
    let read = stored.read(&mut pile, extent, control);
    let layout = Layout { extent, voxel_type: stored.voxel_type(), endian: stored.endian };
    match (read, pile.failed) {
        (_, Some(error)) => Err(error),
        (read, None) => read.map_err(|fault: Fault| {
            fault.into_error(attempt, &layout, "bytes", "copy the file again, or save it anew")
        }),
    }
}

/// The bytes of all slices, one after the other.
struct Pile<F> {
    decode: F,
    count: usize,
    at_once: usize,
    /// The slice after those that are ready.
    next: usize,
    /// What is to be handed out, the next one last.
    ready: Vec<Vec<u8>>,
    /// Bytes of the next one that were handed out.
    at: usize,
    /// Why there are no more.
    failed: Option<LoadError>,
}

impl<F: FnMut(Range<usize>) -> Result<Vec<Vec<u8>>, LoadError>> Read for Pile<F> {
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
            } else if self.next < self.count {
                let end = self.count.min(self.next + self.at_once);
                match (self.decode)(self.next..end) {
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
    use crate::data::load::Endian;
    use crate::data::load::reading::number::Number;

    #[test]
    fn slices_follow_each_other_and_one_that_fails_ends_it() {
        let attempt = Attempt { what: "test", path: Path::new("t") };
        let stored = Stored::scalar(Number::U8, Endian::Little);
        let extent = Extent::checked(attempt, "sizes", [2, 1, 3], stored.voxel_type(), 100).unwrap();
        let control = LoadControl::new();
        let slices = |range: Range<usize>| Ok(range.map(|z| vec![z as u8, 10 + z as u8]).collect());
        let read = read_pile(attempt, &stored, extent, &control, slices);
        assert_eq!(read.unwrap(), Samples::U8(vec![0, 10, 1, 11, 2, 12]));
        let short = |range: Range<usize>| Ok(range.map(|z| vec![z as u8]).collect());
        let error = read_pile(attempt, &stored, extent, &control, short).unwrap_err();
        assert!(error.to_string().contains("6 bytes expected"), "{error}");
        let fails = |_: Range<usize>| Err(attempt.bad_input("page 1", "it is broken", "mend it"));
        let error = read_pile(attempt, &stored, extent, &control, fails).unwrap_err();
        assert!(error.to_string().contains("it is broken"), "{error}");
    }
}
