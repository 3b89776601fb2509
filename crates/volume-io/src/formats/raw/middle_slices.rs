//! Orthogonal slices through the middle of a raw file in a proposed layout, read directly from the file, so that the
//! preview follows changes of the numbers, whatever the size of the file.

use std::io;

use super::bytes::RawBytes;
use super::layout::RawLayout;
use super::layout_detection::for_each_value;
use chiaroscuro_volume::{CancelToken, ValueRange};

/// Maximum number of voxels along the edge of a slice: more than the preview shows.
const MAX_EDGE: usize = 256;

/// Maximum number of bytes that are read at once to pick voxels from; voxels further apart are read one by one.
const MAX_READ_BYTES: usize = 64 << 10;

/// Quantiles of the values that are shown as black and white.
const OUTER_QUANTILES: [f64; 2] = [0.01, 0.99];

/// Slice of the preview, subsampled where it has more voxels than can be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct PreviewSlice {
    /// Voxels along its first and second axis.
    pub size: [usize; 2],
    /// Values, the first axis fastest; `None` beyond the end of the file, and for values that are not finite.
    pub values: Vec<Option<f32>>,
}

/// Orthogonal slices across z, y and x.
#[derive(Debug, Clone, PartialEq)]
pub struct MiddleSlices {
    /// Slices along x and y, x and z, and y and z.
    pub slices: [PreviewSlice; 3],
    /// Indices of the voxel that all three go through, along x, y and z.
    pub at: [usize; 3],
    /// Value range of the slices, without outliers.
    pub range: ValueRange,
}

/// Reads the middle slices; `None` if `cancel` was cancelled meanwhile.
///
/// Where only the beginning of a compressed file is known, the slices are in the middle of that.
///
/// # Errors
/// When the file cannot be read.
pub fn read_middle_slices(
    bytes: &mut RawBytes,
    layout: &RawLayout,
    cancel: &CancelToken,
) -> io::Result<Option<MiddleSlices>> {
    let dims = layout.dims.map(|n| n.max(1));
    let mut at = dims.map(|n| n / 2);
    let voxel_bytes = layout.voxel_type.bytes() as u64;
    let slice_bytes = (dims[0] as u64).saturating_mul(dims[1] as u64).saturating_mul(voxel_bytes);
    let readable = bytes.readable().saturating_sub(layout.offset);
    if bytes.readable() < bytes.length() {
        let slices = readable / slice_bytes.max(1);
        at[2] = at[2].min((slices / 2) as usize);
    }
    let mut reader = VoxelLineReader { bytes, layout, dims, buffer: Vec::new() };
    let mut slices = Vec::with_capacity(3);
    for (u, v) in [(0, 1), (0, 2), (1, 2)] {
        let (across, up) = (evenly_spaced(dims[u]), evenly_spaced(dims[v]));
        let mut values = Vec::with_capacity(across.len() * up.len());
        for &second in &up {
            if cancel.is_cancelled() {
                return Ok(None);
            }
            let mut first = at;
            (first[u], first[v]) = (0, second);
            reader.read_line(first, u, &across, &mut values)?;
        }
        slices.push(PreviewSlice { size: [across.len(), up.len()], values });
    }
    let range = range_of(&slices);
    let found: Result<[PreviewSlice; 3], _> = slices.try_into();
    Ok(found.ok().map(|slices| MiddleSlices { slices, at, range }))
}

/// Evenly spaced indices along an axis of length `n`.
fn evenly_spaced(n: usize) -> Vec<usize> {
    let count = n.min(MAX_EDGE);
    (0..count).map(|at| (at as u128 * n as u128 / count as u128) as usize).collect()
}

struct VoxelLineReader<'a> {
    bytes: &'a mut RawBytes,
    layout: &'a RawLayout,
    dims: [usize; 3],
    buffer: Vec<u8>,
}

