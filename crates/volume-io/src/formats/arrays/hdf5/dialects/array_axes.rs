//! Interpretation of an array's dimensions: the fastest are a volume, those before them count volumes.

use super::super::container::Hdf5Type;
use super::super::storage::{ArrayView, Hdf5Array};
use crate::reading::number::FileNumberType;
use chiaroscuro_volume::FileDimension;

/// Dimension of an array that counts volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OuterAxis {
    pub(super) dimension: FileDimension,
    /// Index of the dimension in the array.
    pub(super) axis: usize,
    pub(super) count: u64,
}

/// Conventions for the order of dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DimensionOrder {
    /// The fastest is x, then y and z.
    Fastest,
    /// As [`Self::Fastest`], and the slowest counts time steps.
    TimeFirst,
    /// Rows of a matrix are the fastest: y, then x and z.
    Columns,
}

/// Array as one or several volumes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ArrayAxes {
    pub(super) outer: Vec<OuterAxis>,
    pub(super) axes: [Option<usize>; 3],
    pub(super) dims: [u64; 3],
    pub(super) component_axis: Option<usize>,
    pub(super) components: usize,
    pub(super) is_color: bool,
}

impl ArrayAxes {
    /// Interprets the dimensions of an array of numbers; the error says why it is no volume. Dimensions of length 1 are
    /// dropped while there are more than three.
    pub(super) fn from_array(array: &Hdf5Array, order: DimensionOrder) -> Result<Self, String> {
        let (number, mut components) = match array.element_type {
            Hdf5Type::Number(number, _) => (number, 1),
            Hdf5Type::Complex(number, _) => (number, 2),
            Hdf5Type::Other(name) => return Err(format!("its elements are {name}, which are not supported")),
            _ => return Err("its elements are no numbers".to_owned()),
        };
        let shape = &array.shape;
        let mut axes: Vec<usize> = (0..shape.len()).collect();
        let mut component_axis = None;
        let is_color = number == FileNumberType::U8
            && components == 1
            && shape.len() > 3
            && order != DimensionOrder::Columns
            && matches!(shape.last(), Some(3 | 4));
        if is_color {
            component_axis = axes.pop();
            components = component_axis.map_or(1, |axis| shape[axis]) as usize;
        }
        let mut outer = Vec::new();
        let frames = |axis: usize| OuterAxis { dimension: FileDimension::Frame, axis, count: shape[axis] };
        if order == DimensionOrder::TimeFirst && axes.len() > 2 {
            outer.push(frames(axes.remove(0)));
        }
        while axes.len() > 3 {
            let Some(single) = axes.iter().position(|&axis| shape[axis] == 1) else { break };
            axes.remove(single);
        }
        let count = axes.len();
        match (count, outer.is_empty()) {
            (2 | 3, _) => {}
            (4, true) => outer.push(frames(axes.remove(0))),
            (4, false) => {
                let axis = axes.remove(0);
                outer.push(OuterAxis { dimension: FileDimension::Channel, axis, count: shape[axis] });
            }
            (5, true) => {
                outer.push(frames(axes.remove(0)));
                let axis = axes.remove(0);
                outer.push(OuterAxis { dimension: FileDimension::Channel, axis, count: shape[axis] });
            }
            _ => return Err(format!("an array of {} dimensions is not a volume", shape.len())),
        }
        if let Some(empty) = shape.iter().position(|&length| length == 0) {
            return Err(format!("its dimension {empty} has no elements"));
        }
        let mut fastest = axes.into_iter().rev();
        let mut axes: [Option<usize>; 3] = std::array::from_fn(|_| fastest.next());
        if order == DimensionOrder::Columns {
            axes.swap(0, 1);
        }
        let dims = axes.map(|axis| axis.map_or(1, |axis| shape[axis]));
        Ok(Self { outer, axes, dims, component_axis, components, is_color })
    }

    /// True for arrays that are likely no image: two dimensions, one of them shorter than 16, are a matrix or a list of
    /// points; more that end in 2 by 2 to 4 by 4 are a list of matrices.
    pub(super) fn is_likely_table(&self) -> bool {
        const MIN_PIXELS: u64 = 16;
        let [x, y, _] = self.dims;
        if self.axes[2].is_none() && self.outer.is_empty() {
            x < MIN_PIXELS || y < MIN_PIXELS
        } else {
            x == y && (2..=4).contains(&x)
        }
    }

    /// Volume of the array, by the index along each of the outer dimensions.
    pub(super) fn view(&self, rank: usize, chosen: &[u64]) -> ArrayView {
        let mut first = vec![0; rank];
        for (outer, &chosen) in self.outer.iter().zip(chosen) {
            first[outer.axis] = chosen;
        }
        let Self { axes, component_axis, dims, .. } = *self;
        ArrayView { first, axes, component_axis, dims }
    }
}
