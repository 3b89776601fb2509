//! Filter that passes only the selected voxels of a stream with the voxels of a whole grid.

use std::fs::File;
use std::io::{self, BufReader, Read};

use super::LoadControl;
use super::samples::{BLOCK_BYTES, ReadFault, alloc_with_capacity, read_until_full};
use chiaroscuro_volume::ResolvedPortion;

/// Function that skips bytes of a stream without reading them.
pub(crate) type SkipFn<R> = fn(&mut R, u64) -> io::Result<()>;

/// Seeks forward in a file; bytes outside the buffer are not read.
pub(crate) fn skip_in_file(reader: &mut BufReader<File>, count: u64) -> io::Result<()> {
    let mut left = count;
    while left > 0 {
        let step = left.min(i64::MAX as u64);
        reader.seek_relative(step as i64)?;
        left -= step;
    }
    Ok(())
}

/// Reader that yields only the selected voxels. At its end the stream is positioned after the last voxel of the grid.
pub(super) struct VoxelFilter<'a, R> {
    reader: &'a mut R,
    /// Function to skip bytes, where the stream can seek.
    skip: Option<SkipFn<R>>,
    control: &'a LoadControl,
    selection: ResolvedPortion,
    /// Bytes per voxel in the stream.
    size: usize,
    /// Bytes to hand out; the first `handed_out` have been handed out already.
    ready: Vec<u8>,
    handed_out: usize,
    /// Position of the next selected voxels of the grid, along x, y and z.
    next: [usize; 3],
    /// Position in the stream, in bytes.
    position: u64,
    /// Buffer for bytes that are discarded.
    discarded: Vec<u8>,
    /// Error that ended the stream, since [`Read`] can only return [`io::Error`].
    pub(super) fault: Option<ReadFault>,
}

impl<'a, R: Read> VoxelFilter<'a, R> {
    /// Creates a filter for voxels of `size` bytes.
    pub(super) fn new(
        reader: &'a mut R,
        skip_fn: Option<SkipFn<R>>,
        kept: ResolvedPortion,
        size: usize,
        control: &'a LoadControl,
    ) -> Self {
        let (ready, scrap, next) = (Vec::new(), Vec::new(), kept.low);
        Self {
            reader,
            skip: skip_fn,
            control,
            selection: kept,
            size,
            ready,
            handed_out: 0,
            next,
            position: 0,
            discarded: scrap,
            fault: None,
        }
    }

    /// Number of whole voxels of the stream before its position.
    pub(super) fn voxels_consumed(&self) -> u64 {
        self.position / self.size as u64
    }

