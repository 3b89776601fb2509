//! Texts of the import dialog for raw volumes.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_volume_io::{Endian, RawLayout, raw::LayoutEvidence};

pub(crate) const TITLE: &str = "Import raw volume";
pub(crate) const OPEN: &str = "Open";
pub(crate) const OPEN_TIP: &str = "Enter";

pub(crate) const VOXELS: &str = "Voxels";
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];
/// Axis order behind the fields of the dimensions.
pub(crate) const FASTEST_AXIS: &str = "x, y, z; x fastest";
pub(crate) const FASTEST_AXIS_TIP: &str = "Width and height of a slice, and number of slices; consecutive voxels of the file \
                                            are neighbours along x";

pub(crate) const NUMBER_TYPE: &str = "Number type";

pub(crate) const BYTE_ORDER: &str = "Byte order";
pub(crate) const LITTLE: ControlText = control_text("Little-endian", "Lowest byte first: the usual order");
pub(crate) const BIG: ControlText = control_text("Big-endian", "Highest byte first");
/// Text in place of the byte order for one-byte numbers.
pub(crate) const NO_ORDER: &str = "One-byte numbers have no order";

pub(crate) const SPACING: &str = "Spacing";
/// Accessible name of the list of spacing units.
pub(crate) const SPACING_UNIT: &str = "Unit of the spacing";
pub(crate) const SPACING_UNIT_TIP: &str =
    "The file does not state its voxel spacing; without it, voxels are taken for cubes of unknown size";

pub(crate) const HEADER: &str = "Header";
/// Accessible name of the header's length.
pub(crate) const HEADER_BYTES: &str = "Bytes before the first voxel";
/// Suffix of the header's length.
pub(crate) const HEADER_UNIT: &str = "bytes before the first voxel";
pub(crate) const HEADER_TIP: &str =
    "A small NRRD header with this layout: open it instead of the raw file, here and in other programs";

/// Verdicts on the length of the file.
pub(crate) const COMPRESSED: &str = "The file is compressed: its uncompressed length is not known yet";
pub(crate) const TOO_MANY: &str = "That is more than any file can hold";
/// Button that adds the surplus bytes to the header.
pub(crate) const SKIP_SURPLUS: &str = "Skip them as a header";
/// Button that sets the header's length to 0.
pub(crate) const WITHOUT_HEADER: &str = "No header";

/// Heading of the list of likely layouts.
pub(crate) const PROPOSALS: &str = "Likely layouts";
pub(crate) const ANALYSING: &str = "Comparing neighbouring voxels…";

/// Captions of the three preview slices.
pub(crate) const SLICES: [&str; 3] =
    ["Axial: x and y, middle of z", "Coronal: x and z, middle of y", "Sagittal: y and z, middle of x"];
/// Guide to diagnosing a wrong layout from the slices.
pub(crate) const READING_SLICES: &str = "All three should show the object.\n\nNoise: type, byte order or header.\n\
    Slanted or doubled: voxels along x.\nBands in the lower two: voxels along y.\nDark red: not in the file.";

/// Uncompressed length of the file, with everything before the voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RawLengthText {
    /// Length of the file in bytes.
    pub bytes: u64,
    /// True if the bytes were counted; false if the length comes from the trailer of a compressed file.
    pub is_exact: bool,
}

/// Unit of the voxel spacing, possibly unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RawSpacingUnit {
    Unknown,
    Nanometres,
    Micrometres,
    Millimetres,
    Metres,
}

impl RawSpacingUnit {
    pub(crate) const ALL: [Self; 5] =
        [Self::Unknown, Self::Nanometres, Self::Micrometres, Self::Millimetres, Self::Metres];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::Nanometres => "nm",
            Self::Micrometres => "µm",
            Self::Millimetres => "mm",
            Self::Metres => "m",
        }
    }

    /// Length of the unit in mm, if known.
    pub(crate) fn mm(self) -> Option<f64> {
        match self {
            Self::Unknown => None,
            Self::Nanometres => Some(1e-6),
            Self::Micrometres => Some(1e-3),
            Self::Millimetres => Some(1.0),
            Self::Metres => Some(1e3),
        }
    }
}

/// Accessible name of the number of voxels along an axis.
pub(crate) fn voxels_along(axis: &str) -> String {
    format!("Voxels along {axis}")
}

