//! Parsing that the descriptions share: lines of keys and values, names of types and byte orders, spacings.

use super::super::super::number::FileNumberType;
use super::super::super::placement::GridPlacement;
use super::super::super::{Endian, LoadError};
use chiaroscuro_volume::{LoadContext, quoted};

const HELP: &str = "correct the description, or open the data file with --dims and --type";

/// Error for a value of unexpected form.
pub(super) fn bad_value(context: LoadContext<'_>, field: &str, found: &str, expected: &str) -> LoadError {
    context.bad_input_error(field, format!("{expected} was expected, {} was found", quoted(found)), HELP)
}

/// Error for a missing key.
pub(super) fn missing_key(context: LoadContext<'_>, field: &str) -> LoadError {
    context.bad_input_error(field, "the field is missing", HELP)
}

/// Parses lines `key: value` or `key = value`, with keys in lower case. Other lines and comments are ignored.
pub(super) fn lines(text: &str) -> Vec<(String, &str)> {
    let pairs = text.lines().filter(|line| !line.trim_start().starts_with(['#', ';'])).filter_map(|line| {
        let (key, value) = line.split_once([':', '='])?;
        Some((key.trim().trim_start_matches('\u{feff}').to_lowercase(), value.trim()))
    });
    pairs.collect()
}

/// First value that is not empty, by the order of the keys.
pub(super) fn find_value<'a>(pairs: &[(String, &'a str)], keys: &[&str]) -> Option<&'a str> {
    keys.iter().find_map(|key| {
        pairs.iter().find(|(name, value)| name == key && !value.is_empty()).map(|(_, value)| *value)
    })
}

/// Parses three numbers separated by white space.
pub(super) fn parse_three<T: std::str::FromStr>(value: &str) -> Option<[T; 3]> {
    let mut numbers = value.split_whitespace().map(|word| word.parse().ok());
    Some([numbers.next()??, numbers.next()??, numbers.next()??])
}

/// Parses a number type and its number of components: `UCHAR`, `Uint16`, `Vec3FLOAT32`.
pub(super) fn parse_number_type(word: &str) -> Option<(FileNumberType, usize)> {
    let word = word.trim().to_lowercase();
    let (components, kind) = match word.strip_prefix("vec") {
        Some(rest) => (rest.get(..1)?.parse().ok().filter(|n| (1..=4).contains(n))?, rest.get(1..)?),
        None => (1, word.as_str()),
    };
    let number = match kind {
        "uchar" | "uint8" | "byte" | "ubyte" | "unsigned char" => FileNumberType::U8,
        "char" | "int8" | "schar" | "signed char" => FileNumberType::I8,
        // The upper four bits are unused.
        "ushort" | "uint16" | "ushort_12" | "uint12" | "unsigned short" => FileNumberType::U16,
        "short" | "int16" | "short_12" => FileNumberType::I16,
        "uint" | "uint32" | "unsigned int" => FileNumberType::U32,
        "int" | "int32" => FileNumberType::I32,
        "ulong" | "uint64" => FileNumberType::U64,
        "long" | "int64" => FileNumberType::I64,
        "half" | "float16" => FileNumberType::F16,
        "float" | "float32" => FileNumberType::F32,
        "double" | "float64" => FileNumberType::F64,
        _ => return None,
    };
    Some((number, components))
}

/// Parses the name of a byte order.
pub(super) fn parse_byte_order(word: &str) -> Option<Endian> {
    match word.trim().to_lowercase().replace(['-', '_', ' '], "").as_str() {
        "littleendian" | "little" | "le" | "lsb" | "1" | "true" => Some(Endian::Little),
        "bigendian" | "big" | "be" | "msb" | "0" | "false" => Some(Endian::Big),
        _ => None,
    }
}

/// Placement by spacings without a unit: millimetres in practice, except where x and y are 1, so that only ratios are
/// meant.
pub(super) fn placement_from_spacing(spacing: Option<[f64; 3]>) -> GridPlacement {
    match spacing {
        None => GridPlacement::unknown(),
        Some(spacing @ [x, y, _]) if (x, y) == (1.0, 1.0) => {
            GridPlacement::from_spacing(spacing).with_unknown_scale()
        }
        Some(spacing) => GridPlacement::from_spacing(spacing),
    }
}
