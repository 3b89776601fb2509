//! Stored numbers to values: times a slope, and an intercept added.

use crate::data::Samples;
use crate::data::interrupt::made;

/// Values as a file means them: times a slope, and an intercept added. They stay whole numbers where that is exact.
pub(in crate::data::load) fn rescaled(samples: Samples, slope: f64, intercept: f64) -> Samples {
    let is_said = slope.is_finite() && intercept.is_finite() && slope != 0.0;
    if !is_said || (slope, intercept) == (1.0, 0.0) {
        return samples;
    }
    let is_integer = !matches!(samples, Samples::F32(_) | Samples::F64(_));
    let is_wide = matches!(samples, Samples::U32(_) | Samples::I32(_) | Samples::F64(_));
    let value = |voxel: usize| samples.value(voxel).mul_add(slope, intercept);
    let ends =
        samples.finite_range().map(|(range, _)| [range.low, range.high].map(|v| v.mul_add(slope, intercept)));
    if let Some(ends) = ends
        && is_integer
        && slope.fract() == 0.0
        && intercept.fract() == 0.0
    {
        let within = |low: f64, high: f64| ends.iter().all(|end| (low..=high).contains(end));
        if within(0.0, 255.0) {
            return Samples::U8(made(samples.len(), |voxel| value(voxel) as u8));
        } else if within(f64::from(i16::MIN), f64::from(i16::MAX)) {
            return Samples::I16(made(samples.len(), |voxel| value(voxel) as i16));
        } else if within(0.0, f64::from(u16::MAX)) {
            return Samples::U16(made(samples.len(), |voxel| value(voxel) as u16));
        } else if within(f64::from(i32::MIN), f64::from(i32::MAX)) {
            return Samples::I32(made(samples.len(), |voxel| value(voxel) as i32));
        }
    }
    if is_wide {
        Samples::F64(made(samples.len(), value))
    } else {
        Samples::F32(made(samples.len(), |voxel| value(voxel) as f32))
    }
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
}
