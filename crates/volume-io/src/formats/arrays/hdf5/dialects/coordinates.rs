//! Coordinates along the dimensions of an array: spacing, position and unit, as `NetCDF`, `NeXus` and others state them.

use super::super::container::{Hdf5Attribute, Hdf5File, Hdf5Object, MessageKind};
use super::super::storage::Hdf5Array;
use super::array_tree::partial;
use super::volume_read::read_numbers;
use crate::length_unit::millimetres;
use crate::reading::placement::GridPlacement;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{LoadError, is_usable_spacing};

/// Maximum number of coordinates along a dimension that are read.
const MAX_COORDINATES: u64 = 1 << 20;

/// Largest deviation of a step from the mean of all, as a share of it: coordinates are often rounded floats.
const STEP_TOLERANCE: f64 = 1e-2;

/// Coordinates along one dimension of an array.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AxisCoordinates {
    pub(super) name: String,
    pub(super) unit: String,
    /// First coordinate, and the step to the next; `None` if the steps differ.
    pub(super) steps: Option<[f64; 2]>,
    pub(super) is_time: bool,
}

/// Text of an attribute, empty if there is none.
pub(super) fn attribute_text(
    file: &Hdf5File<'_>,
    attributes: &[Hdf5Attribute],
    name: &str,
) -> Result<String, LoadError> {
    let found = attributes.iter().find(|attribute| attribute.name == name);
    found.map_or_else(|| Ok(String::new()), |attribute| attribute.text(file))
}

/// First number of an attribute.
pub(super) fn attribute_number(attributes: &[Hdf5Attribute], name: &str) -> Option<f64> {
    attributes.iter().find(|attribute| attribute.name == name)?.numbers().first().copied()
}

impl AxisCoordinates {
    /// Reads the coordinates in a one-dimensional array.
    pub(super) fn read(file: &Hdf5File<'_>, object: &Hdf5Object, name: &str) -> Result<Self, LoadError> {
        let attributes = object.attributes(file)?;
        let unit = attribute_text(file, &attributes, "units")?;
        let standard = attribute_text(file, &attributes, "standard_name")?;
        let axis = attribute_text(file, &attributes, "axis")?;
        let is_time = axis == "T" || standard == "time" || unit.contains(" since ") || is_time_name(name);
        let is_placeholder =
            attribute_text(file, &attributes, "NAME")?.starts_with("This is a netCDF dimension");
        let mut values = Vec::new();
        if object.is_dataset() && !is_placeholder {
            // Coordinates that are damaged are no reason to refuse the voxels.
            let read = Hdf5Array::open(file, object, name)
                .and_then(|array| read_numbers(file, (name, &array), MAX_COORDINATES));
            values = partial(read)?.unwrap_or_default();
        }
        Ok(Self { name: sanitised(name, 40), unit, steps: even_steps(&values), is_time })
    }
}

/// Returns true for the usual names of the dimension of time.
pub(super) fn is_time_name(name: &str) -> bool {
    let last = name.rsplit('/').next().unwrap_or(name);
    last.eq_ignore_ascii_case("time") || last == "t" || last == "T"
}

/// First coordinate and step of coordinates at even distances.
fn even_steps(values: &[f64]) -> Option<[f64; 2]> {
    let (&[first, ..], &[.., last]) = (values, values) else { return None };
    let step = (last - first) / values.len().checked_sub(1).filter(|&count| count > 0)? as f64;
    let is_even = |pair: &[f64]| ((pair[1] - pair[0]) - step).abs() <= STEP_TOLERANCE * step.abs();
    (is_usable_spacing(step.abs()) && values.windows(2).all(is_even)).then_some([first, step])
}

/// Coordinates along each dimension of an array, by its scales (`DIMENSION_LIST`); `None` for dimensions without any.
pub(super) fn dimension_scales(
    file: &Hdf5File<'_>,
    attributes: &[Hdf5Attribute],
    rank: usize,
) -> Result<Vec<Option<AxisCoordinates>>, LoadError> {
    let mut found = vec![None; rank];
    let Some(list) = attributes.iter().find(|attribute| attribute.name == "DIMENSION_LIST") else {
        return Ok(found);
    };
    let references = partial(list.references(file))?.unwrap_or_default();
    for (axis, references) in found.iter_mut().zip(references) {
        let Some(&address) = references.first() else { continue };
        let Ok(object) = partial(Hdf5Object::read(file, address))? else { continue };
        if object.has(MessageKind::DATASPACE) {
            let attributes = object.attributes(file)?;
            let name = attribute_text(file, &attributes, "NAME")?;
            *axis = partial(AxisCoordinates::read(file, &object, &name))?.ok();
        }
    }
    Ok(found)
}

