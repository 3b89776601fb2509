//! The values of voxels as files have them, in any number type.

use rayon::prelude::*;

use crate::data::ValueRange;

/// Voxels that a task looks at: enough for starting it to cost nothing.
const CHUNK: usize = 1 << 16;

/// Ends and voxels without a value, before any is known.
const NOTHING: (f64, f64, usize) = (f64::INFINITY, f64::NEG_INFINITY, 0);

/// The number types that a voxel can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it all")]
pub enum VoxelType {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    F32,
    F64,
}

impl VoxelType {
    /// Every type, in the order of the declaration.
    pub const ALL: [Self; 8] =
        [Self::U8, Self::I8, Self::U16, Self::I16, Self::U32, Self::I32, Self::F32, Self::F64];

    /// Size of one voxel in bytes.
    pub const fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The name used in file names and on the command line: `uint8` … `float64`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::U8 => "uint8",
            Self::I8 => "int8",
            Self::U16 => "uint16",
            Self::I16 => "int16",
            Self::U32 => "uint32",
            Self::I32 => "int32",
            Self::F32 => "float32",
            Self::F64 => "float64",
        }
    }
}

/// The voxels' values as the file has them, x fastest, z slowest.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "one variant per voxel type")]
pub enum Samples {
    U8(Vec<u8>),
    I8(Vec<i8>),
    U16(Vec<u16>),
    I16(Vec<i16>),
    U32(Vec<u32>),
    I32(Vec<i32>),
    F32(Vec<f32>),
    F64(Vec<f64>),
}

/// Calls `$body` with `$values` bound to the vector inside, whatever its type.
macro_rules! with_samples {
    ($samples:expr, $values:ident => $body:expr) => {
        match $samples {
            Samples::U8($values) => $body,
            Samples::I8($values) => $body,
            Samples::U16($values) => $body,
            Samples::I16($values) => $body,
            Samples::U32($values) => $body,
            Samples::I32($values) => $body,
            Samples::F32($values) => $body,
            Samples::F64($values) => $body,
        }
    };
}

pub(in crate::data) use with_samples;

impl Samples {
    /// Number of voxels.
    pub fn len(&self) -> usize {
        with_samples!(self, values => values.len())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number type.
    pub fn voxel_type(&self) -> VoxelType {
        match self {
            Self::U8(_) => VoxelType::U8,
            Self::I8(_) => VoxelType::I8,
            Self::U16(_) => VoxelType::U16,
            Self::I16(_) => VoxelType::I16,
            Self::U32(_) => VoxelType::U32,
            Self::I32(_) => VoxelType::I32,
            Self::F32(_) => VoxelType::F32,
            Self::F64(_) => VoxelType::F64,
        }
    }

    /// One value in data units.
    #[expect(
        trivial_numeric_casts,
        clippy::unnecessary_cast,
        reason = "one of the eight types is f64 already"
    )]
    pub fn value(&self, voxel: usize) -> f64 {
        with_samples!(self, values => values[voxel] as f64)
    }

    /// The values of some voxels.
    pub(in crate::data) fn picked(&self, voxels: &[usize]) -> Self {
        macro_rules! picked {
            ($($variant:ident),+) => {
                match self {
                    $(Self::$variant(values) => Self::$variant(voxels.iter().map(|&voxel| values[voxel]).collect()),)+
                }
            };
        }
        picked!(U8, I8, U16, I16, U32, I32, F32, F64)
    }

    /// What the finite values span, and how many voxels are not finite; `None` where none is finite.
    pub(in crate::data) fn finite_range(&self) -> Option<(ValueRange, usize)> {
        self.range_without(f64::NAN)
    }

    /// What the finite values span that are not `left_out`, and how many voxels are not finite; `None` where there are
    /// none.
    #[expect(
        trivial_numeric_casts,
        clippy::unnecessary_cast,
        reason = "one of the eight types is f64 already"
    )]
    pub(in crate::data) fn range_without(&self, left_out: f64) -> Option<(ValueRange, usize)> {
        macro_rules! of_whole {
            ($values:expr, $type:ty) => {
                $values
                    .par_chunks(CHUNK)
                    .map(|chunk| {
                        let ends = (<$type>::MAX, <$type>::MIN);
                        let (low, high) =
                            chunk.iter().fold(ends, |(low, high), &value| (low.min(value), high.max(value)));
                        (f64::from(low), f64::from(high), 0)
                    })
                    .collect()
            };
        }
        let parts: Vec<(f64, f64, usize)> = match self {
            // The most usual ones; what is whole is finite.
            Self::U8(values) if left_out.is_nan() => of_whole!(values, u8),
            Self::U16(values) if left_out.is_nan() => of_whole!(values, u16),
            Self::I16(values) if left_out.is_nan() => of_whole!(values, i16),
            _ => with_samples!(self, values => values
                .par_chunks(CHUNK)
                .map(|chunk| chunk.iter().fold(NOTHING, |(low, high, non_finite), &value| {
                    let value = value as f64;
                    if !value.is_finite() {
                        (low, high, non_finite + 1)
                    } else if value == left_out {
                        (low, high, non_finite)
                    } else {
                        (low.min(value), high.max(value), non_finite)
                    }
                }))
                .collect()),
        };
        let (low, high, non_finite) = parts.into_iter().fold(
            NOTHING,
            |(low, high, non_finite), (part_low, part_high, part_non_finite)| {
                (low.min(part_low), high.max(part_high), non_finite + part_non_finite)
            },
        );
        (low <= high).then_some((ValueRange::new(low, high), non_finite))
    }

    /// A 64-bit fingerprint of the values (FNV-1a over whole values: an identity, not a checksum).
    pub(in crate::data) fn fingerprint(&self) -> u64 {
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        #[expect(
            trivial_numeric_casts,
            clippy::unnecessary_cast,
            reason = "one of the eight types is f64 already"
        )]
        let hash = with_samples!(self, values => values.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &value| {
            (hash ^ (value as f64).to_bits()).wrapping_mul(PRIME)
        }));
        hash
    }
}
