//! Samples: voxel values as stored in files, in any number type.

use std::ops::RangeInclusive;

use crate::ValueRange;
use crate::cancellation::{CancelToken, PIECE_VALUES};

/// Number type of a voxel.
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
    /// All types, in the order of their declaration.
    pub const ALL: [Self; 8] =
        [Self::U8, Self::I8, Self::U16, Self::I16, Self::U32, Self::I32, Self::F32, Self::F64];

    /// Returns the size of one voxel in bytes.
    pub const fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Returns the smallest and the largest integer of the type; `None` for floating-point types.
    const fn integer_range(self) -> Option<RangeInclusive<i64>> {
        match self {
            Self::U8 => Some(0..=u8::MAX as i64),
            Self::I8 => Some(i8::MIN as i64..=i8::MAX as i64),
            Self::U16 => Some(0..=u16::MAX as i64),
            Self::I16 => Some(i16::MIN as i64..=i16::MAX as i64),
            Self::U32 => Some(0..=u32::MAX as i64),
            Self::I32 => Some(i32::MIN as i64..=i32::MAX as i64),
            Self::F32 | Self::F64 => None,
        }
    }

    /// Returns the smallest type that holds the values of both types exactly.
    pub fn common_type(self, other: Self) -> Self {
        if self == other {
            return self;
        }
        let (Some(one), Some(another)) = (self.integer_range(), other.integer_range()) else {
            // Integers of up to 16 bits are exact in F32.
            let is_exact = |of: Self| of == Self::F32 || (of != Self::F64 && of.bytes() <= 2);
            return if is_exact(self) && is_exact(other) { Self::F32 } else { Self::F64 };
        };
        let holds = |of: &Self| {
            of.integer_range().is_some_and(|range| {
                range.start() <= one.start().min(another.start())
                    && one.end().max(another.end()) <= range.end()
            })
        };
        Self::ALL.into_iter().find(holds).unwrap_or(Self::F64)
    }

    /// Returns the name used in file names and on the command line: `uint8` … `float64`.
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

/// Voxel values as the file stores them, x fastest, z slowest.
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

/// Evaluates `$body` with `$values` bound to the vector inside, whatever its type.
#[macro_export]
macro_rules! with_samples {
    ($samples:expr, $values:ident => $body:expr) => {
        match $samples {
            $crate::Samples::U8($values) => $body,
            $crate::Samples::I8($values) => $body,
            $crate::Samples::U16($values) => $body,
            $crate::Samples::I16($values) => $body,
            $crate::Samples::U32($values) => $body,
            $crate::Samples::I32($values) => $body,
            $crate::Samples::F32($values) => $body,
            $crate::Samples::F64($values) => $body,
        }
    };
}

pub(crate) use with_samples;

/// Iterates over pieces of values until the task is cancelled.
fn chunks_until_cancelled<T>(values: &[T]) -> impl Iterator<Item = &[T]> {
    let interrupt = CancelToken::current();
    values.chunks(PIECE_VALUES).take_while(move |_| !interrupt.should_stop())
}

/// Range of the finite values among samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FiniteRange {
    /// Smallest and largest of these values.
    pub range: ValueRange,
    /// Number of voxels whose values are not finite.
    pub non_finite_voxels: usize,
}

impl Samples {
    /// Returns the number of voxels.
    pub fn len(&self) -> usize {
        with_samples!(self, values => values.len())
    }

    /// Returns true if there are no voxels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number type of the values.
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

    /// Returns one value in data units.
    #[expect(
        trivial_numeric_casts,
        clippy::unnecessary_cast,
        reason = "one of the eight types is f64 already"
    )]
    pub fn value(&self, voxel: usize) -> f64 {
        with_samples!(self, values => values[voxel] as f64)
    }

    /// Gathers the values of the voxels at the given indices.
    pub(crate) fn gather(&self, voxels: &[usize]) -> Self {
        macro_rules! picked {
            ($($variant:ident),+) => {
                match self {
                    $(Self::$variant(values) => Self::$variant(voxels.iter().map(|&voxel| values[voxel]).collect()),)+
                }
            };
        }
        picked!(U8, I8, U16, I16, U32, I32, F32, F64)
    }

    /// Converts the values to a type that holds them, reserving capacity for `count`; `None` if memory is short.
    pub fn converted_to(&self, voxel_type: VoxelType, count: usize) -> Option<Self> {
        macro_rules! in_type {
            ($($variant:ident),+) => {
                match voxel_type {
                    $(VoxelType::$variant => {
                        let mut values = Vec::new();
                        values.try_reserve_exact(count).ok()?;
                        Self::$variant(values)
                    })+
                }
            };
        }
        let mut found = in_type!(U8, I8, U16, I16, U32, I32, F32, F64);
        found.append(self);
        Some(found)
    }

    /// Appends values, which must be in the range of this number type.
    #[expect(trivial_numeric_casts, reason = "one of the types is the same")]
    pub fn append(&mut self, more: &Self) {
        with_samples!(self, values => {
            with_samples!(more, more => for &value in more {
                values.push(value as _);
            });
        });
    }

    /// Returns the range of the finite values; `None` if none is finite.
    pub fn finite_range(&self) -> Option<FiniteRange> {
        self.finite_range_except(f64::NAN)
    }

    /// Returns the range of the finite values other than `left_out`; `None` if there are no such values.
    pub(crate) fn finite_range_except(&self, left_out: f64) -> Option<FiniteRange> {
        #[expect(
            trivial_numeric_casts,
            clippy::unnecessary_cast,
            reason = "one of the eight types is f64 already"
        )]
        let (low, high, non_finite) = with_samples!(self, values => chunks_until_cancelled(values).flatten().fold(
            (f64::INFINITY, f64::NEG_INFINITY, 0),
            |(low, high, non_finite), &value| {
                let value = value as f64;
                if !value.is_finite() {
                    (low, high, non_finite + 1)
                } else if value == left_out {
                    (low, high, non_finite)
                } else {
                    (low.min(value), high.max(value), non_finite)
                }
            },
        ));
        (low <= high)
            .then(|| FiniteRange { range: ValueRange::new(low, high), non_finite_voxels: non_finite })
    }

    /// Returns a 64-bit fingerprint of the values (FNV-1a over whole values: an identity, not a checksum).
    pub(crate) fn fingerprint(&self) -> u64 {
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        #[expect(
            trivial_numeric_casts,
            clippy::unnecessary_cast,
            reason = "one of the eight types is f64 already"
        )]
        let hash = with_samples!(self, values => chunks_until_cancelled(values).flatten().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &value| {
            (hash ^ (value as f64).to_bits()).wrapping_mul(PRIME)
        }));
        hash
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_two_types_are_held_by_a_third() {
        use VoxelType::{F32, F64, I8, I16, I32, U8, U16, U32};
        for (one, other, both) in [
            (U8, U8, U8),
            (U8, I16, I16),
            (I16, U16, I32),
            (U32, I8, F64),
            (I32, U32, F64),
            (U16, F32, F32),
            (I32, F32, F64),
            (F32, F64, F64),
        ] {
            assert_eq!((one.common_type(other), other.common_type(one)), (both, both), "{one:?} {other:?}");
        }
        let mut samples = Samples::U8(vec![1, 255]).converted_to(I16, 4).unwrap();
        samples.append(&Samples::I16(vec![-3, 7]));
        assert_eq!(samples, Samples::I16(vec![1, 255, -3, 7]));
    }
}
