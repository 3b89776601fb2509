//! HDF5 files of `BigDataViewer`: `tTTTTT/sSS/L/cells` for each time step, setup and level of resolution.
//!
//! After <https://imagej.net/plugins/bdv/>: numbers are stored as signed and mean unsigned ones; setups are channels,
//! angles or tiles.

use super::super::container::{Hdf5File, Hdf5Object};
use super::super::storage::{ArrayView, Hdf5Array};
use super::array_choice::unsigned;
use super::array_tree::{object_at, partial};
use super::bdv_xml::BdvDescription;
use super::volume_read::{ChosenHdf5Volume, number_type, read_numbers};
use crate::reading::input::stem;
use crate::reading::number::FileNumberType;
use crate::reading::placement::GridPlacement;
use crate::reading::reader::VolumeSource;
use chiaroscuro_volume::{
    FileDimension, LoadError, Modality, ResolutionLevel, ValueMetadata, Volume, VolumeOffer, VoxelType,
};

/// Maximum number of levels.
const MAX_LEVELS: usize = 64;

/// Maximum number of setups, each of which is looked into.
const MAX_SETUPS: usize = 4096;

/// Returns true if a group has the name of a time step.
pub(crate) fn is_time_step(name: &str) -> bool {
    numbered(name, 't').is_some() && name.len() >= 6
}

/// Number after a letter.
fn numbered(name: &str, letter: char) -> Option<u32> {
    let digits = name.strip_prefix(letter)?;
    digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse().ok()).flatten()
}

/// Loads the chosen setup and time step.
pub(crate) fn load(
    source: &mut VolumeSource<'_>,
    file: &Hdf5File<'_>,
    described: Option<&BdvDescription>,
) -> Result<Volume, LoadError> {
    let context = file.context();
    let root = file.root()?;
    let links = root.links(file)?;
    let named = |letter: char, width: usize| {
        let is_named = move |name: &&str| name.len() > width && numbered(name, letter).is_some();
        let mut names: Vec<String> =
            links.iter().map(|link| link.name.as_str()).filter(is_named).map(str::to_owned).collect();
        names.sort_by_key(|name| numbered(name, letter));
        names
    };
    let (times, mut setups) = (named('t', 5), named('s', 2));
    setups.truncate(MAX_SETUPS);
    let Some(first) = times.first() else { return Err(missing(file, "t00000")) };
    let mut offers = Vec::new();
    for (at, setup) in setups.iter().enumerate() {
        let array = partial(cells(file, &root, &format!("{first}/{setup}/0/cells")))?;
        let dims = array.ok().and_then(|array| dims_of(&array));
        let number = numbered(setup, 's').unwrap_or(0);
        let name =
            described.and_then(|described| described.setup(number)).map_or("", |setup| setup.name.as_str());
        offers.push(VolumeOffer { dims, ..VolumeOffer::with_number(at, name, [0; 3]) });
    }
    if offers.is_empty() {
        return Err(missing(file, "s00"));
    }
    let names: Vec<String> = offers.iter().map(|offer| offer.name.clone()).collect();
    let grid = offers[0].dims.unwrap_or([0; 3]);
    let chosen = context.resolve_choice(&source.options.choice, FileDimension::Channel, offers)?;
    let time =
        source.choose_numbered(context, FileDimension::Frame, times.len() as u64, grid, |_| String::new())?;
    let setup = &setups[chosen];
    let factors = resolutions(file, &root, setup)?;
    let place = format!("{}/{setup}", times[time]);
    let levels = levels(file, &root, &place)?;
    let known: Vec<ResolutionLevel> = levels.iter().map(|(_, level)| level.clone()).collect();
    let level = source.options.limits(source.control).choose_level(context, &known)?;
    let (array, ResolutionLevel { dims, .. }) = &levels[level];
    let (path, dims) = (format!("{place}/{level}/cells"), *dims);
    let factors = factors.get(level).copied().unwrap_or([1.0; 3]);
    let placement = described
        .and_then(|described| described.setup(numbered(setup, 's')?))
        .map_or_else(GridPlacement::unknown, |setup| setup.placement(factors));
    let mut hints = ValueMetadata::default();
    hints.modality = Modality::LightMicroscopy;
    let name = match names[chosen].as_str() {
        "" => stem(source.path),
        setup => chiaroscuro_files::sanitised(&format!("{} {setup}", stem(source.path)), 120),
    };
    let view = ArrayView { first: vec![0; 3], axes: [Some(2), Some(1), Some(0)], component_axis: None, dims };
    let meant_number = number_type(array).map(|(number, _)| unsigned(number));
    let (components, scale, path) = ((1, false), [1.0, 0.0], path.as_str());
    ChosenHdf5Volume { name, path, array, view, components, placement, hints, scale, meant_number }
        .load(source, file)
}

/// Arrays of the levels of a setup at a time step, finest first.
fn levels(
    file: &Hdf5File<'_>,
    root: &Hdf5Object,
    place: &str,
) -> Result<Vec<(Hdf5Array, ResolutionLevel)>, LoadError> {
    let group = object_at(file, root, place)?.ok_or_else(|| missing(file, place))?;
    let links = group.links(file)?;
    let count =
        (0..MAX_LEVELS).take_while(|level| links.iter().any(|link| link.name == level.to_string())).count();
    let level = |level| {
        let path = format!("{place}/{level}/cells");
        let array = cells(file, root, &path)?;
        let Some(dims) = dims_of(&array) else {
            let why = format!("three dimensions were expected, it has {}", array.shape.len());
            return Err(file.context().bad_input_error(&path, why, "check that the file is complete"));
        };
        let number = number_type(&array).map(|(number, _)| unsigned(number));
        let voxel_type = number.map_or(VoxelType::F64, FileNumberType::voxel_type);
        Ok((array, ResolutionLevel { name: String::new(), dims, voxel_type }))
    };
    (0..count.max(1)).map(level).collect()
}

/// Voxels along x, y and z.
fn dims_of(array: &Hdf5Array) -> Option<[u64; 3]> {
    let [z, y, x] = array.shape[..] else { return None };
    Some([x, y, z])
}

fn cells(file: &Hdf5File<'_>, root: &Hdf5Object, path: &str) -> Result<Hdf5Array, LoadError> {
    match object_at(file, root, path)? {
        Some(object) if object.is_dataset() => Hdf5Array::open(file, &object, path),
        _ => Err(missing(file, path)),
    }
}

fn missing(file: &Hdf5File<'_>, path: &str) -> LoadError {
    file.context().bad_input_error(
        path,
        "it is missing, or lies in another file, which is not followed",
        "open the file in which it lies, or export the volumes into one file",
    )
}

/// Factors by which each level is coarser along x, y and z.
fn resolutions(file: &Hdf5File<'_>, root: &Hdf5Object, setup: &str) -> Result<Vec<[f64; 3]>, LoadError> {
    let path = format!("{setup}/resolutions");
    let Some(object) = object_at(file, root, &path)? else { return Ok(Vec::new()) };
    let read = Hdf5Array::open(file, &object, &path)
        .and_then(|array| read_numbers(file, (&path, &array), 3 * MAX_LEVELS as u64));
    let numbers = partial(read)?.unwrap_or_default();
    Ok(numbers.as_chunks::<3>().0.to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_steps_are_told_from_other_names() {
        assert!(is_time_step("t00000") && is_time_step("t123456"));
        for name in ["t0", "t0000x", "time00", "s00000", "t"] {
            assert!(!is_time_step(name), "{name}");
        }
    }
}
