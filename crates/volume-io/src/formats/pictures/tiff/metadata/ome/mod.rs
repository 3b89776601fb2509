//! OME-TIFF metadata: XML in the description of the first page.
//!
//! After the specification at <https://docs.openmicroscopy.org/ome-model/latest/ome-tiff/specification.html>. Pages
//! may lie in several files beside each other; the assignment is repeated in all of them, or in one XML file.

mod pages;

use std::path::PathBuf;

use roxmltree::{Document, Node};

use super::super::file::TiffFile;
use super::super::file::page::SampleMeaning;
use super::super::messages::HELP;
use super::super::stack::{TiffSlice, TiffStack};
use crate::formats::pictures::channels_and_times::ChannelsAndTimes;
use crate::formats::pictures::gaps::{ANNOUNCED_PAGES, SliceRun};
use crate::length_unit::millimetres;
use crate::reading::companion_path;
use crate::reading::placement::GridPlacement;
use chiaroscuro_files::{sanitised, xml};
use chiaroscuro_volume::{
    FileDimension, LoadContext, LoadControl, LoadError, Modality, ValueMetadata, VolumeChoice, VolumeOffer,
    quoted,
};
use pages::OmePages;

/// Maximum length of the XML, in bytes: for ten thousand files it has a few million.
pub(crate) const MAX_XML_BYTES: u64 = xml::MAX_XML_BYTES as u64;

/// Maximum number of images that a file may offer: a plate of 1536 wells with ten fields each.
const MAX_IMAGES: usize = 1 << 14;

/// Returns true if a description is OME-XML.
pub(crate) fn is_ome(description: &str) -> bool {
    // After a byte order mark, a declaration and a comment, which some writers put first.
    let head: String = description.chars().take(2000).collect();
    head.trim_start_matches('\u{feff}').trim_start().starts_with('<')
        && (head.contains("<OME") || head.contains(":OME"))
}

fn parsed<'a>(context: LoadContext<'_>, text: &'a str) -> Result<Document<'a>, LoadError> {
    xml::parse(text).map_err(|error| context.bad_input_error("OME-XML", error.to_string(), HELP))
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    children(node, name).next()
}

