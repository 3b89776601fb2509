//! Conversion between the bytes of slices and samples, and averaging of slices.

use rayon::prelude::*;

use chiaroscuro_volume::{BlockPartition, Samples, VoxelType, with_samples};

/// Decodes little-endian numbers.
fn decode(bytes: &[u8], voxel_type: VoxelType) -> Samples {
    macro_rules! decoded {
        ($variant:ident, $number:ty) => {{
            let (numbers, _) = bytes.as_chunks::<{ size_of::<$number>() }>();
            Samples::$variant(numbers.iter().map(|bytes| <$number>::from_le_bytes(*bytes)).collect())
        }};
    }
    match voxel_type {
        VoxelType::U8 => Samples::U8(bytes.to_vec()),
        VoxelType::I8 => decoded!(I8, i8),
        VoxelType::U16 => decoded!(U16, u16),
        VoxelType::I16 => decoded!(I16, i16),
        VoxelType::U32 => decoded!(U32, u32),
        VoxelType::I32 => decoded!(I32, i32),
        VoxelType::F32 => decoded!(F32, f32),
        VoxelType::F64 => decoded!(F64, f64),
    }
}

/// Encodes numbers as little-endian bytes.
fn encode(samples: &Samples) -> Vec<u8> {
    with_samples!(samples, values => values.iter().flat_map(|value| value.to_le_bytes()).collect())
}

/// Averager of whole slices to those of a coarser level.
#[derive(Debug, Clone, Copy)]
pub(super) struct SliceAverager {
    pub(super) voxel_type: VoxelType,
    /// Voxels of a slice along x and y.
    pub(super) slice_dims: [usize; 2],
    /// Voxels of a block along x, y, z.
    pub(super) block: [usize; 3],
    /// Number that is left out of means.
    pub(super) padding: Option<f64>,
    /// True if blocks have their most frequent number.
    pub(super) has_label_numbers: bool,
}

impl SliceAverager {
    /// Averages slices, from the first of a block; the last block may be incomplete.
    pub(super) fn average(&self, slices: &[u8]) -> Vec<u8> {
        let [width, height] = self.slice_dims;
        let slice_bytes = width * height * self.voxel_type.bytes();
        let average = |slices: &[u8]| {
            let dims = [width, height, slices.len() / slice_bytes];
            let partition = BlockPartition { dims, block: self.block, padding: self.padding };
            encode(&partition.average(&decode(slices, self.voxel_type), self.has_label_numbers))
        };
        let parts: Vec<Vec<u8>> = slices.par_chunks(slice_bytes * self.block[2]).map(average).collect();
        parts.concat()
    }
}
