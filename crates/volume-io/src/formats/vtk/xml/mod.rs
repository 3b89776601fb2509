//! VTK images in XML: `<VTKFile type="ImageData">`.
//!
//! Values are numbers as text, or bytes, either in base64 or raw; they are inside their elements, or appended at the
//! end of the file. Images of several pieces, as parallel programs write them, are not assembled.

mod base64;
mod blocks;
mod markup;
#[cfg(test)]
mod tests;

use std::io::Read;

use glam::{DMat3, DVec3};
use roxmltree::Node;

use super::super::number::FileNumberType;
use super::super::reader::{FileStart, VolumeSource};
use super::super::text_numbers::TextNumbers;
use super::super::voxels::ReadVoxels;
use super::super::{Endian, LoadControl, LoadError};
use super::RESAMPLE;
use super::image::{
    ChosenVtkArray, MAX_ARRAYS, MAX_COMPONENTS, VtkArray, VtkGrid, check_available, choose_array,
    content_error, open_content_at,
};
use base64::{Base64Reader, max_decoded_bytes};
use blocks::{CompressedBlocks, Compressor, HeaderWords, check_length};
use chiaroscuro_files::{sanitised, xml};
use chiaroscuro_volume::{LoadContext, Volume, human_bytes, quoted};
use markup::VtkMarkup;

/// Arrays with which VTK marks missing or duplicate points; they are not offered.
const GHOST_ARRAYS: [&str; 2] = ["vtkGhostType", "vtkValidPointMask"];

/// Returns true if a file with this beginning is VTK XML.
pub(super) fn is_xml(start: &FileStart) -> bool {
    const MARK: &[u8] = b"<VTKFile";
    let bytes = start.bytes();
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes).trim_ascii_start();
    bytes.starts_with(b"<") && bytes.windows(MARK.len()).any(|window| window == MARK)
}

/// Encoding of the values in a file.
#[derive(Debug, Clone)]
struct VtkEncoding {
    words: HeaderWords,
    /// Compressor of binary values; an unsupported one, by its name, is an error only where an array uses it.
    compressor: Option<Result<Compressor, String>>,
    /// True if appended data are in base64.
    appends_text: bool,
}

/// Location and encoding of an array's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum XmlValueLocation {
    /// Numbers as text: offset in the file and length, in bytes.
    Ascii(u64, u64),
    /// Base64: offset in the file and length, in bytes.
    Base64(u64, u64),
    /// Appended data: offset within them, in bytes.
    Appended(u64),
}

pub(super) fn load(mut source: VolumeSource<'_>) -> Result<Volume, LoadError> {
    let context = LoadContext { operation: "read the VTK image", path: source.path };
    let control = source.control;
    let skeleton = VtkMarkup::read(context, &mut open_content_at(context, &mut source, 0)?, control)?;
    let document = xml::parse(&skeleton.markup)
        .map_err(|error| context.bad_input_error("markup", error.to_string(), "copy the file again"))?;
    let root = document.root_element();
    let piece = find_piece(context, root)?;
    let grid = grid(context, piece)?;
    let style = value_encoding(context, root)?;
    let arrays = arrays(context, piece, &grid)?;
    let chosen = choose_array(context, &grid, arrays, source.options, source.control)?;
    let voxels = read(context, &mut source, &chosen, style, skeleton.appended)?;
    chosen.volume(context, &grid, voxels, "", control)
}

