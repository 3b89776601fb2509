//! Interpretation of an array's dimensions: the fastest are a volume, those before them count volumes.

use super::super::super::volume_axes::{OuterAxis, VolumeAxes, has_color_axis, is_likely_table};
use super::super::container::Hdf5Type;
use super::super::storage::{ArrayView, Hdf5Array};

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
        let is_color = order != DimensionOrder::Columns && has_color_axis(number, shape.iter().copied());
        if is_color {
            component_axis = axes.pop();
            components = component_axis.map_or(1, |axis| shape[axis]) as usize;
        }
        let is_time_first = order == DimensionOrder::TimeFirst;
        let found = VolumeAxes::from_axes(shape, axes, is_time_first);
        let VolumeAxes { outer, mut axes } =
            found.map_err(|_count| format!("an array of {} dimensions is not a volume", shape.len()))?;
        if let Some(empty) = shape.iter().position(|&length| length == 0) {
            return Err(format!("its dimension {empty} has no elements"));
        }
        if order == DimensionOrder::Columns {
            axes.swap(0, 1);
        }
        let dims = axes.map(|axis| axis.map_or(1, |axis| shape[axis]));
        Ok(Self { outer, axes, dims, component_axis, components, is_color })
    }

    /// Returns true if the array is likely no image.
    pub(super) fn is_likely_table(&self) -> bool {
        is_likely_table([self.dims[0], self.dims[1]], self.axes[2].is_none() && self.outer.is_empty())
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
