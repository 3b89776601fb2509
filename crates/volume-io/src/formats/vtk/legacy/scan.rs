//! Scan of a legacy VTK file: its grid, and the offsets of its arrays' values.

use std::str::FromStr;

use glam::DVec3;

use super::super::super::LoadError;
use super::super::super::number::FileNumberType;
use super::super::RESAMPLE;
use super::super::image::{MAX_ARRAYS, MAX_COMPONENTS, VtkArray, VtkGrid};
use super::lines::LegacyLines;
use chiaroscuro_files::sanitised;
use chiaroscuro_volume::{LoadContext, quoted};

/// Location and form of an array's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct LegacyValueLocation {
    pub(super) start: u64,
    /// True if bytes are written as fractions from 0 to 1.
    pub(super) are_fractions: bool,
}

/// Contents of a file: title, encoding, grid and arrays.
pub(super) struct LegacyScan<'a> {
    context: LoadContext<'a>,
    pub(super) title: String,
    /// True if values are text, false if they are binary.
    pub(super) is_text: bool,
    pub(super) grid: VtkGrid,
    /// Arrays found so far, with the offsets of their values.
    pub(super) arrays: Vec<VtkArray<LegacyValueLocation>>,
    /// Current section: number of values per array, and true for cell data.
    section: Option<(u64, bool)>,
    /// True once the dimensions have been given.
    has_dims: bool,
}

/// Announcement of an array in a line.
struct ArrayAnnouncement {
    name: String,
    /// Number type; `None` where it is not supported.
    number: Option<FileNumberType>,
    components: u64,
    /// Number of tuples, each with one value per component.
    tuples: u64,
    bytes: u64,
    is_color: bool,
    are_fractions: bool,
}

impl ArrayAnnouncement {
    /// Creates an announcement from a type, a number of components and a number of tuples; `None` for an unknown
    /// type, or on overflow.
    fn new(name: String, kind: &str, [components, tuples]: [u64; 2]) -> Option<Self> {
        let (number, bits) = parse_number_type(kind)?;
        let bytes = bits.checked_mul(tuples.checked_mul(components)?)?.div_ceil(8);
        let is_color = number == Some(FileNumberType::U8) && (3..=4).contains(&components);
        Some(Self { name, number, components, tuples, bytes, is_color, are_fractions: false })
    }
}

impl<'a> LegacyScan<'a> {
    pub(super) fn read(context: LoadContext<'a>, mut lines: LegacyLines<'_>) -> Result<Self, LoadError> {
        lines.next()?;
        let title = lines.next()?.unwrap_or_default();
        let coding = lines.next_non_blank()?.unwrap_or_default();
        let is_text = match coding.to_uppercase().as_str() {
            "ASCII" => true,
            "BINARY" => false,
            _ => {
                let why = format!("ASCII or BINARY was expected, {} was found", quoted(&coding));
                return Err(context.bad_input_error("line 3", why, "write the file again"));
            }
        };
        let dataset = lines.next_non_blank()?.unwrap_or_default();
        match dataset.to_uppercase().split_whitespace().collect::<Vec<_>>()[..] {
            ["DATASET", "STRUCTURED_POINTS"] => {}
            ["DATASET", kind] => {
                let why = format!("a data set of type {} is not a regular grid", quoted(kind));
                return Err(context.bad_input_error("DATASET", why, RESAMPLE));
            }
            _ => {
                let why = format!("DATASET STRUCTURED_POINTS was expected, {} was found", quoted(&dataset));
                return Err(context.bad_input_error("DATASET", why, RESAMPLE));
            }
        }
        let point = VtkGrid {
            points: [1; 3],
            first: [0.0; 3],
            origin: DVec3::ZERO,
            spacing: DVec3::ONE,
            direction: glam::DMat3::IDENTITY,
            has_spacing: false,
        };
        let arrays = Vec::new();
        let mut scan =
            LegacyScan { context, title, is_text, grid: point, arrays, section: None, has_dims: false };
        while let Some(line) = lines.next_non_blank()? {
            if scan.arrays.len() > MAX_ARRAYS || !scan.add(&line, &mut lines)? {
                break;
            }
        }
        Ok(scan)
    }

