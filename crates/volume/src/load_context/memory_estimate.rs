//! Memory estimate of a volume, known before any of its voxels is read.

use super::portion::Portion;
use super::resolved_portion::ResolvedPortion;
use crate::VoxelType;

/// Bytes of derived data for each brick of 8³ voxels: bounds of its 64 cells, its own bounds, and its visibility
/// masks.
const BYTES_PER_BRICK: usize = 64 * 2 + 8 + 2 * 8;

/// Number of voxels in a brick.
const VOXELS_PER_BRICK: usize = 8 * 8 * 8;

/// Size of a file's grid and type of its voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VolumeSize {
    /// Number of voxels along x, y, z.
    pub dims: [usize; 3],
    /// Type of the voxels, an upper bound: 64-bit integers may be stored in fewer bytes.
    pub voxel_type: VoxelType,
    /// True if all voxels must be read before any can be dropped.
    pub is_read_whole: bool,
}

impl VolumeSize {
    /// Returns the dimensions of a portion in voxels; `None` if it reaches beyond the grid.
    pub fn portion_dims(&self, portion: &Portion) -> Option<[usize; 3]> {
        ResolvedPortion::resolve(portion, self.dims, false).map(|kept| kept.dims())
    }

    /// Returns the bytes of all voxels of the file.
    pub fn bytes(&self) -> u64 {
        saturating_u64(portion_bytes(&ResolvedPortion::whole_grid(self.dims), self.voxel_type))
    }

    /// Returns the peak bytes of memory while a portion is opened, with its derived data; `None` if it reaches beyond
    /// the grid.
    pub fn peak_bytes(&self, portion: &Portion) -> Option<u64> {
        let wanted = ResolvedPortion::resolve(portion, self.dims, false)?;
        let voxels = if self.is_read_whole {
            needed_bytes(&ResolvedPortion::whole_grid(self.dims), &wanted, self.voxel_type)
        } else {
            let while_read = needed_bytes(&wanted, &wanted, self.voxel_type);
            while_read.min(needed_bytes(&wanted.full_box(), &wanted, self.voxel_type))
        };
        let bricks = wanted.dims().into_iter().fold(1u128, |all, n| all.saturating_mul(n as u128))
            / VOXELS_PER_BRICK as u128;
        Some(saturating_u64(voxels.saturating_add(bricks.saturating_mul(BYTES_PER_BRICK as u128))))
    }
}

fn saturating_u64(bytes: u128) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}

fn portion_bytes(kept: &ResolvedPortion, voxel_type: VoxelType) -> u128 {
    let voxels = kept.dims().into_iter().fold(1u128, |all, n| all.saturating_mul(n as u128));
    voxels.saturating_mul(voxel_type.bytes() as u128)
}

/// Returns the bytes for voxels kept while reading, for voxels derived from them, and for buffers in use at a time.
pub(super) fn needed_bytes(read: &ResolvedPortion, wanted: &ResolvedPortion, voxel_type: VoxelType) -> u128 {
    let kept = portion_bytes(read, voxel_type);
    if read != wanted {
        // Picked voxels are compacted in place, at the front of the voxels that were read.
        return kept.saturating_add(if wanted.is_averaged { portion_bytes(wanted, voxel_type) } else { 0 });
    }
    if !read.is_averaged {
        return kept;
    }
    // Beside the means: one voxel of each block, for the detection of labels; and as many slices as a block is deep,
    // both as stored and converted to numbers of at most 8 bytes.
    let [x, y, _] = read.box_dims();
    let slab = x as u128 * y as u128 * read.stride[2] as u128;
    kept.saturating_mul(2)
        .saturating_add(slab.saturating_mul((voxel_type.bytes() + size_of::<f64>()) as u128))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn portions_take_less() {
        let size = VolumeSize { dims: [80, 80, 80], voxel_type: VoxelType::U16, is_read_whole: false };
        let host = |size: &VolumeSize, portion: Portion| size.peak_bytes(&portion).unwrap();
        assert_eq!(size.bytes(), 1_024_000);
        // The bricks' data of 1000 bricks are added.
        assert_eq!(host(&size, Portion::default()), 1_024_000 + 152_000);
        assert_eq!(host(&size, Portion::with_stride(2)), 128_000 + 19_000);
        // Means, one voxel of each block, and two slices at a time.
        assert_eq!(host(&size, Portion::with_block_average(2)), 2 * 128_000 + 2 * 6400 * 10 + 19_000);
        let whole = VolumeSize { is_read_whole: true, ..size };
        assert_eq!(host(&whole, Portion::with_stride(2)), 1_024_000 + 19_000);
        let outside = Portion { region: "0:81,:,:".parse().ok(), ..Portion::default() };
        assert_eq!((size.peak_bytes(&outside), size.portion_dims(&outside)), (None, None));
        let endless = VolumeSize { dims: [usize::MAX; 3], ..size };
        assert_eq!(host(&endless, Portion::default()), u64::MAX);
    }
}
