//! Values as a file means them: those that it holds times a slope, and an intercept added.

use bytemuck::Pod;
use rayon::prelude::*;

use crate::data::Samples;
use crate::data::values::samples::with_samples;

/// Voxels that a task makes: enough for starting it to cost nothing.
const CHUNK: usize = 1 << 16;

/// Whole numbers up to here (2⁵²) are themselves, and not the nearest that there is.
const MOST_EXACT: f64 = 4_503_599_627_370_496.0;

/// Values times a slope, and an intercept added, on all cores. They stay whole numbers where that is exact.
pub(in crate::data::load) fn rescaled(samples: Samples, slope: f64, intercept: f64) -> Samples {
    let is_said = slope.is_finite() && intercept.is_finite() && slope != 0.0;
    if !is_said || (slope, intercept) == (1.0, 0.0) {
        return samples;
    }
    let is_integer = !matches!(samples, Samples::F32(_) | Samples::F64(_));
    let is_wide = matches!(samples, Samples::U32(_) | Samples::I32(_) | Samples::F64(_));
    let ends =
        samples.finite_range().map(|(range, _)| [range.low, range.high].map(|v| v.mul_add(slope, intercept)));
    if let Some(ends) = ends
        && is_integer
        && [slope, intercept].iter().all(|number| number.fract() == 0.0 && number.abs() <= MOST_EXACT)
    {
        let within = |low: f64, high: f64| ends.iter().all(|end| (low..=high).contains(end));
        if within(0.0, 255.0) {
            return Samples::U8(whole(samples, slope, intercept, |value| value as u8));
        } else if within(f64::from(i16::MIN), f64::from(i16::MAX)) {
            return Samples::I16(whole(samples, slope, intercept, |value| value as i16));
        } else if within(0.0, f64::from(u16::MAX)) {
            return Samples::U16(whole(samples, slope, intercept, |value| value as u16));
        } else if within(f64::from(i32::MIN), f64::from(i32::MAX)) {
            return Samples::I32(whole(samples, slope, intercept, |value| value));
        }
    }
    if is_wide {
        Samples::F64(float(samples, slope, intercept, |value| value))
    } else {
        Samples::F32(float(samples, slope, intercept, |value| value as f32))
    }
}

/// Whole numbers of which it is known that they fit into 32 bits: what products have beyond these does not count.
#[expect(trivial_numeric_casts, clippy::unnecessary_cast, reason = "one of the eight types is i32 already")]
fn whole<U: Pod + Send>(
    samples: Samples,
    slope: f64,
    intercept: f64,
    kept: impl Fn(i32) -> U + Sync,
) -> Vec<U> {
    let (slope, intercept) = (slope as i64 as i32, intercept as i64 as i32);
    with_samples!(samples, values => mapped(values, |value| {
        kept((value as i32).wrapping_mul(slope).wrapping_add(intercept))
    }))
}

/// Numbers rounded once.
#[expect(trivial_numeric_casts, clippy::unnecessary_cast, reason = "one of the eight types is f64 already")]
fn float<U: Pod + Send>(
    samples: Samples,
    slope: f64,
    intercept: f64,
    kept: impl Fn(f64) -> U + Sync,
) -> Vec<U> {
    with_samples!(samples, values => mapped(values, |value| kept((value as f64).mul_add(slope, intercept))))
}

/// Other values in place of some: in the same memory where they are as long.
fn mapped<T: Pod + Send + Sync, U: Pod + Send>(values: Vec<T>, of: impl Fn(T) -> U + Sync) -> Vec<U> {
    let values = if size_of::<T>() == size_of::<U>() {
        match bytemuck::allocation::try_cast_vec::<T, U>(values) {
            Ok(mut cells) => {
                cells.par_chunks_mut(CHUNK).for_each(|cells| {
                    for cell in cells {
                        *cell = of(bytemuck::cast(*cell));
                    }
                });
                return cells;
            }
            Err((_, values)) => values,
        }
    } else {
        values
    };
    let mut made = vec![U::zeroed(); values.len()];
    made.par_chunks_mut(CHUNK).zip(values.par_chunks(CHUNK)).for_each(|(made, values)| {
        made.iter_mut().zip(values).for_each(|(made, &value)| *made = of(value));
    });
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rescaled_and_stay_whole_where_they_can() {
        let bytes = Samples::U8(vec![0, 200]);
        assert_eq!(rescaled(bytes.clone(), 1.0, -1024.0), Samples::I16(vec![-1024, -824]));
        assert_eq!(rescaled(bytes.clone(), 0.5, 0.0), Samples::F32(vec![0.0, 100.0]));
        for (slope, intercept) in [(1.0, 0.0), (0.0, 5.0), (f64::NAN, 0.0), (2.0, f64::INFINITY)] {
            assert_eq!(rescaled(bytes.clone(), slope, intercept), bytes, "{slope} {intercept}");
        }
        let words = Samples::U16(vec![0, 65535]);
        assert_eq!(rescaled(words, 1.0, -32768.0), Samples::I16(vec![-32768, 32767]));
    }

    #[test]
    fn each_type_gives_what_numbers_of_64_bits_would() {
        let ends = Samples::I32(vec![i32::MIN, -7, 0, i32::MAX]);
        assert_eq!(rescaled(ends, -1.0, -1.0), Samples::I32(vec![i32::MAX, 6, -1, i32::MIN]));
        let high = Samples::U32(vec![4_000_000_000, 4_000_000_100]);
        assert_eq!(rescaled(high.clone(), 2.0, -8_000_000_000.0), Samples::U8(vec![0, 200]));
        assert_eq!(rescaled(high, 1.0, 1.0), Samples::F64(vec![4_000_000_001.0, 4_000_000_101.0]));
        let halves = Samples::F64(vec![0.5, f64::NAN]);
        let Samples::F64(halves) = rescaled(halves, 3.0, 1.0) else { panic!("its type stays") };
        assert!(halves[0] == 2.5 && halves[1].is_nan());
        assert_eq!(rescaled(Samples::F32(vec![1.5]), 2.0, 0.0), Samples::F32(vec![3.0]));
        // Nothing is lost of what is more than a task makes.
        let many = Samples::U16((0..200_000u32).map(|at| (at % 4096) as u16).collect());
        let lifted = (0..200_000).map(|at| (at % 4096 - 1024) as i16).collect();
        assert_eq!(rescaled(many, 1.0, -1024.0), Samples::I16(lifted));
    }
}