/// Finds the single piece of the image.
fn find_piece<'a, 'input>(
    context: LoadContext<'_>,
    root: Node<'a, 'input>,
) -> Result<Node<'a, 'input>, LoadError> {
    let kind = root.attribute("type").unwrap_or_default();
    if root.tag_name().name() != "VTKFile" {
        return Err(context.bad_input_error(
            "VTKFile",
            "its root element is not VTKFile",
            "check the file's format",
        ));
    }
    if kind == "PImageData" {
        return Err(context.bad_input_error(
            "type",
            "it only names the files of its pieces",
            "open one of those, or open it in ParaView and save it as .vti",
        ));
    }
    if kind != "ImageData" {
        return Err(context.bad_input_error(
            "type",
            format!("{} is not a regular grid", quoted(kind)),
            RESAMPLE,
        ));
    }
    let pieces: Vec<_> = root
        .children()
        .filter(|node| node.has_tag_name("ImageData"))
        .flat_map(|image| image.children())
        .filter(|node| node.has_tag_name("Piece"))
        .collect();
    match pieces[..] {
        [piece] => Ok(piece),
        [] => Err(context.bad_input_error("Piece", "it has no piece with values", "write the file again")),
        [..] => Err(context.bad_input_error(
            "Piece",
            format!("it is in {} pieces, and only one is supported", pieces.len()),
            "open it in ParaView and save it as one .vti",
        )),
    }
}

/// Grid of a piece, which may be a part of the whole image.
fn grid(context: LoadContext<'_>, piece: Node<'_, '_>) -> Result<VtkGrid, LoadError> {
    let image = piece.parent().unwrap_or(piece);
    let whole = image.attribute("WholeExtent");
    let wrong = |field: &str, text: &str, what: &str| {
        context.bad_input_error(
            field,
            format!("{what} were expected, {} was found", quoted(text)),
            "correct the file",
        )
    };
    let text = piece.attribute("Extent").or(whole).unwrap_or_default();
    let extent: Option<Vec<i64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    let mut grid = extent
        .and_then(|extent| VtkGrid::from_extent(extent.try_into().ok()?))
        .ok_or_else(|| wrong("Extent", text, "the first and last index along x, y and z"))?;
    if whole.is_some_and(|whole| !whole.split_whitespace().eq(text.split_whitespace())) {
        context.warn("its piece is not the whole image");
    }
    let numbers = |field: &str, count: usize| match image.attribute(field) {
        None => Ok(None),
        Some(text) => {
            let found: Option<Vec<f64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
            let found = found.filter(|found| found.len() == count);
            found.map(Some).ok_or_else(|| wrong(field, text, &format!("{count} numbers")))
        }
    };
    if let Some(origin) = numbers("Origin", 3)? {
        grid.origin = DVec3::from_slice(&origin);
    }
    if let Some(spacing) = numbers("Spacing", 3)? {
        grid.spacing = DVec3::from_slice(&spacing);
        grid.has_spacing = true;
    }
    if let Some(direction) = numbers("Direction", 9)? {
        // The file has the matrix row by row.
        grid.direction = DMat3::from_cols_slice(&direction).transpose();
    }
    Ok(grid)
}

/// Encoding of the values, by the attributes of the root element.
fn value_encoding(context: LoadContext<'_>, root: Node<'_, '_>) -> Result<VtkEncoding, LoadError> {
    let refused = |field: &str, text: &str, known: &str, help: &str| {
        Err(context.bad_input_error(field, format!("{known} is supported, {} is not", quoted(text)), help))
    };
    let endian = match root.attribute("byte_order") {
        None | Some("LittleEndian") => Endian::Little,
        Some("BigEndian") => Endian::Big,
        Some(other) => return refused("byte_order", other, "LittleEndian or BigEndian", "correct the file"),
    };
    let are_long = match root.attribute("header_type") {
        None | Some("UInt32") => false,
        Some("UInt64") => true,
        Some(other) => {
            return refused("header_type", other, "UInt32 or UInt64", "write it again with UInt64");
        }
    };
    let compressor = match root.attribute("compressor") {
        None | Some("") => None,
        Some("vtkZLibDataCompressor") => Some(Ok(Compressor::Zlib)),
        Some("vtkLZ4DataCompressor") => Some(Ok(Compressor::Lz4)),
        Some(other) => Some(Err(other.to_owned())),
    };
    let appended = root.children().find(|node| node.has_tag_name("AppendedData"));
    let appends_text = match appended.and_then(|node| node.attribute("encoding")) {
        None | Some("raw") => false,
        Some("base64") => true,
        Some(other) => return refused("AppendedData", other, "raw or base64", "write it again as raw"),
    };
    Ok(VtkEncoding { words: HeaderWords { are_64_bit: are_long, endian }, compressor, appends_text })
}

