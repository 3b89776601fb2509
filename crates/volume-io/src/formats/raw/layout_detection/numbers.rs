//! Decoding of bytes as numbers of any type and byte order.

use crate::Endian;
use chiaroscuro_volume::VoxelType;

/// Evaluates an expression with an iterator over the decoded numbers; compiles one loop for each type and byte order.
macro_rules! with_numbers {
    ($bytes:expr, $voxel_type:expr, $endian:expr, $numbers:ident => $body:expr) => {{
        macro_rules! in_order {
            ($number:ty, $from:ident) => {{
                let raw = $bytes.as_chunks::<{ size_of::<$number>() }>().0.iter();
                let $numbers = raw.map(|&raw| f64::from(<$number>::$from(raw)));
                $body
            }};
        }
        macro_rules! of_type {
            ($number:ty) => {
                match $endian {
                    Endian::Little => in_order!($number, from_le_bytes),
                    Endian::Big => in_order!($number, from_be_bytes),
                }
            };
        }
        match $voxel_type {
            VoxelType::U8 => of_type!(u8),
            VoxelType::I8 => of_type!(i8),
            VoxelType::U16 => of_type!(u16),
            VoxelType::I16 => of_type!(i16),
            VoxelType::U32 => of_type!(u32),
            VoxelType::I32 => of_type!(i32),
            VoxelType::F32 => of_type!(f32),
            VoxelType::F64 => of_type!(f64),
        }
    }};
}

pub(super) use with_numbers;

/// Calls `give` with each number in turn.
pub(crate) fn for_each_value(bytes: &[u8], voxel_type: VoxelType, endian: Endian, mut give: impl FnMut(f64)) {
    with_numbers!(bytes, voxel_type, endian, numbers => numbers.for_each(&mut give));
}
