//! The window that asks how a file of bare voxels is stored.

use crate::app::text::{Named, named};
use crate::data::load::raw::Evidence;
use crate::data::load::{Endian, RawLayout};

pub(crate) const TITLE: &str = "Import raw volume";
pub(crate) const OPEN: &str = "Open";
pub(crate) const OPEN_TIP: &str = "Enter";

pub(crate) const VOXELS: &str = "Voxels";
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];
/// Behind the voxels along each axis.
pub(crate) const FASTEST_AXIS: &str = "x, y, z; x fastest";
pub(crate) const FASTEST_AXIS_TIP: &str = "Width and height of a slice, and how many slices; voxels that lie side by side in the file are neighbours along x";

pub(crate) const NUMBER_TYPE: &str = "Number type";

pub(crate) const BYTE_ORDER: &str = "Byte order";
pub(crate) const LITTLE: Named = named("Little-endian", "Lowest byte first: usual");
pub(crate) const BIG: Named = named("Big-endian", "Highest byte first");
/// Why no byte order can be chosen.
pub(crate) const NO_ORDER: &str = "Numbers of one byte have no order";

pub(crate) const SPACING: &str = "Spacing";
/// What screen readers call the list of units.
pub(crate) const SPACING_UNIT: &str = "Unit of the spacing";
pub(crate) const SPACING_UNIT_TIP: &str = "The file does not say how far apart its voxels are; without that, they are taken for cubes of unknown size";

pub(crate) const HEADER: &str = "Header";
/// What screen readers call the length of the header.
pub(crate) const HEADER_BYTES: &str = "Bytes before the first voxel";
/// What stands behind the field for the header's length.
pub(crate) const HEADER_UNIT: &str = "bytes before the first voxel";
pub(crate) const HEADER_TIP: &str =
    "A small NRRD header that says all this: opened in place of the file, here and in other programs";

/// The length of the file.
pub(crate) const COMPRESSED: &str = "The file is compressed: how long it is inside is not known yet";
pub(crate) const TOO_MANY: &str = "That is more than any file can hold";
/// Takes the bytes that are too many for a header.
pub(crate) const ARE_HEADER: &str = "Skip them as a header";
/// Leaves out a header.
pub(crate) const WITHOUT_HEADER: &str = "No header";

/// Over the list of likely ways of storing the file.
pub(crate) const PROPOSALS: &str = "What its bytes suggest";
pub(crate) const LOOKING: &str = "Comparing neighbouring voxels…";

/// Over the slices.
pub(crate) const SLICES: [&str; 3] =
    ["Axial: x and y, middle of z", "Coronal: x and z, middle of y", "Sagittal: y and z, middle of x"];
/// Beside the slices.
pub(crate) const READING_SLICES: &str = "All three should show the object.\n\nNoise: type, byte order or header.\n\
    Slanted or doubled: voxels along x.\nBands in the lower two: voxels along y.\nDark red: not in the file.";

/// How long the voxels are with all that precedes them, after inflating.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Length {
    /// In bytes.
    pub bytes: u64,
    /// Whether they were counted, not only said by the file's end.
    pub is_exact: bool,
}

/// A unit of length; none if nobody knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unit {
    Unknown,
    Nanometres,
    Micrometres,
    Millimetres,
    Metres,
}

impl Unit {
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

    /// How many millimetres it is long.
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

/// How many voxels there are along an axis.
pub(crate) fn voxels_along(axis: &str) -> String {
    format!("Voxels along {axis}")
}

/// How far apart voxels are along an axis.
pub(crate) fn spacing_along(axis: &str) -> String {
    format!("Spacing along {axis}")
}

/// The switch for writing a header of that name.
pub(crate) fn write(header: &str) -> String {
    format!("Also write {header} beside the file")
}

/// The switch for writing a header where there is one already.
pub(crate) fn rewrite(header: &str) -> String {
    format!("Rewrite {header}, which lies beside the file")
}

/// The file is as long as it must be.
pub(crate) fn fits(bytes: u64, is_exact: bool) -> String {
    let bytes = grouped(bytes);
    if is_exact {
        format!("Bytes fit: the file has just these {bytes}")
    } else {
        format!("Bytes fit: the file ends by saying that it has {bytes}")
    }
}

/// The file is longer.
pub(crate) fn longer(bytes: u64) -> String {
    format!("{} bytes too many in the file", grouped(bytes))
}

/// The file is shorter.
pub(crate) fn shorter(found: u64, expected: u64) -> String {
    let [missing, found, expected] = [expected - found, found, expected].map(grouped);
    format!("{missing} bytes missing: the file has {found} of {expected}")
}

/// As many slices as the file has.
pub(crate) fn with_slices(slices: u64) -> String {
    format!("Make it {slices} slices")
}

/// The file could not be read.
pub(crate) fn not_read(error: &std::io::Error) -> String {
    format!("The file could not be read: {error}")
}

/// A way of storing, in a line.
pub(crate) fn layout(layout: &RawLayout) -> String {
    let [x, y, z] = layout.dims;
    let order = match layout.endian {
        _ if layout.voxel_type.bytes() == 1 => "",
        Endian::Little => ", little-endian",
        Endian::Big => ", big-endian",
    };
    let header = match layout.offset {
        0 => String::new(),
        bytes => format!(", header of {} bytes", grouped(bytes)),
    };
    format!("{x} × {y} × {z}, {}{order}{header}", layout.voxel_type.name())
}

/// What speaks for it.
pub(crate) fn why(evidence: &Evidence, layout: &RawLayout, length: Option<Length>) -> String {
    let percent = |share: f64| {
        let percent = share * 100.0;
        if percent >= 10.0 { format!("{percent:.0} %") } else { format!("{percent:.1} %") }
    };
    let [_, row, slice] = evidence.neighbours;
    let agreement = match (evidence.rows_agree, evidence.slices_agree) {
        (true, true) => {
            format!("rows and slices agree: neighbours differ by {} and {}", percent(row), percent(slice))
        }
        (true, false) => format!("rows agree: neighbours differ by {}; slices hardly do", percent(row)),
        (false, true) => format!("slices agree: neighbours differ by {}; rows hardly do", percent(slice)),
        (false, false) => "neither rows nor slices agree clearly".to_owned(),
    };
    let fits = length.zip(layout.file_bytes()).is_some_and(|(length, bytes)| length.bytes == bytes);
    let name = if evidence.is_named { "as its name says; " } else { "" };
    let fit = match (fits, layout.offset) {
        (true, 0) => "bytes fit",
        (true, _) => "bytes fit with the header",
        (false, _) => "bytes do not fit",
    };
    format!("{name}{agreement}; {fit}")
}

/// How sure the first proposal is.
pub(crate) fn verdict(first: Option<Evidence>) -> &'static str {
    match first {
        None => "Nothing that would fit was found",
        Some(Evidence { is_clear: true, .. }) => "The first stands out; click one to take it over",
        Some(Evidence { rows_agree: false, slices_agree: false, .. }) => {
            "None stands out: these are guesses by size alone"
        }
        Some(_) => "Several are alike: look at the slices; click one to take it over",
    }
}

/// A number with its thousands apart.
fn grouped(number: u64) -> String {
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
            assert_eq!(grouped(number), expected);
        }
    }
}
