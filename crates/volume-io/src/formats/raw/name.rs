//! Parser of layouts in the names of RAW files: `skull_256x256x256_uint8.raw`, as in the `OpenSciVis` datasets, and
//! variants.

use super::super::Endian;
use chiaroscuro_volume::VoxelType;

/// Layout parsed from a file name.
#[derive(Debug, PartialEq)]
pub(super) struct RawFileName {
    /// Part before the dimensions; may be empty.
    pub(super) name: String,
    pub(super) dims: [u64; 3],
    pub(super) voxel_type: Option<VoxelType>,
    /// True if the type is only inferred from the length of the file.
    pub(super) is_type_guessed: bool,
    pub(super) endian: Option<Endian>,
}

/// Number types in order of frequency, one for each size.
const COMMON_TYPES: [VoxelType; 4] = [VoxelType::U8, VoxelType::U16, VoxelType::F32, VoxelType::F64];

/// Separators of words in names.
const SEPARATORS: [char; 11] = ['_', '-', '.', ' ', '(', ')', '[', ']', ',', '+', '='];

/// Parses a file name; `length` is the number of bytes of the voxels, where it is known.
pub(super) fn parse_file_name(file_name: &str, length: Option<u64>) -> Option<RawFileName> {
    let base = strip_ending(file_name, ".gz").unwrap_or(file_name);
    let base = [".raw", ".dat", ".bin"].iter().find_map(|ending| strip_ending(base, ending)).unwrap_or(base);
    let words = words(base);
    let type_of = |(_, word): &(usize, &str)| type_and_order(word);
    // Words after the dimensions take precedence: before them is a name, which may contain any word.
    let said_near = |at: usize| words[at..].iter().chain(&words[..at]).find_map(type_of);
    let order_near = |at: usize| words[at..].iter().find_map(|(_, word)| parse_byte_order(word));

    let single = |(_, word): &(usize, &str)| parse_three_digits(word.split(['x', 'X', '×']));
    if let Some((at, dims)) =
        words.iter().enumerate().rev().find_map(|(at, word)| single(word).map(|dims| (at, dims)))
    {
        let said = said_near(at);
        let guessed = || {
            let bytes = length?;
            COMMON_TYPES.into_iter().find(|usual| bytes_of(dims, *usual) == Some(bytes))
        };
        let voxel_type = said.map(|(voxel_type, _)| voxel_type).or_else(guessed);
        let endian = said.and_then(|(_, endian)| endian).or_else(|| order_near(at));
        return Some(file_name_with(base, words[at].0, dims, voxel_type, said.is_none(), endian));
    }
    // Three separate numbers may be a date: they count only if they match the length exactly.
    (0..words.len().checked_sub(2)?).find_map(|at| {
        let dims = parse_three_digits(words[at..at + 3].iter().map(|(_, word)| *word))?;
        let said = said_near(at);
        let fits = |voxel_type: &VoxelType| length.is_some() && bytes_of(dims, *voxel_type) == length;
        let voxel_type = match said {
            Some((voxel_type, _)) => Some(voxel_type).filter(fits),
            None => COMMON_TYPES.into_iter().find(fits),
        }?;
        let endian = said.and_then(|(_, endian)| endian).or_else(|| order_near(at));
        Some(file_name_with(base, words[at].0, dims, Some(voxel_type), said.is_none(), endian))
    })
}

fn file_name_with(
    base: &str,
    start: usize,
    dims: [u64; 3],
    voxel_type: Option<VoxelType>,
    is_type_unsaid: bool,
    endian: Option<Endian>,
) -> RawFileName {
    let name = base[..start].trim_end_matches(SEPARATORS).to_owned();
    RawFileName { name, dims, voxel_type, is_type_guessed: is_type_unsaid && voxel_type.is_some(), endian }
}

