//! Reading of a chosen volume: its voxels, converted to values, with what is known about them.

use super::super::container::{HELP, Hdf5File, Hdf5Type};
use super::super::storage::{ArrayView, Hdf5Array, contiguous_start, read_view};
use crate::Endian;
use crate::reading::number::{FileNumberType, ScalarReduction, VoxelEncoding};
use crate::reading::placement::{GridPlacement, VolumeParts};
use crate::reading::reader::VolumeSource;
use crate::reading::rescale::rescale;
use crate::reading::samples::VoxelLayout;
use crate::reading::voxels::ValueMapping;
use chiaroscuro_volume::{GridExtent, LoadError, ValueMetadata, Volume};

/// Chosen volume of a file.
pub(super) struct ChosenHdf5Volume<'a> {
    /// Name of the volume.
    pub(super) name: String,
    /// Path of its array, for messages.
    pub(super) path: &'a str,
    pub(super) array: &'a Hdf5Array,
    pub(super) view: ArrayView,
    /// Numbers of a voxel, and whether they are a colour.
    pub(super) components: (usize, bool),
    pub(super) placement: GridPlacement,
    pub(super) hints: ValueMetadata,
    /// Slope and intercept from stored numbers to values.
    pub(super) scale: [f64; 2],
    /// Number type that the file means, where it differs from that which it states.
    pub(super) meant_number: Option<FileNumberType>,
}

/// Number type and byte order of an array's elements.
pub(super) fn number_type(array: &Hdf5Array) -> Option<(FileNumberType, Endian)> {
    match array.element_type {
        Hdf5Type::Number(number, endian) | Hdf5Type::Complex(number, endian) => Some((number, endian)),
        _ => None,
    }
}

impl ChosenHdf5Volume<'_> {
    /// Reads the voxels and assembles the volume.
    pub(super) fn load(
        self,
        source: &mut VolumeSource<'_>,
        file: &Hdf5File<'_>,
    ) -> Result<Volume, LoadError> {
        let context = file.context();
        let Self {
            name, path, array, view, components: (components, is_color), placement, hints, scale, ..
        } = self;
        if let Some((why, help)) = array.refusal() {
            return Err(context.bad_input_error(path, why, help));
        }
        let Some((number, endian)) = number_type(array) else {
            let why = "its elements are no numbers";
            return Err(context.bad_input_error(path, why, "choose another array with --array"));
        };
        let number = self.meant_number.unwrap_or(number);
        let reduction = source.scalar_reduction(context, components, is_color)?;
        let stored = VoxelEncoding { number, endian, components, reduction };
        let limits = source.options.limits(source.control);
        let extent = GridExtent::checked(context, path, view.dims, stored.voxel_type(), limits)?;
        let budget = source.options.memory_budget_bytes;
        let values = |samples| rescale(context, samples, scale, budget);
        let mapping = ValueMapping { padding: hints.padding, map: &values };
        let voxels = if let Some(at) = contiguous_start(file, array, &view) {
            let needed = (extent.voxels as u64).saturating_mul(stored.voxel_bytes());
            let found = file.length().saturating_sub(at);
            if found < needed {
                let why =
                    format!("the data are truncated: {needed} bytes were expected at {at}, {found} found");
                return Err(context.bad_input_error(path, why, HELP));
            }
            let layout = VoxelLayout { extent, voxel_type: stored.voxel_type(), endian };
            let read = stored.read_from_file(&mut source.input, at, extent, &mapping, source.control);
            read.map_err(|fault| fault.into_error(context, &layout, "bytes", HELP))?
        } else {
            read_view(file, (path, array), &view, (&stored, extent), (&mapping, budget))?
        };
        let remark = match reduction {
            ScalarReduction::Magnitude => Some("complex numbers are shown as their magnitude"),
            other => other.remark(),
        };
        let placement = placement.with_remark(remark);
        VolumeParts { name, extent, placement, voxels, hints }.into_volume(context, source.control)
    }
}

/// Reads a small array of one or two dimensions as numbers, slowest dimension first; none if it is no such array.
pub(super) fn read_numbers(
    file: &Hdf5File<'_>,
    (path, array): (&str, &Hdf5Array),
    limit: u64,
) -> Result<Vec<f64>, LoadError> {
    let Hdf5Type::Number(number, endian) = array.element_type else { return Ok(Vec::new()) };
    let (dims, axes) = match array.shape[..] {
        [n] => ([n, 1, 1], [Some(0), None, None]),
        [rows, columns] => ([columns, rows, 1], [Some(1), Some(0), None]),
        _ => return Ok(Vec::new()),
    };
    let count = dims.iter().fold(1u64, |product, &n| product.saturating_mul(n));
    if count == 0 || count > limit || array.refusal().is_some() {
        return Ok(Vec::new());
    }
    let view = ArrayView { first: vec![0; array.shape.len()], axes, component_axis: None, dims };
    let stored = VoxelEncoding::scalar(number, endian);
    let extent = GridExtent::unchecked(dims.map(|n| n as usize), stored.voxel_type());
    let read = read_view(file, (path, array), &view, (&stored, extent), (&ValueMapping::identity(None), 0))?;
    Ok((0..read.samples.len()).map(|at| read.samples.value(at)).collect())
}