/// Accessible name of the voxel spacing along an axis.
pub(crate) fn spacing_along(axis: &str) -> String {
    format!("Spacing along {axis}")
}

/// Checkbox that also writes a header with this file name.
pub(crate) fn write_header(header: &str) -> String {
    format!("Also write {header} beside the file")
}

/// Checkbox that overwrites an existing header.
pub(crate) fn rewrite_header(header: &str) -> String {
    format!("Rewrite {header}, which lies beside the file")
}

/// Verdict that the length of the file matches the layout.
pub(crate) fn length_matches(bytes: u64, is_exact: bool) -> String {
    let bytes = group_thousands(bytes);
    if is_exact {
        format!("Bytes fit: the file has exactly {bytes}")
    } else {
        format!("Bytes fit: the end of the file states {bytes}")
    }
}

/// Verdict that the file has surplus bytes.
pub(crate) fn surplus_bytes(bytes: u64) -> String {
    format!("{} bytes too many in the file", group_thousands(bytes))
}

/// Verdict that the file lacks bytes.
pub(crate) fn missing_bytes(found: u64, expected: u64) -> String {
    let [missing, found, expected] = [expected - found, found, expected].map(group_thousands);
    format!("{missing} bytes missing: the file has {found} of {expected}")
}

/// Button that sets the number of slices to the one that the file holds.
pub(crate) fn with_slices(slices: u64) -> String {
    format!("Make it {slices} slices")
}

/// Error when the file cannot be read.
pub(crate) fn not_read(error: &std::io::Error) -> String {
    format!("The file could not be read: {error}")
}

/// Summary of a raw layout in one line.
pub(crate) fn layout_summary(layout: &RawLayout) -> String {
    let [x, y, z] = layout.dims;
    let order = match layout.endian {
        _ if layout.voxel_type.bytes() == 1 => "",
        Endian::Little => ", little-endian",
        Endian::Big => ", big-endian",
    };
    let header = match layout.offset {
        0 => String::new(),
        bytes => format!(", header of {} bytes", group_thousands(bytes)),
    };
    format!("{x} × {y} × {z}, {}{order}{header}", layout.voxel_type.name())
}

/// Evidence for a layout in one line: similarity of rows and slices, the file name and the length.
pub(crate) fn evidence_summary(
    evidence: &LayoutEvidence,
    layout: &RawLayout,
    length: Option<RawLengthText>,
) -> String {
    let percent = |share: f64| {
        let percent = share * 100.0;
        if percent >= 10.0 { format!("{percent:.0} %") } else { format!("{percent:.1} %") }
    };
    let [_, row, slice] = evidence.neighbour_differences;
    let agreement = match (evidence.rows_agree, evidence.slices_agree) {
        (true, true) => {
            format!("rows and slices agree: neighbours differ by {} and {}", percent(row), percent(slice))
        }
        (true, false) => format!("rows agree: neighbours differ by {}; slices hardly do", percent(row)),
        (false, true) => format!("slices agree: neighbours differ by {}; rows hardly do", percent(slice)),
        (false, false) => "neither rows nor slices agree clearly".to_owned(),
    };
    let fits = length.zip(layout.file_bytes()).is_some_and(|(length, bytes)| length.bytes == bytes);
    let name = if evidence.is_named { "as in the file name; " } else { "" };
    let fit = match (fits, layout.offset) {
        (true, 0) => "bytes fit",
        (true, _) => "bytes fit with the header",
        (false, _) => "bytes do not fit",
    };
    format!("{name}{agreement}; {fit}")
}

/// Confidence in the first proposal.
pub(crate) fn confidence(first: Option<LayoutEvidence>) -> &'static str {
    match first {
        None => "No layout that fits was found",
        Some(LayoutEvidence { is_clear: true, .. }) => "The first stands out; click one to use it",
        Some(LayoutEvidence { rows_agree: false, slices_agree: false, .. }) => {
            "None stands out: these are guesses from the length alone"
        }
        Some(_) => "Several are equally likely: compare the slices, click one",
    }
}

/// Formats a number with its thousands separated.
fn group_thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_apart() {
        for (number, expected) in [(0, "0"), (999, "999"), (1000, "1 000"), (14155776, "14 155 776")] {
            assert_eq!(group_thousands(number), expected);
        }
    }
}