/// Splits a name into words, with their byte offsets.
fn words(base: &str) -> Vec<(usize, &str)> {
    let mut words = Vec::new();
    let mut start = 0;
    for piece in base.split(SEPARATORS) {
        if !piece.is_empty() {
            words.push((start, piece));
        }
        // All separators are one byte long.
        start += piece.len() + 1;
    }
    words
}

/// Parses exactly three numbers of digits only.
fn parse_three_digits<'a>(mut pieces: impl Iterator<Item = &'a str>) -> Option<[u64; 3]> {
    let mut next = || pieces.next().and_then(parse_digits);
    let dims = [next()?, next()?, next()?];
    pieces.next().is_none().then_some(dims)
}

/// Parses a number of digits only; it saturates beyond 64 bits.
fn parse_digits(digits: &str) -> Option<u64> {
    let all_digits = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    all_digits.then(|| digits.parse().unwrap_or(u64::MAX))
}

fn bytes_of(dims: [u64; 3], voxel_type: VoxelType) -> Option<u64> {
    let bytes = dims.iter().try_fold(voxel_type.bytes() as u64, |product, &n| product.checked_mul(n));
    bytes.filter(|&bytes| bytes > 0)
}

/// Parses a word for a type, optionally with a byte order at its end.
fn type_and_order(word: &str) -> Option<(VoxelType, Option<Endian>)> {
    let word = word.to_ascii_lowercase();
    let ends = [("le", Some(Endian::Little)), ("be", Some(Endian::Big)), ("", None)];
    ends.iter()
        .find_map(|(end, endian)| voxel_type(word.strip_suffix(end)?).map(|voxel_type| (voxel_type, *endian)))
}

/// Byte order in a name, as a word of its own or after a type.
pub(super) fn byte_order_in_name(file_name: &str) -> Option<Endian> {
    let words = words(file_name);
    let said = |(_, word): &(usize, &str)| {
        type_and_order(word).and_then(|(_, endian)| endian).or_else(|| parse_byte_order(word))
    };
    words.iter().find_map(said)
}

/// Parses a word for a byte order.
fn parse_byte_order(word: &str) -> Option<Endian> {
    match word.to_ascii_lowercase().as_str() {
        "le" | "little" | "littleendian" | "lsb" => Some(Endian::Little),
        "be" | "big" | "bigendian" | "msb" => Some(Endian::Big),
        _ => None,
    }
}

/// Parses a word for a number type.
fn voxel_type(word: &str) -> Option<VoxelType> {
    Some(match word {
        "uint8" | "u8" | "ui8" | "uchar" | "ubyte" | "byte" | "8bit" | "8bits" => VoxelType::U8,
        "int8" | "i8" | "s8" | "char" | "schar" | "sbyte" => VoxelType::I8,
        "uint16" | "u16" | "ui16" | "ushort" | "16bit" | "16bits" => VoxelType::U16,
        "int16" | "i16" | "s16" | "short" | "sshort" => VoxelType::I16,
        "uint32" | "u32" | "ui32" | "uint" => VoxelType::U32,
        "int32" | "i32" | "s32" | "int" => VoxelType::I32,
        "float32" | "f32" | "float" => VoxelType::F32,
        "float64" | "f64" | "double" => VoxelType::F64,
        _ => return None,
    })
}

