//! Rescaling of a volume's values, in a number type that can hold them.

use super::ValueScale;
use crate::values::samples::with_samples;
use crate::{Samples, ValueMetadata, ValueRange, VolumeError};

/// Defines `whole` over the integer types; other scaled values become floating-point numbers.
macro_rules! narrowest {
    ($($variant:ident: $type:ty),+) => {
        /// Converts scaled values to the first of these integer types that holds them all; `None` if none does.
        #[expect(trivial_numeric_casts, reason = "one of the eight types is f64 already")]
        fn whole(
            samples: &Samples,
            scale: ValueScale,
            range: ValueRange,
            budget_bytes: u64,
        ) -> Result<Option<Samples>, VolumeError> {
            $(
                if range.low >= f64::from(<$type>::MIN) && range.high <= f64::from(<$type>::MAX) {
                    let values = with_samples!(samples, values => try_map_values(values, budget_bytes, |&number| {
                        scale.value_from_number(number as f64) as $type
                    }))?;
                    return Ok(Some(Samples::$variant(values)));
                }
            )+
            Ok(None)
        }
    };
}

narrowest!(U8: u8, I8: i8, U16: u16, I16: i16, U32: u32, I32: i32);

/// Maps each value, if the result takes at most `budget_bytes` and the memory can be allocated.
fn try_map_values<T, R>(
    values: &[T],
    budget_bytes: u64,
    value: impl Fn(&T) -> R,
) -> Result<Vec<R>, VolumeError> {
    let mut scaled = Vec::new();
    let bytes = (values.len() as u64).saturating_mul(size_of::<R>() as u64);
    if bytes > budget_bytes {
        return Err(VolumeError::NoMemory { bytes });
    }
    scaled.try_reserve_exact(values.len()).map_err(|_full| VolumeError::NoMemory { bytes })?;
    scaled.extend(values.iter().map(value));
    Ok(scaled)
}

/// Applies a scale to all values: integers stay integers if slope and intercept are. The result may take
/// `budget_bytes` beside the numbers: 32-bit floats are four times as long as bytes.
#[expect(trivial_numeric_casts, clippy::unnecessary_cast, reason = "one of the eight types is f64 already")]
pub(super) fn rescaled(
    samples: &Samples,
    scale: ValueScale,
    budget_bytes: u64,
) -> Result<Samples, VolumeError> {
    let numbers = samples.finite_range().ok_or(VolumeError::NothingFinite)?.range;
    let ends = [numbers.low, numbers.high].map(|number| scale.value_from_number(number));
    let range = ValueRange::new(ends[0].min(ends[1]), ends[0].max(ends[1]));
    let has_point = matches!(samples, Samples::F32(_) | Samples::F64(_));
    if !has_point
        && scale.slope.fract() == 0.0
        && scale.intercept.fract() == 0.0
        && let Some(whole) = whole(samples, scale, range, budget_bytes)?
    {
        return Ok(whole);
    }
    // 32-bit floats hold every integer of 16 bits exactly, and they are the type of float files.
    let is_short = !matches!(samples, Samples::U32(_) | Samples::I32(_) | Samples::F64(_));
    if is_short && range.low.abs().max(range.high.abs()) < f64::from(f32::MAX) {
        let value = |number: f64| scale.value_from_number(number) as f32;
        return with_samples!(samples, values => try_map_values(values, budget_bytes, |&number| value(number as f64)))
            .map(Samples::F32);
    }
    with_samples!(samples, values => try_map_values(values, budget_bytes, |&number| scale.value_from_number(number as f64)))
        .map(Samples::F64)
}

/// Applies a scale to the metadata: padding value, display window and labels.
pub(super) fn rescaled_metadata(hints: &ValueMetadata, scale: ValueScale) -> ValueMetadata {
    let mut scaled = hints.clone();
    scaled.padding = hints.padding.map(|number| scale.value_from_number(number));
    if let Some([low, high]) = hints.window {
        let [a, b] = [low, high].map(|number| scale.value_from_number(number));
        scaled.window = Some([a.min(b), a.max(b)]);
    }
    scaled.labels = crate::FileLabelTable::default();
    for (number, label) in hints.labels.iter() {
        let value = scale.value_from_number(number as f64);
        if value.fract() == 0.0 && value.abs() < (1_i64 << 53) as f64 {
            scaled.labels.insert(value as i64, &label.name, label.color);
        }
    }
    scaled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_made_where_there_is_room_for_them() {
        let numbers = Samples::U8(vec![0, 7, 200]);
        let halves = ValueScale { slope: 0.5, intercept: 0.0 };
        let floats = Samples::F32(vec![0.0, 3.5, 100.0]);
        assert_eq!(rescaled(&numbers, halves, 12), Ok(floats));
        assert_eq!(rescaled(&numbers, halves, 11), Err(VolumeError::NoMemory { bytes: 12 }));
        let below = ValueScale { slope: 1.0, intercept: -300.0 };
        assert_eq!(rescaled(&numbers, below, 6), Ok(Samples::I16(vec![-300, -293, -100])));
        assert_eq!(rescaled(&numbers, below, 5), Err(VolumeError::NoMemory { bytes: 6 }));
    }
}