    /// Interprets a line, and skips the values after it; returns false where the rest of the file cannot be
    /// interpreted.
    fn add(&mut self, line: &str, lines: &mut LegacyLines<'_>) -> Result<bool, LoadError> {
        let words: Vec<_> = line.split_whitespace().collect();
        let keyword = words[0].to_uppercase();
        let word = |at: usize| words.get(at).copied().unwrap_or_default();
        let context = self.context;
        let tuples = self.section.map_or(0, |(count, _)| count);
        let announced = |kind: &str, components: u64| {
            ArrayAnnouncement::new(decode_name(word(1)), kind, [components, tuples])
        };
        let attribute = match keyword.as_str() {
            "DIMENSIONS" => {
                let [x, y, z]: [i64; 3] = parse_numbers(context, &keyword, &words)?;
                return self.set_extent(
                    &keyword,
                    [0, x.saturating_sub(1), 0, y.saturating_sub(1), 0, z.saturating_sub(1)],
                );
            }
            "EXTENT" => return self.set_extent(&keyword, parse_numbers(context, &keyword, &words)?),
            "ORIGIN" => {
                self.grid.origin = DVec3::from_array(parse_numbers(context, &keyword, &words)?);
                return Ok(true);
            }
            "SPACING" | "ASPECT_RATIO" => {
                self.grid.spacing = DVec3::from_array(parse_numbers(context, &keyword, &words)?);
                self.grid.has_spacing = true;
                return Ok(true);
            }
            "POINT_DATA" | "CELL_DATA" => {
                let [count] = parse_numbers(context, &keyword, &words)?;
                return self.begin_section(&keyword, count);
            }
            "METADATA" => return skip_metadata(lines),
            "FIELD" => {
                let count: Option<u64> = word(2).parse().ok();
                return count.map_or(Ok(false), |count| self.add_fields(count, lines));
            }
            "SCALARS" => {
                let components = words.get(3).map_or(Some(1), |text| text.parse().ok());
                let found = components.and_then(|components| announced(word(2), components));
                // Other writers than VTK omit this line.
                if lines.begins_with("LOOKUP_TABLE")? {
                    lines.next()?;
                }
                found
            }
            // VTK writes all byte arrays like this, colours or not: as bytes, or as numbers from 0 to 1.
            "COLOR_SCALARS" => {
                let found =
                    word(2).parse().ok().and_then(|components| announced("unsigned_char", components));
                found.map(|found| ArrayAnnouncement { is_color: true, are_fractions: self.is_text, ..found })
            }
            "LOOKUP_TABLE" => {
                let colors: Option<u64> = word(2).parse().ok().and_then(|count: u64| count.checked_mul(4));
                return colors.map_or(Ok(false), |count| {
                    if self.is_text { lines.skip_words(count) } else { lines.skip_bytes(count) }
                });
            }
            "VECTORS" | "NORMALS" => announced(word(2), 3),
            "TENSORS" => announced(word(2), 9),
            "TENSORS6" => announced(word(2), 6),
            "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" => announced(word(2), 1),
            "TEXTURE_COORDINATES" => word(2).parse().ok().and_then(|count| announced(word(3), count)),
            _ => None,
        };
        match attribute {
            Some(found) if self.section.is_some() => self.add_array(found, lines),
            _ => self.end_at(line),
        }
    }

    fn set_extent(&mut self, keyword: &str, extent: [i64; 6]) -> Result<bool, LoadError> {
        let VtkGrid { origin, spacing, has_spacing, .. } = self.grid;
        let grid = VtkGrid::from_extent(extent).ok_or_else(|| {
            self.context.bad_input_error(
                keyword,
                "it has no points along an axis",
                "every dimension must be at least 1",
            )
        })?;
        self.grid = VtkGrid { origin, spacing, has_spacing, ..grid };
        self.has_dims = true;
        Ok(true)
    }

    /// Begins the section of point or cell data.
    fn begin_section(&mut self, keyword: &str, count: u64) -> Result<bool, LoadError> {
        let of_cells = keyword == "CELL_DATA";
        let expected = self.grid.count(of_cells);
        if !self.has_dims || count != expected {
            let [x, y, z] = self.grid.dims(of_cells);
            let why = if self.has_dims {
                format!("{expected} values were expected for {x} x {y} x {z} voxels, {count} are announced")
            } else {
                "the dimensions of the grid are missing before it".to_owned()
            };
            return Err(self.context.bad_input_error(keyword, why, "write the file again"));
        }
        self.section = Some((count, of_cells));
        Ok(true)
    }

