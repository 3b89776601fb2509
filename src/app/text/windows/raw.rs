//! The window that asks how a file of bare voxels is stored.

use crate::app::text::{Named, named};

pub(crate) const TITLE: &str = "How is it stored?";
pub(crate) const OPEN: &str = "Open";

pub(crate) const VOXELS: &str = "Voxels";
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];
/// Behind the voxels along each axis.
pub(crate) const FASTEST_AXIS: &str = "x, y, z; x is the fastest";

pub(crate) const NUMBER_TYPE: &str = "Number type";

pub(crate) const BYTE_ORDER: &str = "Byte order";
pub(crate) const LITTLE: Named = named("Little", "Lowest byte first: usual");
pub(crate) const BIG: Named = named("Big", "Highest byte first");

pub(crate) const SPACING: &str = "Spacing";
/// Behind the spacing.
pub(crate) const MILLIMETRES: &str = "mm";

pub(crate) const HEADER: &str = "Header";
/// What screen readers call the length of the header.
pub(crate) const HEADER_BYTES: &str = "Bytes before the first voxel";
/// What stands behind the field for the header's length.
pub(crate) const HEADER_UNIT: &str = "bytes before the first voxel";
pub(crate) const REMEMBER_TIP: &str =
    "A header as NRRD has it: that file then opens here and in other programs";

/// The length of the file.
pub(crate) const COMPRESSED: &str = "The file is compressed: whether it fits is seen when it is read";
pub(crate) const TOO_MANY: &str = "That is more than any file can hold";
/// Takes the bytes that are too many for a header.
pub(crate) const ARE_HEADER: &str = "They are a header";

/// How many voxels there are along an axis.
pub(crate) fn voxels_along(axis: &str) -> String {
    format!("Voxels along {axis}")
}

/// How far apart voxels are along an axis.
pub(crate) fn spacing_along(axis: &str) -> String {
    format!("Spacing along {axis}")
}

/// The switch for writing a header of that name.
pub(crate) fn remember(header: &str) -> String {
    format!("Remember this as {header}, beside the file")
}

/// The file is as long as it must be.
pub(crate) fn fits(bytes: u64) -> String {
    format!("{bytes} bytes, as the file has")
}

/// The file is longer.
pub(crate) fn longer(bytes: u64) -> String {
    format!("The file is {bytes} bytes longer")
}

/// The file is shorter.
pub(crate) fn shorter(found: u64, expected: u64) -> String {
    format!("{} bytes are missing: the file has {found} of {expected}", expected - found)
}