/// Numeric arrays with a value for each point or cell.
fn arrays(
    context: LoadContext<'_>,
    piece: Node<'_, '_>,
    grid: &VtkGrid,
) -> Result<Vec<VtkArray<XmlValueLocation>>, LoadError> {
    let mut found = Vec::new();
    for (group, of_cells) in [("PointData", false), ("CellData", true)] {
        let groups = piece.children().filter(|node| node.has_tag_name(group));
        let nodes = groups.flat_map(|node| node.children()).filter(|node| node.has_tag_name("DataArray"));
        for node in nodes.take(MAX_ARRAYS) {
            let name = sanitised(node.attribute("Name").unwrap_or_default().trim(), 80);
            let Some(number) = node.attribute("type").and_then(number) else {
                let kind = quoted(node.attribute("type").unwrap_or_default());
                context.warn(format_args!("the array {} of type {kind} is ignored", quoted(&name)));
                continue;
            };
            let text = node.attribute("NumberOfComponents").unwrap_or("1");
            let components = text.parse().ok().filter(|count| (1..=MAX_COMPONENTS).contains(count));
            let components = components.ok_or_else(|| {
                let why =
                    format!("a number from 1 to {MAX_COMPONENTS} was expected, {} was found", quoted(text));
                context.bad_input_error("NumberOfComponents", why, "correct the file")
            })?;
            let tuples = node.attribute("NumberOfTuples").and_then(|text| text.parse::<u64>().ok());
            if tuples.is_some_and(|tuples| tuples != grid.count(of_cells)) {
                context
                    .warn(format_args!("the array {} does not fit the grid, and is ignored", quoted(&name)));
                continue;
            }
            let place = value_location(context, node)?;
            // VTK's default mapping: such arrays are colours.
            let is_color = number == FileNumberType::U8 && (3..=4).contains(&components);
            found.push(VtkArray {
                name,
                number,
                components,
                is_cell_data: of_cells,
                is_color,
                location: place,
            });
        }
    }
    if found.iter().any(|array| !GHOST_ARRAYS.contains(&array.name.as_str())) {
        found.retain(|array| !GHOST_ARRAYS.contains(&array.name.as_str()));
    }
    Ok(found)
}

/// Parses the name of a number type.
fn number(word: &str) -> Option<FileNumberType> {
    Some(match word {
        "Int8" => FileNumberType::I8,
        "UInt8" => FileNumberType::U8,
        "Int16" => FileNumberType::I16,
        "UInt16" => FileNumberType::U16,
        "Int32" => FileNumberType::I32,
        "UInt32" => FileNumberType::U32,
        "Int64" => FileNumberType::I64,
        "UInt64" => FileNumberType::U64,
        "Float32" => FileNumberType::F32,
        "Float64" => FileNumberType::F64,
        _ => return None,
    })
}

/// Location of the values of an element.
fn value_location(context: LoadContext<'_>, node: Node<'_, '_>) -> Result<XmlValueLocation, LoadError> {
    // The skeleton has two numbers in place of text, and nothing for an empty element.
    let inline = || {
        let texts = node.children().filter_map(|child| child.text().filter(|_| child.is_text()));
        let mut places = texts.filter_map(|text| {
            let (start, length) = text.split_once(' ')?;
            Some((start.parse::<u64>().ok()?, length.parse::<u64>().ok()?))
        });
        places.next().unwrap_or((0, 0))
    };
    match node.attribute("format").unwrap_or("ascii") {
        "ascii" => Ok(inline()).map(|(start, length)| XmlValueLocation::Ascii(start, length)),
        "binary" => Ok(inline()).map(|(start, length)| XmlValueLocation::Base64(start, length)),
        "appended" => {
            let text = node.attribute("offset").unwrap_or_default();
            text.parse().map(XmlValueLocation::Appended).map_err(|_no_number| {
                let why = format!("a number of bytes was expected, {} was found", quoted(text));
                context.bad_input_error("offset", why, "write the file again")
            })
        }
        other => Err(context.bad_input_error(
            "format",
            format!("ascii, binary or appended was expected, {} was found", quoted(other)),
            "write the file again",
        )),
    }
}