impl VoxelLineReader<'_> {
    /// Reads the picked voxels of a line along an axis.
    fn read_line(
        &mut self,
        first: [usize; 3],
        axis: usize,
        picked: &[usize],
        values: &mut Vec<Option<f32>>,
    ) -> io::Result<()> {
        let size = self.layout.voxel_type.bytes() as u64;
        let [x, y] = [self.dims[0] as u64, self.dims[1] as u64];
        let [i, j, k] = first.map(|at| at as u64);
        let rows = k.saturating_mul(y).saturating_add(j);
        let voxel = rows.saturating_mul(x).saturating_add(i);
        let start = voxel.saturating_mul(size).saturating_add(self.layout.offset);
        let step = [1, x, x.saturating_mul(y)][axis].saturating_mul(size);
        let place = |at: usize| start.saturating_add(step.saturating_mul(at as u64));
        let mut from = 0;
        while from < picked.len() {
            // As many as lie within one read.
            let within = |at: &&usize| place(**at) - place(picked[from]) + size <= MAX_READ_BYTES as u64;
            let count = picked[from..].iter().take_while(within).count().max(1);
            let group = &picked[from..from + count];
            let length = place(group[count - 1]) - place(group[0]) + size;
            self.buffer.resize(length as usize, 0);
            let read = self.bytes.read_at(place(group[0]), &mut self.buffer)?;
            for &at in group {
                let begin = (place(at) - place(group[0])) as usize;
                let end = begin + size as usize;
                let mut found = None;
                if end <= read {
                    let (voxel_type, endian) = (self.layout.voxel_type, self.layout.endian);
                    for_each_value(&self.buffer[begin..end], voxel_type, endian, |value| {
                        found = Some(value as f32).filter(|value| value.is_finite());
                    });
                }
                values.push(found);
            }
            from += count;
        }
        Ok(())
    }
}

/// Value range between the outer quantiles; the full range where those are equal.
fn range_of(slices: &[PreviewSlice]) -> ValueRange {
    let mut values: Vec<f32> =
        slices.iter().flat_map(|slice| slice.values.iter().flatten().copied()).collect();
    values.sort_unstable_by(f32::total_cmp);
    let quantile = |share: f64| values.get((share * values.len() as f64) as usize).or(values.last()).copied();
    let [low, high] = OUTER_QUANTILES.map(|share| f64::from(quantile(share).unwrap_or_default()));
    if low < high {
        return ValueRange::new(low, high);
    }
    let [low, high] = [0.0, 1.0].map(|share| f64::from(quantile(share).unwrap_or_default()));
    ValueRange::new(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Endian;
    use chiaroscuro_volume::VoxelType;

    fn layout(dims: [usize; 3]) -> RawLayout {
        RawLayout { dims, voxel_type: VoxelType::U16, spacing_mm: None, endian: Endian::Big, offset: 3 }
    }

    /// Values x + 100 y + 1000 z after a header of three bytes.
    fn file([x, y, z]: [usize; 3]) -> Vec<u8> {
        let value = |at: usize| (at % x + 100 * (at / x % y) + 1000 * (at / x / y)) as u16;
        [7, 7, 7].into_iter().chain((0..x * y * z).flat_map(|at| value(at).to_be_bytes())).collect()
    }

    #[test]
    fn slices_go_through_the_middle_in_three_directions() {
        let dims = [5, 4, 3];
        let mut bytes = RawBytes::from(file(dims));
        let found = read_middle_slices(&mut bytes, &layout(dims), &CancelToken::new()).unwrap().unwrap();
        assert_eq!(found.at, [2, 2, 1]);
        let value = |slice: usize, at: usize| found.slices[slice].values[at];
        assert_eq!(found.slices.clone().map(|slice| slice.size), [[5, 4], [5, 3], [4, 3]]);
        assert_eq!((value(0, 0), value(0, 6)), (Some(1000.0), Some(1101.0)));
        assert_eq!((value(1, 0), value(1, 6)), (Some(200.0), Some(1201.0)));
        assert_eq!((value(2, 0), value(2, 5)), (Some(2.0), Some(1102.0)));
    }

    #[test]
    fn what_is_not_in_the_file_is_missing() {
        let mut bytes = RawBytes::from(file([5, 4, 3]));
        let long = layout([5, 4, 100]);
        let found = read_middle_slices(&mut bytes, &long, &CancelToken::new()).unwrap().unwrap();
        assert!(found.slices[0].values.iter().all(Option::is_none), "the middle lies behind the end");
        assert_eq!(found.slices[1].values.iter().flatten().count(), 5 * 3);
        let endless = layout([usize::MAX; 3]);
        let found = read_middle_slices(&mut bytes, &endless, &CancelToken::new()).unwrap().unwrap();
        assert!(found.slices.iter().all(|slice| slice.values.len() == MAX_EDGE * MAX_EDGE));
        let cancel = CancelToken::new();
        cancel.cancel();
        assert_eq!(read_middle_slices(&mut bytes, &long, &cancel).unwrap(), None);
    }
}
