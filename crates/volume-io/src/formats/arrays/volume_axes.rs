//! Interpretation of an array's axes by their number: the fastest are a volume, those before them count volumes.

use super::FileDimension;
use super::number::FileNumberType;

/// Axis of an array that counts volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OuterAxis {
    pub(super) dimension: FileDimension,
    /// Index of the axis in the array.
    pub(super) axis: usize,
    pub(super) count: u64,
}

/// Axes of an array as those of one or several volumes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct VolumeAxes {
    /// Axes that count volumes, slowest first.
    pub(super) outer: Vec<OuterAxis>,
    /// Index of the axis along x, y and z; `None` for the depth of a picture.
    pub(super) axes: [Option<usize>; 3],
}

impl VolumeAxes {
    /// Interprets `axes`, indices into `shape` with the slowest first: four are time, z, y and x, and five time, channel,
    /// z, y and x. The first of more than two is time in any case with `is_time_first`. Axes of length 1 are dropped
    /// while there are more than three.
    ///
    /// # Errors
    /// Returns the number of axes where that is none of a volume.
    pub(super) fn from_axes(shape: &[u64], mut axes: Vec<usize>, is_time_first: bool) -> Result<Self, usize> {
        let mut dimensions = [FileDimension::Frame, FileDimension::Channel].into_iter();
        let mut outer = Vec::new();
        let mut take_outer = |axes: &mut Vec<usize>| {
            outer.extend(dimensions.next().map(|dimension| {
                let axis = axes.remove(0);
                OuterAxis { dimension, axis, count: shape[axis] }
            }));
        };
        if is_time_first && axes.len() > 2 {
            take_outer(&mut axes);
        }
        while axes.len() > 3 {
            let Some(single) = axes.iter().position(|&axis| shape[axis] == 1) else { break };
            axes.remove(single);
        }
        let count = axes.len();
        let most = if is_time_first { 4 } else { 5 };
        if !(2..=most).contains(&count) {
            return Err(count);
        }
        for _ in 3..count {
            take_outer(&mut axes);
        }
        let mut fastest = axes.into_iter().rev();
        Ok(Self { outer, axes: std::array::from_fn(|_| fastest.next()) })
    }
}

/// Returns true if the fastest axis of an array, whose axes have these lengths, slowest first, is that of colours.
pub(super) fn has_color_axis(number: FileNumberType, lengths: impl ExactSizeIterator<Item = u64>) -> bool {
    number == FileNumberType::U8 && lengths.len() > 3 && matches!(lengths.last(), Some(3 | 4))
}

/// Returns true if an array of so many elements along x and y is likely no image: an array of two axes, one of them
/// shorter than 16, is an affine, a matrix or a list of points, and one of more axes that end in 2 by 2 to 4 by 4 a list
/// of matrices.
pub(super) fn is_likely_table([x, y]: [u64; 2], has_two_axes: bool) -> bool {
    const MIN_PIXELS: u64 = 16;
    if has_two_axes { x < MIN_PIXELS || y < MIN_PIXELS } else { x == y && (2..=4).contains(&x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Interprets the axes of a shape: the lengths of the outer ones, and those along x, y and z.
    fn lengths(shape: &[u64], is_time_first: bool) -> Result<(Vec<u64>, [u64; 3]), usize> {
        let found = VolumeAxes::from_axes(shape, (0..shape.len()).collect(), is_time_first)?;
        let along = found.axes.map(|axis| axis.map_or(1, |axis| shape[axis]));
        Ok((found.outer.iter().map(|outer| outer.count).collect(), along))
    }

    #[test]
    fn axes_are_interpreted_by_their_number() {
        assert_eq!(lengths(&[5, 6], false), Ok((vec![], [6, 5, 1])));
        assert_eq!(lengths(&[4, 5, 6], false), Ok((vec![], [6, 5, 4])));
        assert_eq!(lengths(&[2, 4, 5, 6], false), Ok((vec![2], [6, 5, 4])));
        assert_eq!(lengths(&[2, 3, 4, 5, 6], false), Ok((vec![2, 3], [6, 5, 4])));
        assert_eq!(lengths(&[1, 1, 4, 5, 6], false), Ok((vec![], [6, 5, 4])));
        assert_eq!(lengths(&[2, 2, 3, 4, 5, 6], false), Err(6));
        assert_eq!(lengths(&[7], false), Err(1));
        assert_eq!(lengths(&[7, 5, 6], true), Ok((vec![7], [6, 5, 1])));
        assert_eq!(lengths(&[7, 3, 4, 5, 6], true), Ok((vec![7, 3], [6, 5, 4])));
        assert_eq!(lengths(&[7, 2, 3, 4, 5, 6], true), Err(5));
        let dimensions = VolumeAxes::from_axes(&[2, 3, 4, 5, 6], (0..5).collect(), false).unwrap().outer;
        assert_eq!(dimensions[1], OuterAxis { dimension: FileDimension::Channel, axis: 1, count: 3 });
    }

    #[test]
    fn tables_and_colors_are_told_from_volumes() {
        assert!(
            is_likely_table([4, 4], true)
                && is_likely_table([200, 3], true)
                && is_likely_table([3, 3], false)
        );
        assert!(!is_likely_table([16, 16], true) && !is_likely_table([5, 5], false));
        let color = |number, shape: &[u64]| has_color_axis(number, shape.iter().copied());
        assert!(color(FileNumberType::U8, &[4, 5, 6, 3]));
        assert!(!color(FileNumberType::U16, &[4, 5, 6, 3]) && !color(FileNumberType::U8, &[5, 6, 3]));
    }
}