    /// Moves to byte `at` of the stream; returns false if the stream ends before that.
    fn go_to(&mut self, at: u64) -> Result<bool, ReadFault> {
        let mut left = at.saturating_sub(self.position);
        if let Some(skip_fn) = self.skip {
            self.control.check().map_err(ReadFault::Stopped)?;
            skip_fn(self.reader, left).map_err(ReadFault::Io)?;
            self.position += left;
            return Ok(true);
        }
        while left > 0 {
            let want = usize::try_from(left).map_or(BLOCK_BYTES, |left| left.min(BLOCK_BYTES));
            if self.discarded.len() < want {
                self.discarded.resize(want, 0);
            }
            let got = read_until_full(self.reader, &mut self.discarded[..want], self.control)?;
            self.position += got as u64;
            left -= got as u64;
            if got < want {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Reads the next run of selected voxels in a row, at most a block; returns false if there are none.
    fn read_next(&mut self) -> Result<bool, ReadFault> {
        let ResolvedPortion { grid: [nx, ny, nz], low, high, stride: step, .. } = self.selection;
        let of_voxels = |voxels: u64| voxels.saturating_mul(self.size as u64);
        let [x, y, z] = self.next;
        self.handed_out = 0;
        self.ready.clear();
        if z >= high[2] {
            self.go_to(of_voxels(nx as u64 * ny as u64 * nz as u64))?;
            return Ok(false);
        }
        let place = (z as u64 * ny as u64 + y as u64) * nx as u64 + x as u64;
        let at_once = (BLOCK_BYTES / self.size / step[0] * step[0]).max(step[0]);
        let voxels = at_once.min(high[0] - x);
        if !self.go_to(of_voxels(place))? {
            return Ok(false);
        }
        // Up to the last selected voxel, without the gap before the next run.
        let wanted = ((voxels - 1) / step[0] * step[0] + 1) * self.size;
        if self.ready.capacity() < wanted {
            self.ready = alloc_with_capacity(wanted)?;
        }
        self.ready.resize(wanted, 0);
        let got = read_until_full(self.reader, &mut self.ready, self.control)?;
        self.position += got as u64;
        let size = self.size;
        let mut kept = 0;
        for voxel in (0..got / size).step_by(step[0]) {
            self.ready.copy_within(voxel * size..(voxel + 1) * size, kept);
            kept += size;
        }
        self.ready.truncate(kept);
        self.next = if got < wanted {
            [x, y, high[2]]
        } else if x + voxels < high[0] {
            [x + voxels, y, z]
        } else if y + step[1] < high[1] {
            [low[0], y + step[1], z]
        } else {
            [low[0], low[1], z + step[2]]
        };
        Ok(kept > 0)
    }
}

impl<R: Read> Read for VoxelFilter<'_, R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.handed_out == self.ready.len() {
            match self.read_next() {
                Ok(true) => {}
                Ok(false) => return Ok(0),
                Err(fault) => {
                    self.fault = Some(fault);
                    return Err(io::Error::other("the voxels cannot be read"));
                }
            }
        }
        let count = out.len().min(self.ready.len() - self.handed_out);
        out[..count].copy_from_slice(&self.ready[self.handed_out..self.handed_out + count]);
        self.handed_out += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chiaroscuro_volume::Portion;

    /// Grid of 5 × 4 × 3 voxels of two bytes, the first of which is the voxel's index, followed by three other bytes.
    fn bytes() -> Vec<u8> {
        (0..60).flat_map(|voxel| [voxel, 100]).chain([7, 7, 7]).collect()
    }

    fn sieved<'a>(bytes: &'a [u8], portion: &Portion, skip_fn: Option<SkipFn<&'a [u8]>>) -> (Vec<u8>, usize) {
        let kept = ResolvedPortion::resolve(portion, [5, 4, 3], false).unwrap();
        let control = LoadControl::new();
        let mut rest = bytes;
        let mut found = Vec::new();
        VoxelFilter::new(&mut rest, skip_fn, kept, 2, &control).read_to_end(&mut found).unwrap();
        (found.chunks(2).map(|voxel| voxel[0]).collect(), rest.len())
    }

    #[test]
    fn selected_voxels_are_read_and_stream_ends_after_grid() {
        let skip_fn: SkipFn<&[u8]> = |rest, count| {
            *rest = &rest[count as usize..];
            Ok(())
        };
        let every = Portion::with_stride(2);
        let kept = vec![0, 2, 4, 10, 12, 14, 40, 42, 44, 50, 52, 54];
        assert_eq!(sieved(&bytes(), &every, None), (kept.clone(), 3));
        assert_eq!(sieved(&bytes(), &every, Some(skip_fn)), (kept, 3));
        let region = Portion { region: "1:3,2:4,1:2".parse().ok(), ..Portion::default() };
        assert_eq!(sieved(&bytes(), &region, None), (vec![31, 32, 36, 37], 3));
        assert_eq!(sieved(&bytes(), &Portion { region: region.region, ..every }, None), (vec![31], 3));
        assert_eq!(sieved(&bytes()[..43], &every, None).0, [0, 2, 4, 10, 12, 14], "the rest is not there");
        assert_eq!(
            sieved(&bytes()[..85], &every, None).0.len(),
            7,
            "cut off within a row, and within a voxel"
        );
    }

    #[test]
    fn rows_longer_than_a_block_come_in_pieces() {
        let long = 3 * BLOCK_BYTES + 5;
        let bytes: Vec<u8> = (0..2 * long).map(|at| (at % 251) as u8).collect();
        let kept = ResolvedPortion::resolve(&Portion::with_stride(3), [long, 2, 1], false).unwrap();
        let control = LoadControl::new();
        let mut found = Vec::new();
        VoxelFilter::new(&mut &bytes[..], None, kept, 1, &control).read_to_end(&mut found).unwrap();
        let expected: Vec<u8> = bytes[..long].iter().step_by(3).copied().collect();
        assert!(found == expected);
    }

    #[test]
    fn cancellation_is_reported() {
        let control = LoadControl::new();
        control.cancel();
        let kept = ResolvedPortion::resolve(&Portion::with_stride(2), [5, 4, 3], false).unwrap();
        let bytes = bytes();
        let mut rest = &bytes[..];
        let mut sieve = VoxelFilter::new(&mut rest, None, kept, 2, &control);
        assert!(sieve.read(&mut [0; 8]).is_err());
        assert!(matches!(sieve.fault, Some(ReadFault::Stopped(_))));
    }
}
