//! INI, the descriptions of raw files by Unity Volume Rendering (<https://github.com/mlavik1/UnityVolumeRendering>):
//! `x.raw.ini` beside `x.raw`.

use super::super::super::LoadError;
use super::super::form::Form;
use super::Described;
use super::words::{bad, find, lines, missing, number, order};
use crate::data::attempt::Attempt;

/// Returns true if a file with this beginning is such a description.
pub(super) fn is_ini(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let pairs = lines(&text);
    ["dimx", "dimy", "dimz"].iter().all(|key| pairs.iter().any(|(name, _)| name == key))
}

pub(super) fn parse(attempt: Attempt<'_>, text: &str) -> Result<Described, LoadError> {
    let pairs = lines(text);
    let mut dims = [0; 3];
    for (dim, key) in dims.iter_mut().zip(["dimx", "dimy", "dimz"]) {
        let said = find(&pairs, &[key]).ok_or_else(|| missing(attempt, key))?;
        *dim = said.parse().map_err(|_error| bad(attempt, key, said, "a number of voxels"))?;
    }
    let said = find(&pairs, &["format"]).ok_or_else(|| missing(attempt, "format"))?;
    let (kind, components) =
        number(said).ok_or_else(|| bad(attempt, "format", said, "a number type like uint8"))?;
    let mut form = Form::new(dims, "dimx, dimy, dimz", kind);
    form.components = components;
    if let Some(said) = find(&pairs, &["skip"]) {
        form.offset = Some(said.parse().map_err(|_error| bad(attempt, "skip", said, "a number of bytes"))?);
    }
    if let Some(said) = find(&pairs, &["endianness", "endian"]) {
        form.endian =
            order(said).ok_or_else(|| bad(attempt, "endianness", said, "LittleEndian or BigEndian"))?;
    }
    Ok(Described { data: None, form })
}
