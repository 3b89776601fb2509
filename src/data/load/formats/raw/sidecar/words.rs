//! Words that descriptions have in common: lines of keys and values, names of types and orders, distances.

use super::super::super::number::Number;
use super::super::super::placement::Placement;
use super::super::super::{Endian, LoadError};
use crate::data::attempt::{Attempt, quoted};

const HELP: &str = "correct the description, or give --dims and --type with the file of voxels";

/// A value that is not what it should be.
pub(super) fn bad(attempt: Attempt<'_>, field: &str, found: &str, expected: &str) -> LoadError {
    attempt.bad_input(field, format!("{expected} was expected, {} was found", quoted(found)), HELP)
}

/// Something that is not there.
pub(super) fn missing(attempt: Attempt<'_>, field: &str) -> LoadError {
    attempt.bad_input(field, "it does not say this", HELP)
}

/// Keys in lower case and values of lines `key: value` or `key = value`. Other lines, comments among them, say nothing.
pub(super) fn lines(text: &str) -> Vec<(String, &str)> {
    let pairs = text.lines().filter(|line| !line.trim_start().starts_with(['#', ';'])).filter_map(|line| {
        let (key, value) = line.split_once([':', '='])?;
        Some((key.trim().trim_start_matches('\u{feff}').to_lowercase(), value.trim()))
    });
    pairs.collect()
}

/// The first value with one of some keys that is not empty.
pub(super) fn find<'a>(pairs: &[(String, &'a str)], keys: &[&str]) -> Option<&'a str> {
    keys.iter().find_map(|key| {
        pairs.iter().find(|(name, value)| name == key && !value.is_empty()).map(|(_, value)| *value)
    })
}

/// Three numbers of a value.
pub(super) fn three<T: std::str::FromStr>(value: &str) -> Option<[T; 3]> {
    let mut numbers = value.split_whitespace().map(|word| word.parse().ok());
    Some([numbers.next()??, numbers.next()??, numbers.next()??])
}

/// A number type and how many of them a voxel has: `UCHAR`, `Uint16`, `Vec3FLOAT32`.
pub(super) fn number(word: &str) -> Option<(Number, usize)> {
    let word = word.trim().to_lowercase();
    let (components, kind) = match word.strip_prefix("vec") {
        Some(rest) => (rest.get(..1)?.parse().ok().filter(|n| (1..=4).contains(n))?, rest.get(1..)?),
        None => (1, word.as_str()),
    };
    let number = match kind {
        "uchar" | "uint8" | "byte" | "ubyte" | "unsigned char" => Number::U8,
        "char" | "int8" | "schar" | "signed char" => Number::I8,
        // The upper bits are empty.
        "ushort" | "uint16" | "ushort_12" | "uint12" | "unsigned short" => Number::U16,
        "short" | "int16" | "short_12" => Number::I16,
        "uint" | "uint32" | "unsigned int" => Number::U32,
        "int" | "int32" => Number::I32,
        "ulong" | "uint64" => Number::U64,
        "long" | "int64" => Number::I64,
        "half" | "float16" => Number::F16,
        "float" | "float32" => Number::F32,
        "double" | "float64" => Number::F64,
        _ => return None,
    };
    Some((number, components))
}

/// A byte order in words.
pub(super) fn order(word: &str) -> Option<Endian> {
    match word.trim().to_lowercase().replace(['-', '_', ' '], "").as_str() {
        "littleendian" | "little" | "le" | "lsb" | "1" | "true" => Some(Endian::Little),
        "bigendian" | "big" | "be" | "msb" | "0" | "false" => Some(Endian::Big),
        _ => None,
    }
}

/// Distances without a unit, which are millimetres in practice: but for those that only compare, with 1 along x and y.
pub(super) fn placement(spacing: Option<[f64; 3]>) -> Placement {
    match spacing {
        None => Placement::unknown(),
        Some(spacing @ [x, y, _]) if (x, y) == (1.0, 1.0) => Placement::spaced(spacing).of_unknown_scale(),
        Some(spacing) => Placement::spaced(spacing),
    }
}
