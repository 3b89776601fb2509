//! INI, the descriptions of raw files by Unity Volume Rendering (<https://github.com/mlavik1/UnityVolumeRendering>):
//! `x.raw.ini` beside `x.raw`.

use super::super::super::LoadError;
use super::super::storage::RawStorage;
use super::RawDescription;
use super::values::{bad_value, find_value, lines, missing_key, parse_byte_order, parse_number_type};
use chiaroscuro_volume::LoadContext;

/// Returns true if a file with this beginning is such a description.
pub(super) fn is_ini(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let pairs = lines(&text);
    ["dimx", "dimy", "dimz"].iter().all(|key| pairs.iter().any(|(name, _)| name == key))
}

pub(super) fn parse(context: LoadContext<'_>, text: &str) -> Result<RawDescription, LoadError> {
    let pairs = lines(text);
    let mut dims = [0; 3];
    for (dim, key) in dims.iter_mut().zip(["dimx", "dimy", "dimz"]) {
        let said = find_value(&pairs, &[key]).ok_or_else(|| missing_key(context, key))?;
        *dim = said.parse().map_err(|_error| bad_value(context, key, said, "a number of voxels"))?;
    }
    let said = find_value(&pairs, &["format"]).ok_or_else(|| missing_key(context, "format"))?;
    let (kind, components) = parse_number_type(said)
        .ok_or_else(|| bad_value(context, "format", said, "a number type like uint8"))?;
    let mut form = RawStorage::new(dims, "dimx, dimy, dimz", kind);
    form.components = components;
    if let Some(said) = find_value(&pairs, &["skip"]) {
        form.offset =
            Some(said.parse().map_err(|_error| bad_value(context, "skip", said, "a number of bytes"))?);
    }
    if let Some(said) = find_value(&pairs, &["endianness", "endian"]) {
        form.endian = parse_byte_order(said)
            .ok_or_else(|| bad_value(context, "endianness", said, "LittleEndian or BigEndian"))?;
    }
    Ok(RawDescription { data_file: None, storage: form })
}