/// Reads the values of the chosen array.
fn read(
    context: LoadContext<'_>,
    source: &mut VolumeSource<'_>,
    chosen: &ChosenVtkArray<XmlValueLocation>,
    style: VtkEncoding,
    appended: Option<u64>,
) -> Result<ReadVoxels, LoadError> {
    let (control, budget) = (source.control, source.options.memory_budget_bytes);
    let name = chosen.array.name.as_str();
    match chosen.array.location {
        XmlValueLocation::Ascii(start, length) => {
            // At least a digit and a space each.
            check_available(context, name, chosen.numbers(), length.div_ceil(2), "numbers")?;
            let text = open_content_at(context, source, start)?.take(length);
            let mut numbers = TextNumbers::new(text, chosen.array.number, chosen.numbers());
            // Text has no byte order: the adapter yields little-endian numbers.
            chosen.read(context, &mut numbers, Endian::Little, control)
        }
        XmlValueLocation::Base64(start, length) => {
            let text = open_content_at(context, source, start)?.take(length);
            let room = max_decoded_bytes(length);
            read_binary(context, Base64Reader::new(text), chosen, style, Some(room), budget, control)
        }
        XmlValueLocation::Appended(offset) => {
            let start = appended.and_then(|appended| appended.checked_add(offset)).ok_or_else(|| {
                context.bad_input_error(
                    "AppendedData",
                    "the appended data are missing",
                    "copy the file again",
                )
            })?;
            let room = (!source.start.is_gzip()).then(|| source.input.len.saturating_sub(start));
            let content = open_content_at(context, source, start)?;
            if style.appends_text {
                read_binary(
                    context,
                    Base64Reader::new(content),
                    chosen,
                    style,
                    room.map(max_decoded_bytes),
                    budget,
                    control,
                )
            } else {
                read_binary(context, content, chosen, style, room, budget, control)
            }
        }
    }
}

/// Reads binary values; `room` is the number of bytes left in the file, and `budget_bytes` the limit for the volume
/// and one block.
fn read_binary(
    context: LoadContext<'_>,
    mut reader: impl Read,
    chosen: &ChosenVtkArray<XmlValueLocation>,
    style: VtkEncoding,
    room: Option<u64>,
    budget_bytes: u64,
    control: &LoadControl,
) -> Result<ReadVoxels, LoadError> {
    let VtkEncoding { words, compressor, .. } = style;
    let expected = chosen.stored_bytes();
    let compressor = compressor.transpose().map_err(|other| {
        let why =
            format!("vtkZLibDataCompressor or vtkLZ4DataCompressor is supported, {} is not", quoted(&other));
        context.bad_input_error("compressor", why, "write it again with one of those, or uncompressed")
    })?;
    let Some(compressor) = compressor else {
        check_length(&mut reader, words, expected).map_err(|error| content_error(context, error))?;
        check_available(context, &chosen.array.name, expected, room.unwrap_or(expected), "bytes")?;
        return chosen.read(context, &mut reader, words.endian, control);
    };
    let blocks = CompressedBlocks::open(reader, words, compressor, expected, room);
    let mut blocks = blocks.map_err(|error| content_error(context, error))?;
    let needed = chosen.extent.bytes.saturating_add(blocks.needed_bytes());
    if needed > budget_bytes {
        return Err(context.limit_error(
            &chosen.array.name,
            format!(
                "the volume and a compressed block of it need {}, {} are allowed",
                human_bytes(needed.into()),
                human_bytes(budget_bytes.into())
            ),
            "close other programs, or write the file again with smaller blocks",
        ));
    }
    chosen.read(context, &mut blocks, words.endian, control)
}
