//! DAT, descriptions of raw files as lines of keys and values, written by Voreen and Inviwo, and before them by
//! programs of the University of Stuttgart.

use super::super::super::LoadError;
use super::super::form::Form;
use super::Described;
use super::words::{bad, find, lines, missing, number, order, placement, three};
use crate::data::Modality;
use crate::data::attempt::Attempt;

/// Keys that name the file of voxels.
const DATA: [&str; 2] = ["objectfilename", "rawfile"];

/// Returns true if a file with this beginning is such a description.
pub(super) fn is_dat(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    // Binary voxels may contain any word, but hardly a whole line of this form.
    lines(&text).iter().any(|(key, _)| DATA.contains(&key.as_str()))
}

pub(super) fn parse(attempt: Attempt<'_>, text: &str) -> Result<Described, LoadError> {
    let pairs = lines(text);
    let data = find(&pairs, &DATA).ok_or_else(|| missing(attempt, "ObjectFileName"))?;
    let said = find(&pairs, &["resolution", "dimension", "dimensions"])
        .ok_or_else(|| missing(attempt, "Resolution"))?;
    let dims = three(said).ok_or_else(|| bad(attempt, "Resolution", said, "three numbers of voxels"))?;
    let said = find(&pairs, &["format"]).ok_or_else(|| missing(attempt, "Format"))?;
    let (kind, mut components) =
        number(said).ok_or_else(|| bad(attempt, "Format", said, "a number type like UCHAR"))?;
    let mut form = Form::new(dims, "Resolution", kind);
    // Voreen gives the number of components in another line.
    if components == 1 {
        components = match find(&pairs, &["objectmodel"]).map(str::to_uppercase).as_deref() {
            Some("LA" | "RG") => 2,
            Some("RGB" | "BGR" | "VECTOR") => 3,
            Some("RGBA" | "BGRA") => 4,
            _ => 1,
        };
    }
    form.components = components;
    form.is_color = components > 2;
    if let Some(said) = find(&pairs, &["byteorder", "endianness", "endian"]) {
        form.endian =
            order(said).ok_or_else(|| bad(attempt, "ByteOrder", said, "LittleEndian or BigEndian"))?;
    }
    if let Some(said) = find(&pairs, &["byteoffset"]) {
        form.offset =
            Some(said.parse().map_err(|_error| bad(attempt, "ByteOffset", said, "a number of bytes"))?);
    }
    if let Some(said) = find(&pairs, &["sequences"]) {
        let frames = said.parse().ok().filter(|&n| n > 0);
        form.frames = frames.ok_or_else(|| bad(attempt, "Sequences", said, "a number of volumes"))?;
    }
    let spacing = find(&pairs, &["spacing", "slicethickness"]).and_then(three::<f64>);
    let vectors = ["basisvector1", "basisvector2", "basisvector3"]
        .map(|key| find(&pairs, &[key]).and_then(three::<f64>));
    form.placement = match (spacing, vectors) {
        // Edges of the whole volume in units of Inviwo's scene: only their ratios are known.
        (None, [Some(x), Some(y), Some(z)]) => {
            let edges = [x, y, z].map(|edge| glam::DVec3::from(edge).length());
            let steps = std::array::from_fn(|axis| edges[axis] / dims[axis].max(1) as f64);
            placement(Some(steps)).of_unknown_scale()
        }
        _ => placement(spacing),
    };
    form.hints.modality = find(&pairs, &["modality"]).map(Modality::of_code).unwrap_or_default();
    form.hints.set_unit(find(&pairs, &["unit", "valueunit"]).unwrap_or_default());
    Ok(Described { data: Some(data.to_owned()), form })
}