    /// Adds the arrays of a field, each with a line `name components tuples type`.
    fn add_fields(&mut self, count: u64, lines: &mut LegacyLines<'_>) -> Result<bool, LoadError> {
        let mut left = count;
        while left > 0 {
            let Some(line) = lines.next_non_blank()? else { return Ok(false) };
            let words: Vec<_> = line.split_whitespace().collect();
            if words[0].eq_ignore_ascii_case("METADATA") {
                if !skip_metadata(lines)? {
                    return Ok(false);
                }
                continue;
            }
            left -= 1;
            if words[..] == ["NULL_ARRAY"] {
                continue;
            }
            let announced = || {
                let [array, components, tuples, kind] = words[..] else { return None };
                let counts = [components.parse().ok()?, tuples.parse().ok()?];
                ArrayAnnouncement::new(decode_name(array), kind, counts)
            };
            let Some(found) = announced() else { return self.end_at(&line) };
            if !self.add_array(found, lines)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Adds an array, and skips its values; returns false if the file ends before that.
    fn add_array(
        &mut self,
        found: ArrayAnnouncement,
        lines: &mut LegacyLines<'_>,
    ) -> Result<bool, LoadError> {
        let ArrayAnnouncement {
            name,
            number,
            components,
            tuples,
            bytes,
            is_color,
            are_fractions: are_shares,
        } = found;
        let of_cells = self.section.filter(|&(count, _)| count == tuples).map(|(_, of_cells)| of_cells);
        let place = LegacyValueLocation { start: lines.position(), are_fractions: are_shares };
        match (number, of_cells, usize::try_from(components)) {
            (Some(number), Some(of_cells), Ok(components)) if (1..=MAX_COMPONENTS).contains(&components) => {
                self.arrays.push(VtkArray {
                    name,
                    number,
                    components,
                    is_cell_data: of_cells,
                    is_color,
                    location: place,
                });
            }
            _ => self.context.warn(format_args!("the array {} is ignored", quoted(&name))),
        }
        if self.is_text {
            lines.skip_words(tuples.saturating_mul(components))
        } else {
            lines.skip_bytes(bytes)
        }
    }

    /// Ends the scan at a line that is not understood; an error if no array was found before.
    fn end_at(&self, line: &str) -> Result<bool, LoadError> {
        if self.arrays.is_empty() {
            let why = format!("the line {} is not understood", quoted(line));
            return Err(self.context.bad_input_error(
                "lines",
                why,
                "open it in ParaView and save it as .vti",
            ));
        }
        self.context.warn(format_args!("everything after the line {} is ignored", quoted(line)));
        Ok(false)
    }
}

/// Parses the numbers after a keyword.
fn parse_numbers<T: FromStr, const N: usize>(
    context: LoadContext<'_>,
    keyword: &str,
    words: &[&str],
) -> Result<[T; N], LoadError> {
    let found: Option<Vec<T>> = words.iter().skip(1).map(|word| word.parse().ok()).collect();
    found.and_then(|found| found.try_into().ok()).ok_or_else(|| {
        let why = format!("{N} numbers were expected, {} was found", quoted(&words.join(" ")));
        context.bad_input_error(keyword, why, "correct the file")
    })
}

/// Skips the metadata of an array, up to an empty line.
fn skip_metadata(lines: &mut LegacyLines<'_>) -> Result<bool, LoadError> {
    while let Some(line) = lines.next()? {
        if line.is_empty() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Parses the name of a number type: the type, where it is supported, and its bits in the file.
fn parse_number_type(word: &str) -> Option<(Option<FileNumberType>, u64)> {
    let number = match word.to_lowercase().as_str() {
        "bit" => return Some((None, 1)),
        "unsigned_char" => FileNumberType::U8,
        "char" | "signed_char" => FileNumberType::I8,
        "unsigned_short" => FileNumberType::U16,
        "short" => FileNumberType::I16,
        "unsigned_int" => FileNumberType::U32,
        // Ids of points and cells have 64 bits in VTK, and 32 in its files.
        "int" | "vtkidtype" => FileNumberType::I32,
        // 64 bits, as everywhere but on Windows.
        "unsigned_long" | "unsigned_long_long" | "vtktypeuint64" => FileNumberType::U64,
        "long" | "long_long" | "vtktypeint64" => FileNumberType::I64,
        "float" => FileNumberType::F32,
        "double" => FileNumberType::F64,
        _ => return None,
    };
    Some((Some(number), number.bytes() as u64 * 8))
}

/// Decodes a name, in which special characters are written as `%20`.
fn decode_name(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let coded = after
            .get(..2)
            .filter(|_| *first == b'%')
            .and_then(|digits| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok());
        bytes.push(coded.unwrap_or(*first));
        rest = if coded.is_some() { &after[2..] } else { after };
    }
    sanitised(String::from_utf8_lossy(&bytes).trim(), 80)
}
