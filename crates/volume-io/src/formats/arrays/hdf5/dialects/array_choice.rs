//! Choice among the arrays of any file: all with two to five dimensions of numbers, by their paths.

use super::super::container::{Hdf5Attribute, Hdf5File, Hdf5Object};
use super::array_axes::{ArrayAxes, DimensionOrder};
use super::array_tree::{ArrayTree, FoundArray, partial};
use super::coordinates::{AxisCoordinates, attribute_number, attribute_text, dimension_scales, placement};
use super::nexus;
use super::volume_read::{ChosenHdf5Volume, number_type};
use crate::reading::input::stem;
use crate::reading::number::FileNumberType;
use crate::reading::placement::GridPlacement;
use crate::reading::reader::VolumeSource;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{FileDimension, LoadError, ValueMetadata, Volume, VolumeOffer};

/// Field of errors about a file without a volume.
pub(super) const FIELD: &str = "arrays";

/// Longest path that is offered, in characters.
const MAX_PATH: usize = 160;

/// Array that may be a volume.
struct ArrayCandidate {
    found: FoundArray,
    attributes: Vec<Hdf5Attribute>,
    coordinates: Vec<Option<AxisCoordinates>>,
    axes: ArrayAxes,
}

impl ArrayCandidate {
    /// Interprets an array; the error is that of the file about it. `None` for what programs store beside volumes.
    fn from_array(
        file: &Hdf5File<'_>,
        found: FoundArray,
        is_matlab: bool,
    ) -> Result<Option<Self>, LoadError> {
        let attributes = found.object.attributes(file)?;
        let rank = found.array.shape.len();
        if is_matlab {
            let class = attribute_text(file, &attributes, "MATLAB_class")?;
            if matches!(class.as_str(), "char" | "cell" | "function_handle" | "string" | "table") {
                return Ok(None);
            }
        }
        let coordinates = dimension_scales(file, &attributes, rank)?;
        let is_time_first = coordinates.first().and_then(Option::as_ref).is_some_and(|axis| axis.is_time);
        let order = match (is_matlab, is_time_first) {
            (true, _) => DimensionOrder::Columns,
            (false, true) => DimensionOrder::TimeFirst,
            (false, false) => DimensionOrder::Fastest,
        };
        let help = "choose an array of numbers with two to five dimensions: time, channel, z, y, x";
        let axes = ArrayAxes::from_array(&found.array, order)
            .map_err(|why| file.context().bad_input_error(&sanitised(&found.path, MAX_PATH), why, help))?;
        Ok(Some(Self { found, attributes, coordinates, axes }))
    }

    /// Key by which it is chosen: its path.
    fn key(&self) -> String {
        sanitised(&self.found.path, MAX_PATH)
    }

    /// Placement by its coordinates, or else by the size of an element that some programs for microscopes write.
    fn placement(&self, file: &Hdf5File<'_>) -> GridPlacement {
        let along = self.axes.axes.map(|axis| self.coordinates.get(axis?)?.as_ref());
        let size = self.attributes.iter().find(|attribute| attribute.name == "element_size_um");
        if let Some([z, y, x]) = size.map(Hdf5Attribute::numbers).as_deref() {
            return GridPlacement::from_spacing([x / 1e3, y / 1e3, z / 1e3]).with_length_unit(1e-3);
        }
        let placed = placement(along, self.axes.dims);
        for remark in &placed.remarks {
            file.context().warn(remark);
        }
        placed
    }
}

