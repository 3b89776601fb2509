//! Imaris: levels of resolution, time steps and channels in groups, and what is known about them in attributes that
//! are lists of letters.
//!
//! After the description of the Imaris 5.5 file format by Bitplane
//! (<https://imaris.oxinst.com/support/imaris-file-format>). Arrays are padded to whole chunks.

use super::super::container::{Hdf5Attribute, Hdf5File, Hdf5Object};
use super::super::storage::{ArrayView, Hdf5Array};
use super::array_tree::object_at;
use super::coordinates::attribute_text;
use super::volume_read::{ChosenHdf5Volume, number_type};
use crate::length_unit::millimetres;
use crate::reading::input::stem;
use crate::reading::placement::GridPlacement;
use crate::reading::reader::VolumeSource;
use chiaroscuro_volume::{
    FileDimension, LoadError, Modality, ResolutionLevel, ValueMetadata, Volume, VolumeOffer, VoxelType,
    quoted,
};
use glam::DVec3;

/// Groups of the voxels, and of what is known about them.
pub(super) const DATA: &str = "DataSet";
pub(super) const INFO: &str = "DataSetInfo";

/// Maximum number of channels.
const MAX_CHANNELS: usize = 1024;

/// Level of resolution, finest first.
#[derive(Debug, Clone)]
struct ImarisLevel {
    /// Path of its group.
    path: String,
}

/// Image of a channel and time step at one level.
struct LevelImage {
    path: String,
    array: Hdf5Array,
    /// Voxels without the padding.
    dims: [u64; 3],
}

impl LevelImage {
    /// Reads the description of the image in a group.
    fn read(file: &Hdf5File<'_>, root: &Hdf5Object, path: &str) -> Result<Self, LoadError> {
        let group = object_at(file, root, path)?.ok_or_else(|| missing(file, path))?;
        let path = format!("{path}/Data");
        let data = object_at(file, root, &path)?.ok_or_else(|| missing(file, &path))?;
        let array = Hdf5Array::open(file, &data, &path)?;
        let bad = |field: &str, why| {
            let field = format!("{path}{field}");
            file.context().bad_input_error(&field, why, "check that the file is complete")
        };
        let [depth, height, width] = array.shape[..] else {
            return Err(bad("", format!("three dimensions were expected, it has {}", array.shape.len())));
        };
        let stored = [width, height, depth];
        let dims = channel_dims(file, &group)?.unwrap_or(stored);
        if (0..3).any(|at| dims[at] > stored[at]) {
            let [x, y, z] = dims;
            let why =
                format!("{x} x {y} x {z} voxels were announced, {width} x {height} x {depth} are stored");
            return Err(bad(", ImageSizeX", why));
        }
        Ok(Self { path, array, dims })
    }

    fn level(&self) -> ResolutionLevel {
        let voxel_type = number_type(&self.array).map_or(VoxelType::F64, |(number, _)| number.voxel_type());
        ResolutionLevel { name: String::new(), dims: self.dims, voxel_type }
    }
}

/// Loads the chosen channel and time step.
pub(super) fn load(source: &mut VolumeSource<'_>, file: &Hdf5File<'_>) -> Result<Volume, LoadError> {
    let root = file.root()?;
    let levels = levels(file, &root)?;
    let Some(level) = levels.first() else { return Err(missing(file, "DataSet/ResolutionLevel 0")) };
    let group = |path: &str| object_at(file, &root, path)?.ok_or_else(|| missing(file, path));
    let times = numbered_members(file, &group(&level.path)?, "TimePoint ")?;
    let Some(&first_time) = times.first() else { return Err(missing(file, "TimePoint 0")) };
    let channels =
        numbered_members(file, &group(&format!("{}/TimePoint {first_time}", level.path))?, "Channel ")?;
    if channels.is_empty() || channels.len() > MAX_CHANNELS {
        return Err(missing(file, "Channel 0"));
    }
    let image = object_at(file, &root, &format!("{INFO}/Image"))?;
    let image = image.map_or_else(|| Ok(Vec::new()), |image| image.attributes(file))?;

    // Sizes are those of the first channel, until the chosen one is known.
    let sizes = channel_dims(
        file,
        &group(&format!("{}/TimePoint {first_time}/Channel {}", level.path, channels[0]))?,
    )?;
    let dims = sizes.or(image_dims(file, &image)?).unwrap_or([0; 3]);
    let mut offers = Vec::new();
    for (at, number) in channels.iter().enumerate() {
        let info = object_at(file, &root, &format!("{INFO}/Channel {number}"))?;
        let info = info.map_or_else(|| Ok(Vec::new()), |info| info.attributes(file))?;
        let mut offer = VolumeOffer::with_number(at, &attribute_text(file, &info, "Name")?, dims);
        offer.color = parse_color(&attribute_text(file, &info, "Color")?);
        offers.push(offer);
    }
    let context = file.context();
    let title = offers.clone();
    let channel = context.resolve_choice(&source.options.choice, FileDimension::Channel, offers)?;
    let count = times.len() as u64;
    let time = source.choose_numbered(context, FileDimension::Frame, count, dims, |_| String::new())?;

    let place = format!("TimePoint {}/Channel {}", times[time], channels[channel]);
    let images = levels
        .iter()
        .map(|level| LevelImage::read(file, &root, &format!("{}/{place}", level.path)))
        .collect::<Result<Vec<_>, _>>()?;
    let known: Vec<ResolutionLevel> = images.iter().map(LevelImage::level).collect();
    let limits = source.options.limits(source.control);
    let LevelImage { path, array, dims } = &images[limits.choose_level(context, &known)?];
    let dims = *dims;
    let mut hints = ValueMetadata::default();
    hints.modality = Modality::LightMicroscopy;
    hints.set_acquisition(
        &attribute_text(file, &image, "Description")?.replace("(description not specified)", ""),
    );
    let name = match title.get(channel).map_or("", |offer| offer.name.as_str()) {
        "" => stem(source.path),
        channel => chiaroscuro_files::sanitised(&format!("{} {channel}", stem(source.path)), 120),
    };
    let view = ArrayView { first: vec![0; 3], axes: [Some(2), Some(1), Some(0)], component_axis: None, dims };
    let placement = placement(file, &image, dims)?;
    let components = (1, false);
    let (scale, meant_number) = ([1.0, 0.0], None);
    ChosenHdf5Volume { name, path, array, view, components, placement, hints, scale, meant_number }
        .load(source, file)
}