/// Removes an ASCII extension from a name, ignoring case; `None` if it has another one.
fn strip_ending<'a>(name: &'a str, ending: &str) -> Option<&'a str> {
    let start = name.len().checked_sub(ending.len())?;
    let (base, found) = name.split_at_checked(start)?;
    found.eq_ignore_ascii_case(ending).then_some(base)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_format() {
        let named = parse_file_name("head_cropped_256x128x64_UInt16.raw.gz", None).unwrap();
        assert_eq!((named.name.as_str(), named.dims), ("head_cropped", [256, 128, 64]));
        assert_eq!((named.voxel_type, named.is_type_guessed), (Some(VoxelType::U16), false));
        for voxel_type in VoxelType::ALL {
            let name = format!("a_1x2x3_{}.RAW", voxel_type.name());
            assert_eq!(parse_file_name(&name, Some(0)).and_then(|named| named.voxel_type), Some(voxel_type));
        }
        let huge = parse_file_name("a_99999999999999999999999x1x1_int8.raw", Some(1)).unwrap();
        assert_eq!(huge.dims[0], u64::MAX);
    }

    #[test]
    fn names_are_read_as_people_write_them() {
        use VoxelType::{F32, I16, U8, U16};
        let little = Some(Endian::Little);
        let big = Some(Endian::Big);
        for (file_name, name, dims, voxel_type, endian) in [
            ("name-256x255x128-uint16.raw", "name", [256, 255, 128], Some(U16), None),
            ("foot_256x256x256_8bit.raw", "foot", [256; 3], Some(U8), None),
            ("foot 2x3x4 u16.raw", "foot", [2, 3, 4], Some(U16), None),
            ("foot_2X3X4_int16_be.raw.gz", "foot", [2, 3, 4], Some(I16), big),
            ("foot.2x3x4.f32le.raw", "foot", [2, 3, 4], Some(F32), little),
            ("short_foot_2x3x4_uint8.raw", "short_foot", [2, 3, 4], Some(U8), None),
            ("foot_uint16_2x3x4.raw", "foot_uint16", [2, 3, 4], Some(U16), None),
            ("foot(2x3x4)[short].dat", "foot", [2, 3, 4], Some(I16), None),
            ("2x3x4_uint8.raw", "", [2, 3, 4], Some(U8), None),
            ("é_2×3×4_uint8.raw", "é", [2, 3, 4], Some(U8), None),
            ("a_9x9x9_b_2x3x4_uint8.raw", "a_9x9x9_b", [2, 3, 4], Some(U8), None),
            ("foot_2x3x4.raw", "foot", [2, 3, 4], None, None),
        ] {
            let found = parse_file_name(file_name, None);
            let is_type_guessed = false;
            let expected = RawFileName { name: name.to_owned(), dims, voxel_type, is_type_guessed, endian };
            assert_eq!(found, Some(expected), "{file_name}");
        }
    }

    #[test]
    fn what_a_name_leaves_open_the_length_may_say() {
        for (bytes, voxel_type) in
            [(24, Some(VoxelType::U8)), (48, Some(VoxelType::U16)), (96, Some(VoxelType::F32)), (50, None)]
        {
            let named = parse_file_name("a_2x3x4.raw", Some(bytes)).unwrap();
            assert_eq!((named.voxel_type, named.is_type_guessed), (voxel_type, voxel_type.is_some()));
            let in_a_row = parse_file_name("sim_2_3_4.raw", Some(bytes));
            assert_eq!(in_a_row.and_then(|named| named.voxel_type), voxel_type, "{bytes}");
        }
        let typed = parse_file_name("sim_2_3_4_int16.raw", Some(48)).unwrap();
        assert_eq!((typed.voxel_type, typed.is_type_guessed), (Some(VoxelType::I16), false));
        assert_eq!(parse_file_name("scan_2024_01_02.raw", Some(48)), None);
        assert_eq!(parse_file_name("scan_2_3_4.raw", None), None, "compressed: nobody knows");
    }

    #[test]
    fn other_names_say_nothing() {
        for name in [
            "a_1x2_uint8.raw",
            "a_1x2x3x4_uint8.raw",
            "a_1xx3_uint8.raw",
            "a_x1x2x3_uint8.raw",
            "a1x2x3b.raw",
            "é.raw",
            "raw",
            ".raw.gz",
            "",
        ] {
            assert_eq!(parse_file_name(name, Some(6)), None, "{name}");
        }
        assert_eq!(parse_file_name("a_0x2x3.raw", Some(0)).and_then(|named| named.voxel_type), None);
    }
}
