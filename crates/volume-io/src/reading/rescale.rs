//! Rescaling of stored numbers to values: slope and intercept.

use super::LoadError;
use super::samples::{ReadFault, alloc_with_capacity};
use chiaroscuro_volume::{
    CancelToken, FiniteRange, LoadContext, PIECE_VALUES, Samples, VoxelType, human_bytes, with_samples,
};

/// Rescales values. They stay integers where that is exact. Numbers of equal size are converted in place, others into
/// new memory.
///
/// # Errors
/// `Limit` where both buffers together exceed `budget_bytes`, or memory is exhausted.
pub(crate) fn rescale(
    context: LoadContext<'_>,
    samples: Samples,
    [slope, intercept]: [f64; 2],
    budget_bytes: u64,
) -> Result<Samples, LoadError> {
    let is_said = slope.is_finite() && intercept.is_finite() && slope != 0.0;
    if !is_said || (slope, intercept) == (1.0, 0.0) {
        return Ok(samples);
    }
    let voxel_type = rescaled_type(&samples, slope, intercept);
    let bytes_of = |voxel_type: VoxelType| (samples.len() as u64).saturating_mul(voxel_type.bytes() as u64);
    let (before, after) = (samples.voxel_type(), voxel_type);
    let needed = if before.bytes() == after.bytes() {
        bytes_of(after)
    } else {
        bytes_of(before).saturating_add(bytes_of(after))
    };
    let too_large = || {
        context.limit_error(
            "slope and intercept",
            format!(
                "converting the {} values to {} needs {}, {} are allowed",
                before.name(),
                after.name(),
                human_bytes(needed.into()),
                human_bytes(budget_bytes.into())
            ),
            "close other programs, or load a smaller or cropped volume",
        )
    };
    if needed > budget_bytes {
        return Err(too_large());
    }
    convert(samples, voxel_type, |value| value.mul_add(slope, intercept)).map_err(|_no_memory| too_large())
}

/// Type of the rescaled values: the smallest integer type that holds all of them exactly, else floating point.
fn rescaled_type(samples: &Samples, slope: f64, intercept: f64) -> VoxelType {
    let is_integer = !matches!(samples, Samples::F32(_) | Samples::F64(_));
    let is_wide = matches!(samples, Samples::U32(_) | Samples::I32(_) | Samples::F64(_));
    if is_integer
        && slope.fract() == 0.0
        && intercept.fract() == 0.0
        && let Some(FiniteRange { range, .. }) = samples.finite_range()
    {
        let ends = [range.low, range.high].map(|value| value.mul_add(slope, intercept));
        let holds = |low: f64, high: f64| ends.iter().all(|end| (low..=high).contains(end));
        if holds(0.0, 255.0) {
            return VoxelType::U8;
        } else if holds(f64::from(i16::MIN), f64::from(i16::MAX)) {
            return VoxelType::I16;
        } else if holds(0.0, f64::from(u16::MAX)) {
            return VoxelType::U16;
        } else if holds(f64::from(i32::MIN), f64::from(i32::MAX)) {
            return VoxelType::I32;
        }
    }
    if is_wide { VoxelType::F64 } else { VoxelType::F32 }
}

/// Number type that values are cast to.
trait Cast {
    fn cast_from(value: f64) -> Self;
}

macro_rules! cast {
    ($($type:ty),+) => { $(
        impl Cast for $type {
            fn cast_from(value: f64) -> Self {
                value as Self
            }
        }
    )+ };
}
cast!(u8, i8, u16, i16, u32, i32, f32);

impl Cast for f64 {
    fn cast_from(value: f64) -> Self {
        value
    }
}

/// Converts values to another number type, applying `value` to each.
#[expect(trivial_numeric_casts, reason = "one of the eight types is f64 already")]
fn convert(
    samples: Samples,
    voxel_type: VoxelType,
    value: impl Fn(f64) -> f64,
) -> Result<Samples, ReadFault> {
    macro_rules! in_type {
        ($($variant:ident),+) => {
            match voxel_type {
                $(VoxelType::$variant => with_samples!(samples, values => map_values(values, |number| {
                    Cast::cast_from(value(number as f64))
                }))
                .map(Samples::$variant),)+
            }
        };
    }
    in_type!(U8, I8, U16, I16, U32, I32, F32, F64)
}

/// Maps values one by one, in place where the sizes of the types are equal.
fn map_values<T: Copy, R>(values: Vec<T>, value: impl Fn(T) -> R) -> Result<Vec<R>, ReadFault> {
    if size_of::<T>() == size_of::<R>() {
        // Collecting reuses the allocation.
        return Ok(values.into_iter().map(value).collect());
    }
    let mut others = alloc_with_capacity(values.len())?;
    let interrupt = CancelToken::current();
    for piece in values.chunks(PIECE_VALUES) {
        if interrupt.should_stop() {
            break;
        }
        others.extend(piece.iter().map(|&number| value(number)));
    }
    Ok(others)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use chiaroscuro_volume::LoadErrorKind;

    fn tried(samples: Samples, scale: [f64; 2], budget: u64) -> Result<Samples, LoadErrorKind> {
        let context = LoadContext { operation: "test", path: Path::new("t") };
        rescale(context, samples, scale, budget).map_err(|error| error.kind())
    }

    #[test]
    fn values_are_rescaled_and_stay_whole_where_they_can() {
        let bytes = Samples::U8(vec![0, 200]);
        let done = |samples: &Samples, scale| tried(samples.clone(), scale, u64::MAX).unwrap();
        assert_eq!(done(&bytes, [1.0, -1024.0]), Samples::I16(vec![-1024, -824]));
        assert_eq!(done(&bytes, [0.5, 0.0]), Samples::F32(vec![0.0, 100.0]));
        for scale in [[1.0, 0.0], [0.0, 5.0], [f64::NAN, 0.0], [2.0, f64::INFINITY]] {
            assert_eq!(done(&bytes, scale), bytes, "{scale:?}");
        }
        let words = Samples::U16(vec![0, 65535]);
        assert_eq!(done(&words, [1.0, -32768.0]), Samples::I16(vec![-32768, 32767]));
        assert_eq!(done(&Samples::I32(vec![3, -4]), [0.5, 1.0]), Samples::F64(vec![2.5, -1.0]));
    }

    #[test]
    fn new_buffers_count_against_budget() {
        let bytes = Samples::U8(vec![7; 100]);
        // A hundred bytes, and a hundred floats.
        assert_eq!(tried(bytes.clone(), [0.5, 0.0], 499), Err(LoadErrorKind::Limit));
        assert_eq!(tried(bytes.clone(), [0.5, 0.0], 500), Ok(Samples::F32(vec![3.5; 100])));
        assert_eq!(tried(bytes, [1.0, 0.0], 0), Ok(Samples::U8(vec![7; 100])), "nothing is made");
        let words = Samples::U16(vec![7; 100]);
        assert_eq!(tried(words.clone(), [1.0, -9.0], 199), Err(LoadErrorKind::Limit));
        assert_eq!(tried(words, [1.0, -9.0], 200), Ok(Samples::I16(vec![-2; 100])), "in their place");
    }

    #[test]
    fn equal_sizes_convert_in_place() {
        let words: Vec<u16> = (0..1000).collect();
        let at = words.as_ptr() as usize;
        let Ok(Samples::I16(others)) = tried(Samples::U16(words), [1.0, -9.0], u64::MAX) else {
            panic!("they fit");
        };
        assert_eq!(others.as_ptr() as usize, at);
    }
}