/// Returns the levels of resolution, finest first.
fn levels(file: &Hdf5File<'_>, root: &Hdf5Object) -> Result<Vec<ImarisLevel>, LoadError> {
    let data = object_at(file, root, DATA)?.ok_or_else(|| missing(file, DATA))?;
    let numbers = numbered_members(file, &data, "ResolutionLevel ")?;
    Ok(numbers
        .into_iter()
        .map(|number| ImarisLevel { path: format!("{DATA}/ResolutionLevel {number}") })
        .collect())
}

fn missing(file: &Hdf5File<'_>, path: &str) -> LoadError {
    let why = format!("the group {} is missing", quoted(path));
    file.context().bad_input_error(DATA, why, "check that the file is complete")
}

/// Numbers of the members of a group that have a name and a number, in order.
fn numbered_members(file: &Hdf5File<'_>, group: &Hdf5Object, name: &str) -> Result<Vec<u32>, LoadError> {
    let links = group.links(file)?;
    let mut numbers: Vec<u32> =
        links.iter().filter_map(|link| link.name.strip_prefix(name)?.parse().ok()).collect();
    numbers.sort_unstable();
    Ok(numbers)
}

/// Voxels of a channel without the padding.
fn channel_dims(file: &Hdf5File<'_>, channel: &Hdf5Object) -> Result<Option<[u64; 3]>, LoadError> {
    let attributes = channel.attributes(file)?;
    sizes(file, &attributes, ["ImageSizeX", "ImageSizeY", "ImageSizeZ"])
}

/// Voxels of the finest level.
fn image_dims(file: &Hdf5File<'_>, image: &[Hdf5Attribute]) -> Result<Option<[u64; 3]>, LoadError> {
    sizes(file, image, ["X", "Y", "Z"])
}

/// Three sizes in attributes, if all are there.
fn sizes(
    file: &Hdf5File<'_>,
    attributes: &[Hdf5Attribute],
    names: [&str; 3],
) -> Result<Option<[u64; 3]>, LoadError> {
    let mut sizes = [0; 3];
    for (size, name) in sizes.iter_mut().zip(names) {
        *size = attribute_text(file, attributes, name)?.trim().parse().unwrap_or(0);
    }
    Ok((!sizes.contains(&0)).then_some(sizes))
}

/// Placement by the extent of the image, which reaches from face to face.
fn placement(
    file: &Hdf5File<'_>,
    image: &[Hdf5Attribute],
    dims: [u64; 3],
) -> Result<GridPlacement, LoadError> {
    let mut ends = [[f64::NAN; 2]; 3];
    for (axis, ends) in ends.iter_mut().enumerate() {
        for (end, name) in ends.iter_mut().zip(["ExtMin", "ExtMax"]) {
            let text = attribute_text(file, image, &format!("{name}{axis}"))?;
            *end = text.trim().parse().unwrap_or(f64::NAN);
        }
    }
    let said = attribute_text(file, image, "Unit")?;
    let unit = millimetres(&said).unwrap_or(1e-3);
    let steps: [f64; 3] =
        std::array::from_fn(|at| (ends[at][1] - ends[at][0]) / dims[at].max(1) as f64 * unit);
    if steps.iter().any(|step| !step.is_finite() || *step == 0.0) {
        let remark = "the extent of the image is missing: voxels are taken for cubes";
        return Ok(GridPlacement::unknown().with_remark(Some(remark)));
    }
    let mut placement = GridPlacement::from_spacing(steps.map(f64::abs)).with_length_unit(unit);
    let centre = |at: usize| ends[at][0].min(ends[at][1]) * unit + steps[at].abs() / 2.0;
    placement.world_from_index.translation = DVec3::new(centre(0), centre(1), centre(2));
    Ok(placement)
}

/// Parses a colour: red, green and blue from 0 to 1.
fn parse_color(text: &str) -> Option<[u8; 3]> {
    let mut parts =
        text.split_whitespace().map(|part| part.parse::<f64>().ok().filter(|part| part.is_finite()));
    let mut part = || Some((parts.next()??.clamp(0.0, 1.0) * 255.0).round() as u8);
    Some([part()?, part()?, part()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_parsed() {
        assert_eq!(parse_color("1.000 0.500 0.000"), Some([255, 128, 0]));
        assert_eq!(parse_color("1 2 -1"), Some([255, 255, 0]));
        for text in ["", "1 0", "1 x 0", "nan 0 0"] {
            assert_eq!(parse_color(text), None, "{text}");
        }
    }
}
