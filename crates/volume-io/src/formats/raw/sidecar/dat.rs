//! DAT, descriptions of raw files as lines of keys and values, written by Voreen and Inviwo, and before them by
//! programs of the University of Stuttgart.

use super::super::super::LoadError;
use super::super::storage::RawStorage;
use super::RawDescription;
use super::values::{
    bad_value, find_value, lines, missing_key, parse_byte_order, parse_number_type, parse_three,
    placement_from_spacing,
};
use chiaroscuro_volume::{LoadContext, Modality};

/// Keys that name the file of voxels.
const DATA: [&str; 2] = ["objectfilename", "rawfile"];

/// Returns true if a file with this beginning is such a description.
pub(super) fn is_dat(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    // Binary voxels may contain any word, but hardly a whole line of this form.
    lines(&text).iter().any(|(key, _)| DATA.contains(&key.as_str()))
}

pub(super) fn parse(context: LoadContext<'_>, text: &str) -> Result<RawDescription, LoadError> {
    let pairs = lines(text);
    let data = find_value(&pairs, &DATA).ok_or_else(|| missing_key(context, "ObjectFileName"))?;
    let said = find_value(&pairs, &["resolution", "dimension", "dimensions"])
        .ok_or_else(|| missing_key(context, "Resolution"))?;
    let dims =
        parse_three(said).ok_or_else(|| bad_value(context, "Resolution", said, "three numbers of voxels"))?;
    let said = find_value(&pairs, &["format"]).ok_or_else(|| missing_key(context, "Format"))?;
    let (kind, mut components) = parse_number_type(said)
        .ok_or_else(|| bad_value(context, "Format", said, "a number type like UCHAR"))?;
    let mut form = RawStorage::new(dims, "Resolution", kind);
    // Voreen gives the number of components in another line.
    if components == 1 {
        components = match find_value(&pairs, &["objectmodel"]).map(str::to_uppercase).as_deref() {
            Some("LA" | "RG") => 2,
            Some("RGB" | "BGR" | "VECTOR") => 3,
            Some("RGBA" | "BGRA") => 4,
            _ => 1,
        };
    }
    form.components = components;
    form.is_color = components > 2;
    if let Some(said) = find_value(&pairs, &["byteorder", "endianness", "endian"]) {
        form.endian = parse_byte_order(said)
            .ok_or_else(|| bad_value(context, "ByteOrder", said, "LittleEndian or BigEndian"))?;
    }
    if let Some(said) = find_value(&pairs, &["byteoffset"]) {
        form.offset =
            Some(said.parse().map_err(|_error| bad_value(context, "ByteOffset", said, "a number of bytes"))?);
    }
    if let Some(said) = find_value(&pairs, &["sequences"]) {
        let frames = said.parse().ok().filter(|&n| n > 0);
        form.frames = frames.ok_or_else(|| bad_value(context, "Sequences", said, "a number of volumes"))?;
    }
    let spacing = find_value(&pairs, &["spacing", "slicethickness"]).and_then(parse_three::<f64>);
    let vectors = ["basisvector1", "basisvector2", "basisvector3"]
        .map(|key| find_value(&pairs, &[key]).and_then(parse_three::<f64>));
    form.placement = match (spacing, vectors) {
        // Edges of the whole volume in units of Inviwo's scene: only their ratios are known.
        (None, [Some(x), Some(y), Some(z)]) => {
            let edges = [x, y, z].map(|edge| glam::DVec3::from(edge).length());
            let steps = std::array::from_fn(|axis| edges[axis] / dims[axis].max(1) as f64);
            placement_from_spacing(Some(steps)).with_unknown_scale()
        }
        _ => placement_from_spacing(spacing),
    };
    form.hints.modality = find_value(&pairs, &["modality"]).map(Modality::from_code).unwrap_or_default();
    form.hints.set_unit(find_value(&pairs, &["unit", "valueunit"]).unwrap_or_default());
    Ok(RawDescription { data_file: Some(data.to_owned()), storage: form })
}
