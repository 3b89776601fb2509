//! IVF, Inviwo's volumes: descriptions of raw files in XML.

use roxmltree::Node;

use super::super::super::LoadError;
use super::super::super::placement::GridPlacement;
use super::super::storage::RawStorage;
use super::RawDescription;
use super::values::{bad_value, missing_key, parse_byte_order, parse_number_type};
use chiaroscuro_files::xml;
use chiaroscuro_volume::LoadContext;

/// Returns true if a file with this beginning is such a description.
pub(super) fn is_ivf(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    text.trim_start_matches('\u{feff}').trim_start().starts_with('<') && text.contains("<RawFile")
}

pub(super) fn parse(context: LoadContext<'_>, text: &str) -> Result<RawDescription, LoadError> {
    let document = xml::parse(text)
        .map_err(|error| context.bad_input_error("XML", error.to_string(), "copy the description again"))?;
    let node = |name: &str| document.descendants().find(|node| node.has_tag_name(name));
    let content = |name: &str| node(name).and_then(|node| node.attribute("content")).map(str::trim);
    let data = content("RawFile").ok_or_else(|| missing_key(context, "RawFile"))?;
    let said =
        node("Dimension").or_else(|| node("Dimensions")).ok_or_else(|| missing_key(context, "Dimension"))?;
    let dims = parse_three_attributes(said)
        .ok_or_else(|| bad_value(context, "Dimension", "", "x, y and z as numbers of voxels"))?;
    let said = content("Format").ok_or_else(|| missing_key(context, "Format"))?;
    let (kind, components) = parse_number_type(said)
        .ok_or_else(|| bad_value(context, "Format", said, "a number type like UINT8"))?;
    let mut form = RawStorage::new(dims, "Dimension", kind);
    form.components = components;
    form.is_color = components > 2;
    if let Some(said) = content("ByteOffset") {
        form.offset =
            Some(said.parse().map_err(|_error| bad_value(context, "ByteOffset", said, "a number of bytes"))?);
    }
    if let Some(said) = content("LittleEndian").or_else(|| content("ByteOrder")) {
        form.endian =
            parse_byte_order(said).ok_or_else(|| bad_value(context, "LittleEndian", said, "1 or 0"))?;
    }
    // Edges of the whole volume in units of Inviwo's scene: only their ratios are known.
    let edges = node("BasisAndOffset").map(|basis| {
        ["col0", "col1", "col2"].map(|name| {
            let column = basis.children().find(|node| node.has_tag_name(name));
            column.and_then(parse_three_attributes::<f64>).map(|edge| glam::DVec3::from(edge).length())
        })
    });
    if let Some([Some(x), Some(y), Some(z)]) = edges {
        let steps = [x / dims[0].max(1) as f64, y / dims[1].max(1) as f64, z / dims[2].max(1) as f64];
        form.placement = GridPlacement::from_spacing(steps).with_unknown_scale();
    }
    form.hints.set_unit(content("ValueUnit").or_else(|| content("Unit")).unwrap_or_default());
    Ok(RawDescription { data_file: Some(data.to_owned()), storage: form })
}

/// Parses the attributes x, y and z of an element.
fn parse_three_attributes<T: std::str::FromStr>(node: Node<'_, '_>) -> Option<[T; 3]> {
    let number = |name: &str| node.attribute(name)?.trim().parse().ok();
    Some([number("x")?, number("y")?, number("z")?])
}