/// Placement of a volume by the coordinates along x, y and z.
pub(super) fn placement(along: [Option<&AxisCoordinates>; 3], dims: [u64; 3]) -> GridPlacement {
    // The coordinates of a single voxel have no step.
    let needed: Vec<usize> = (0..3).filter(|&at| dims[at] > 1).collect();
    let uneven =
        needed.iter().find_map(|&at| along[at].filter(|axis| axis.steps.is_none() && !axis.unit.is_empty()));
    let remark =
        uneven.map(|axis| format!("the coordinates along {} are not evenly spaced, and not used", axis.name));
    let steps = [0, 1, 2].map(|at| along[at].and_then(|axis| axis.steps));
    if needed.is_empty() || needed.iter().any(|&at| steps[at].is_none()) {
        return GridPlacement::unknown().with_remark(remark);
    }
    let units = [0, 1, 2].map(|at| along[at].map_or("", |axis| axis.unit.as_str()));
    let lengths = [0, 1, 2].map(|at| millimetres(units[at]));
    let are_lengths = needed.iter().all(|&at| lengths[at].is_some());
    let are_alike = needed.iter().all(|&at| units[at] == units[needed[0]]);
    if !are_lengths && !are_alike {
        let said: Vec<String> =
            needed.iter().map(|&at| format!("\"{}\"", sanitised(units[at], 20))).collect();
        let remark = format!(
            "the coordinates have different units, {}: voxels are taken for cubes",
            said.join(" and ")
        );
        return GridPlacement::unknown().with_remark(Some(remark));
    }
    let unit = |at: usize| if are_lengths { lengths[at].unwrap_or(1.0) } else { 1.0 };
    let known = [0, 1, 2].map(|at| steps[at].map(|[first, step]| [first * unit(at), step * unit(at)]));
    let shortest = known.iter().flatten().map(|[_, step]| step.abs()).fold(f64::INFINITY, f64::min);
    let placement =
        GridPlacement::from_spacing(known.map(|axis| axis.map_or(shortest, |[_, step]| step.abs())));
    if !are_lengths {
        return placement.with_unknown_scale();
    }
    placement.with_length_unit(unit(needed[0]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_steps_are_found() {
        assert_eq!(even_steps(&[1.0, 3.0, 5.0]), Some([1.0, 2.0]));
        assert_eq!(even_steps(&[5.0, 3.0]), Some([5.0, -2.0]));
        for values in [&[][..], &[1.0], &[1.0, 1.0], &[1.0, 2.0, 4.0], &[0.0, f64::NAN], &[0.0, 1e300]] {
            assert_eq!(even_steps(values), None, "{values:?}");
        }
    }

    #[test]
    fn lengths_place_a_volume_and_other_units_only_if_alike() {
        let axis = |unit: &str, step: f64| AxisCoordinates {
            name: "a".to_owned(),
            unit: unit.to_owned(),
            steps: Some([0.0, step]),
            is_time: false,
        };
        let (x, y, z) = (axis("um", 2.0), axis("um", -3.0), axis("mm", 0.004));
        let placed = placement([Some(&x), Some(&y), Some(&z)], [9; 3]);
        assert!(placed.is_scale_known);
        assert_eq!(placed.world_from_index.matrix3.y_axis.y, 0.003);
        let flat = placement([Some(&x), Some(&y), None], [9, 9, 1]);
        assert_eq!(flat.world_from_index.matrix3.z_axis.z, 0.002);
        let degrees = [axis("degrees_east", 1.0), axis("degrees_east", 2.0)];
        let sky = placement([Some(&degrees[0]), Some(&degrees[1]), None], [9, 9, 1]);
        assert!(!sky.is_scale_known && sky.world_from_index.matrix3.y_axis.y == 2.0);
        let mixed = placement([Some(&x), Some(&degrees[1]), None], [9, 9, 1]);
        assert!(mixed.remarks[0].contains("different units"));
        assert!(placement([None; 3], [9; 3]).remarks.is_empty());
    }
}