/// Loads the chosen array below a group.
pub(super) fn load(
    source: &mut VolumeSource<'_>,
    file: &Hdf5File<'_>,
    root: &Hdf5Object,
    is_matlab: bool,
) -> Result<Volume, LoadError> {
    let ArrayTree { arrays, mut refused } = ArrayTree::list(file, root)?;
    let mut candidates = Vec::new();
    for found in arrays {
        match partial(ArrayCandidate::from_array(file, found, is_matlab))? {
            Ok(candidate) => candidates.extend(candidate),
            Err(error) => refused.push(error),
        }
    }
    let signal = partial(nexus::default_signal(file, root))?.unwrap_or_default();
    let named = source.options.choice.array.as_deref();
    let is_signal = |candidate: &ArrayCandidate| {
        signal.as_ref().is_some_and(|signal| signal.address == candidate.found.object.address)
    };
    // Tables beside volumes are offered only by name.
    if candidates.iter().any(|candidate| !candidate.axes.is_likely_table()) {
        candidates.retain(|candidate| {
            !candidate.axes.is_likely_table()
                || is_signal(candidate)
                || named == Some(candidate.key().as_str())
        });
    }
    if candidates.is_empty() {
        return Err(no_array_error(file, refused));
    }
    let offers: Vec<VolumeOffer> = candidates
        .iter()
        .map(|candidate| {
            let key = candidate.key();
            VolumeOffer { name: key.clone(), key, dims: Some(candidate.axes.dims), color: None }
        })
        .collect();
    let is_scalar = |at: usize| candidates[at].axes.components == 1 && candidates[at].axes.outer.is_empty();
    let choice = match candidates.iter().position(is_signal) {
        Some(at) if named.is_none() => {
            source.options.choice.clone().with_selected(FileDimension::Array, &offers[at].key)
        }
        _ => source.options.choice.with_only_scalar_array(&offers, is_scalar),
    };
    let chosen = file.context().resolve_choice(&choice, FileDimension::Array, offers)?;
    let mut candidate = candidates.swap_remove(chosen);
    if let Some(signal) = signal.filter(|signal| signal.address == candidate.found.object.address) {
        for (known, said) in candidate.coordinates.iter_mut().zip(signal.coordinates) {
            *known = known.take().or(said);
        }
    }
    load_candidate(source, file, &candidate)
}

fn load_candidate(
    source: &mut VolumeSource<'_>,
    file: &Hdf5File<'_>,
    candidate: &ArrayCandidate,
) -> Result<Volume, LoadError> {
    let ArrayCandidate { found, attributes, axes, .. } = candidate;
    let mut chosen = Vec::new();
    for outer in &axes.outer {
        let number =
            source.choose_numbered(file.context(), outer.dimension, outer.count, axes.dims, |_| {
                String::new()
            })?;
        chosen.push(number as u64);
    }
    let path = candidate.key();
    let stated = number_type(&found.array).map(|(number, _)| number);
    let is_unsigned = attribute_text(file, attributes, "_Unsigned")?.eq_ignore_ascii_case("true");
    let meant_number = stated.filter(|_| is_unsigned).map(unsigned);
    let scale = ["scale_factor", "add_offset"].map(|name| attribute_number(attributes, name));
    let scale = [scale[0].unwrap_or(1.0), scale[1].unwrap_or(0.0)];
    let fill =
        ["_FillValue", "missing_value"].into_iter().find_map(|name| attribute_number(attributes, name));
    let mut hints = ValueMetadata::default();
    if let Some(fill) = fill {
        let fill = meant_number.map_or(fill, |number| wrapped(fill, number));
        hints.set_padding(if scale == [1.0, 0.0] { fill } else { fill.mul_add(scale[0], scale[1]) });
    }
    hints.set_unit(&attribute_text(file, attributes, "units")?);
    hints.set_acquisition(&attribute_text(file, attributes, "long_name")?);
    let volume = ChosenHdf5Volume {
        name: sanitised(&format!("{} {path}", stem(source.path)), 120),
        path: &path,
        array: &found.array,
        view: axes.view(found.array.shape.len(), &chosen),
        components: (axes.components, axes.is_color),
        placement: candidate.placement(file),
        hints,
        scale,
        meant_number,
    };
    volume.load(source, file)
}

/// Unsigned number type of the same size: `NetCDF` before version 4 had none.
pub(super) fn unsigned(number: FileNumberType) -> FileNumberType {
    match number {
        FileNumberType::I8 => FileNumberType::U8,
        FileNumberType::I16 => FileNumberType::U16,
        FileNumberType::I32 => FileNumberType::U32,
        FileNumberType::I64 => FileNumberType::U64,
        other => other,
    }
}

/// Number that an unsigned type has for a negative one of the same bits.
fn wrapped(value: f64, number: FileNumberType) -> f64 {
    if value < 0.0 { value + 256f64.powi(number.bytes() as i32) } else { value }
}

/// Error for a file without an array that is a volume.
fn no_array_error(file: &Hdf5File<'_>, mut refused: Vec<LoadError>) -> LoadError {
    match refused.len() {
        0 => file.context().bad_input_error(
            FIELD,
            "it holds no arrays",
            "list its contents with h5ls -r FILE, and write an array of numbers with three dimensions: z, y, x",
        ),
        1 => refused.remove(0),
        count => file.context().bad_input_error(
            FIELD,
            format!("none of its arrays is a volume: {count} are lists, text or records"),
            "list its contents with h5ls -r FILE, and write an array of numbers with three dimensions: z, y, x",
        ),
    }
}