pub(super) fn children<'a, 'i>(node: Node<'a, 'i>, name: &str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

/// Parses an attribute as a number.
pub(super) fn number<T: std::str::FromStr>(node: Node<'_, '_>, name: &str) -> Option<T> {
    node.attribute(name)?.trim().parse().ok()
}

/// Numbers of voxels, channels and time steps of an image.
pub(super) struct OmeSizes {
    pub(super) dims: [u64; 3],
    /// Number of channels of pages: a colour counts as one.
    pub(super) channels: usize,
    pub(super) frames: usize,
    /// Order of z, channel and time in the file, fastest first, by the letters of `DimensionOrder`.
    pub(super) order: [char; 3],
}

impl OmeSizes {
    /// Reads the sizes from the attributes of `ExrPixels`; `samples` is the number of samples per pixel.
    ///
    /// # Errors
    /// `BadInput` for implausible sizes.
    fn parse(context: LoadContext<'_>, pixels: Node<'_, '_>, samples: usize) -> Result<Self, LoadError> {
        let size = |name: &str| {
            number::<u64>(pixels, name).filter(|size| (1..=1 << 31).contains(size)).ok_or_else(|| {
                let said = quoted(pixels.attribute(name).unwrap_or_default());
                context.bad_input_error(name, format!("{said} is not a valid size"), HELP)
            })
        };
        let dims = [size("SizeX")?, size("SizeY")?, size("SizeZ")?];
        // `SizeC` counts samples: a colour is three.
        let channels = (size("SizeC")? as usize).div_ceil(samples.max(1));
        let letters: Vec<char> = pixels.attribute("DimensionOrder").unwrap_or("XYZCT").chars().collect();
        let order = match letters.as_slice() {
            &['X', 'Y', a, b, c] if ['Z', 'C', 'T'].iter().all(|letter| [a, b, c].contains(letter)) => {
                [a, b, c]
            }
            _ => {
                let said = quoted(pixels.attribute("DimensionOrder").unwrap_or_default());
                return Err(context.bad_input_error(
                    "DimensionOrder",
                    format!("{said} is not a valid order"),
                    HELP,
                ));
            }
        };
        Ok(Self { dims, channels, frames: size("SizeT")? as usize, order })
    }
}

/// Builds the stack of a file with such a description.
pub(crate) fn stack(
    context: LoadContext<'_>,
    tiff: &TiffFile,
    description: &str,
    choice: &VolumeChoice,
    control: &LoadControl,
) -> Result<TiffStack, LoadError> {
    let document = parsed(context, description)?;
    let root = document.root_element();
    // The full XML may be in a companion file, which all files of a set name.
    if let Some(name) = child(root, "BinaryOnly").and_then(|node| node.attribute("MetadataFile")) {
        let path = companion_path::resolve(context, "MetadataFile", name)?;
        let companion = LoadContext { operation: "read the OME-XML of the volume", path: &path };
        let xml = companion_text(companion, control)?;
        let document = parsed(companion, &xml)?;
        return stack_from_root(context, tiff, document.root_element(), choice);
    }
    stack_from_root(context, tiff, root, choice)
}

/// First existing file with pages of the chosen image, by a companion XML file.
///
/// # Errors
/// `BadInput` where it names none, or one that must not be read; `Io` where none exists.
pub(crate) fn first_file(
    context: LoadContext<'_>,
    xml: &str,
    choice: &VolumeChoice,
) -> Result<PathBuf, LoadError> {
    let document = parsed(context, xml)?;
    let [_, pixels] = chosen_image(context, document.root_element(), choice)?;
    // If so many files are missing, the others will be as well.
    const MAX_LOOKED_FOR: usize = 1 << 12;
    let names = children(pixels, "TiffData").flat_map(|data| children(data, "UUID"));
    let mut names: Vec<&str> = names.filter_map(|uuid| uuid.attribute("FileName")).collect();
    names.dedup();
    let mut lost = None;
    for name in names.into_iter().take(MAX_LOOKED_FOR) {
        match resolve_set_file(context, name) {
            Err(error @ LoadError::Io { .. }) => lost = lost.or(Some(error)),
            found => return found,
        }
    }
    Err(lost.unwrap_or_else(|| {
        let why = "it names no TIFF files with its pages";
        context.bad_input_error("TiffData", why, "open the TIFF files themselves")
    }))
}

/// Returns true for a generic name: some programs just count images, as in `Image0` and `FitsImage:0`.
fn is_generic_name(name: &str) -> bool {
    let number = name.strip_prefix("Image").unwrap_or(name).trim_start_matches([':', ' ', '_']);
    name.is_empty() || name.starts_with("Image") && number.bytes().all(|byte| byte.is_ascii_digit())
}

/// Reads the text of a companion XML file.
pub(crate) fn companion_text(context: LoadContext<'_>, control: &LoadControl) -> Result<String, LoadError> {
    use std::io::Read as _;
    let input = crate::reading::input::InputFile::open(context)?;
    control.record_read(context.path);
    let mut text = Vec::new();
    input.reader.take(MAX_XML_BYTES).read_to_end(&mut text).map_err(|error| context.io_error(error))?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}

/// Finds the element of the chosen image, and its `ExrPixels`.
fn chosen_image<'a, 'i>(
    context: LoadContext<'_>,
    root: Node<'a, 'i>,
    choice: &VolumeChoice,
) -> Result<[Node<'a, 'i>; 2], LoadError> {
    let mut images: Vec<[Node<'_, '_>; 2]> =
        children(root, "Image").filter_map(|image| Some([image, child(image, "Pixels")?])).collect();
    if images.len() > MAX_IMAGES {
        let why = format!("it has {} images, {MAX_IMAGES} are allowed", images.len());
        return Err(context.limit_error("Image", why, "split the file into several"));
    }
    let offers: Vec<VolumeOffer> = images
        .iter()
        .enumerate()
        .map(|(at, &[image, pixels])| {
            let size = |name| number(pixels, name).unwrap_or(0);
            VolumeOffer::with_number(at, image_name(image), [size("SizeX"), size("SizeY"), size("SizeZ")])
        })
        .collect();
    if offers.is_empty() {
        return Err(context.bad_input_error("description", "its OME-XML has no image", HELP));
    }
    Ok(images.swap_remove(context.resolve_choice(choice, FileDimension::Series, offers)?))
}

/// Name attribute of an image.
fn image_name<'a>(image: Node<'a, '_>) -> &'a str {
    image.attribute("Name").unwrap_or_default()
}

/// Name of a channel: its own, its dye, or its emission wavelength.
fn channel_name(channel: Node<'_, '_>) -> String {
    let said = |name: &str| channel.attribute(name).map(str::trim).filter(|text| !text.is_empty());
    let wavelength = || {
        let unit = said("EmissionWavelengthUnit").unwrap_or("nm");
        said("EmissionWavelength").map(|length| format!("{length} {unit}"))
    };
    said("Name").or_else(|| said("Fluor")).map(str::to_owned).or_else(wavelength).unwrap_or_default()
}

/// Colour of a channel: red, green, blue and opacity, a byte each, as one signed number. White is what programs write
/// that know none.
fn channel_color(channel: Node<'_, '_>) -> Option<[u8; 3]> {
    // Some write it as an unsigned number.
    let number = number::<i64>(channel, "Color")?;
    let [red, green, blue, _] = u32::try_from(number & 0xffff_ffff).ok()?.to_be_bytes();
    Some([red, green, blue])
}

fn stack_from_root(
    context: LoadContext<'_>,
    tiff: &TiffFile,
    root: Node<'_, '_>,
    choice: &VolumeChoice,
) -> Result<TiffStack, LoadError> {
    let Some(first) = tiff.pages.first() else {
        return Err(context.bad_input_error("pages", "it has no pages", HELP));
    };
    let [image, pixels] = chosen_image(context, root, choice)?;
    let sizes = OmeSizes::parse(context, pixels, first.samples)?;
    let inside = if first.meaning == SampleMeaning::Channels { first.samples } else { 1 };
    let channels = sizes.channels.saturating_mul(inside);
    if channels.saturating_mul(sizes.frames) > super::super::file::directory::MAX_PAGES {
        let why = "the numbers of channels and time steps are implausible";
        return Err(context.bad_input_error("SizeC, SizeT", why, HELP));
    }
    let slices = usize::try_from(sizes.dims[2]).unwrap_or(usize::MAX);
    if slices > super::super::file::directory::MAX_PAGES {
        return Err(context.bad_input_error(
            "SizeZ",
            format!("a number of {slices} slices is implausible"),
            HELP,
        ));
    }
    let pages = OmePages::parse(context, root, pixels, &sizes, tiff.pages.len())?;
    let (frames, channels_there) = (pages.frames(), pages.channels().saturating_mul(inside));
    let steps = ChannelsAndTimes {
        dims: sizes.dims,
        channels: channels_there,
        channel_names: children(pixels, "Channel").map(channel_name).collect(),
        channel_colors: children(pixels, "Channel").map(channel_color).collect(),
        frames,
        frame_names: Vec::new(),
    };
    let chosen = steps.choose(context, choice)?;
    let channel = chosen.channel / inside;
    let wanted: Vec<[usize; 3]> =
        chosen.slices(slices, frames).into_iter().map(|[frame, slice]| [slice, channel, frame]).collect();
    let found = pages.find(context, &wanted)?;
    let Some(SliceRun { slices, remark }) = SliceRun::new(&found.slices, ANNOUNCED_PAGES) else {
        return Err(pages.missing_page_error(context, channel, chosen.frame));
    };
    let mut placement = placement_from_physical_size(pixels);
    check_size(context, tiff, &slices, sizes.dims)?;
    for (there, said, what) in [(frames, sizes.frames, "time steps"), (channels_there, channels, "channels")]
    {
        if there < said {
            let remark = format!("{said} {what} are announced, and there are pages for the first {there}");
            placement.remarks.push(remark);
        }
    }
    placement.remarks.extend(remark);
    placement.remarks.extend(found.missing_files_remark);
    chosen.add_time_remark(&mut placement);
    let name = match image_name(image) {
        name if is_generic_name(name.trim()) => crate::reading::input::stem(context.path),
        name => sanitised(name.trim(), 120),
    };
    Ok(TiffStack {
        name,
        slices,
        other_files: found.other_files,
        sample: (inside > 1).then_some(chosen.channel % inside),
        placement,
        hints: hints(root, image, pixels, channel),
        scale: [1.0, 0.0],
    })
}

/// Checks that pages have the size that the XML announces. Those of other files are compared to the first when they
/// are read.
fn check_size(
    context: LoadContext<'_>,
    tiff: &TiffFile,
    slices: &[Option<TiffSlice>],
    [width, height, _]: [u64; 3],
) -> Result<(), LoadError> {
    let own =
        slices.iter().flatten().find(|slice| slice.file == 0).and_then(|slice| tiff.pages.get(slice.page));
    match own {
        Some(page) if [page.width, page.height] != [width, height] => Err(context.bad_input_error(
            "SizeX, SizeY",
            format!(
                "pages of {width} x {height} pixels are announced, they have {} x {}",
                page.width, page.height
            ),
            HELP,
        )),
        _ => Ok(()),
    }
}

fn placement_from_physical_size(pixels: Node<'_, '_>) -> GridPlacement {
    let length = |axis: &str| {
        let length = number::<f64>(pixels, &format!("PhysicalSize{axis}"))?;
        // Default unit of the data model.
        let unit_mm =
            millimetres(pixels.attribute(format!("PhysicalSize{axis}Unit").as_str()).unwrap_or("µm"))?;
        Some((length * unit_mm, unit_mm)).filter(|(length, _)| length.is_finite() && *length > 0.0)
    };
    if let (Some((x, unit_mm)), Some((y, _)), Some((z, _))) = (length("X"), length("Y"), length("Z")) {
        return GridPlacement::from_spacing([x, y, z]).with_length_unit(unit_mm);
    }
    // Two of the three, as in a picture without depth, are not an error.
    let all = ["PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"];
    let is_wrong = all.iter().all(|size| pixels.has_attribute(*size));
    let remark = is_wrong.then_some("its PhysicalSize is invalid: the voxel size is unknown");
    GridPlacement::unknown().with_remark(remark)
}

/// Acquisition metadata: modality, channel name and dye.
fn hints(root: Node<'_, '_>, image: Node<'_, '_>, pixels: Node<'_, '_>, channel: usize) -> ValueMetadata {
    let mut hints = ValueMetadata::default();
    let channels: Vec<Node<'_, '_>> = children(pixels, "Channel").collect();
    // Wavelengths, dyes and objectives exist only in light microscopy.
    const LIGHT_ATTRIBUTES: [&str; 4] =
        ["EmissionWavelength", "ExcitationWavelength", "Fluor", "IlluminationType"];
    let is_light =
        channels.iter().any(|channel| LIGHT_ATTRIBUTES.iter().any(|name| channel.has_attribute(*name)))
            || child(image, "ObjectiveSettings").is_some()
            || children(root, "Instrument").any(|instrument| child(instrument, "Objective").is_some());
    if is_light {
        hints.modality = Modality::LightMicroscopy;
    }
    let said =
        |name: &str| channels.get(channel).and_then(|channel| channel.attribute(name)).unwrap_or_default();
    let words = [said("Name"), said("Fluor"), said("AcquisitionMode")];
    let words: Vec<&str> = words.into_iter().filter(|word| !word.trim().is_empty()).collect();
    hints.set_acquisition(&words.join(", "));
    hints
}

/// Resolves the path of a file of the set.
pub(super) fn resolve_set_file(context: LoadContext<'_>, name: &str) -> Result<PathBuf, LoadError> {
    companion_path::resolve(context, "FileName", name)
}

#[cfg(test)]
mod tests {
    use super::is_generic_name;

    #[test]
    fn names_that_count_images_say_nothing() {
        for name in ["", "Image0", "Image:0", "Image 12", "Image"] {
            assert!(is_generic_name(name), "{name}");
        }
        for name in ["0", "Images", "Image of a cell", "cell 3", "image1.tif"] {
            assert!(!is_generic_name(name), "{name}");
        }
    }
}
