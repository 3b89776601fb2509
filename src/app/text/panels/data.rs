//! Texts of the data section: metadata and range of the open volume.

use crate::app::text::common::LengthUnit;
use crate::app::text::{Named, named};
use crate::data::load::{Portion, Region, Thinning};
use crate::data::{DataKind, KindName, SpacingUnit};

/// Text in place of the section while no volume is open.
pub(crate) const NOTHING_OPEN: &str = "No volume is open";

pub(crate) const NAME: &str = "Name";
pub(crate) const SOURCE: &str = "Source";
pub(crate) const DIMENSIONS: &str = "Voxels";
/// Labels for a volume of which a part was read: the dimensions of the file, and the region.
pub(crate) const SHOWN_OF: &str = "Read of";
pub(crate) const REGION: &str = "Region";
pub(crate) const VOXEL_TYPE: &str = "Type";
pub(crate) const KIND: &str = "Kind";
pub(crate) const SPACING: &str = "Spacing";
pub(crate) const VALUES: &str = "Values";
pub(crate) const MEMORY: &str = "Memory";
pub(crate) const NOT_FINITE: &str = "Not finite";

pub(crate) const THINNING: Named = named(
    "Subsample",
    "Shows fewer voxels, each one of several or the mean of a block: quicker pictures and less memory, without the \
     finest details. The volume is read again, the look stays",
);

/// Name and tooltip of a subsampling.
pub(crate) fn thinning(thinning: Thinning) -> Named {
    match thinning {
        Thinning::Every(2) => named("Every second", "An eighth of the voxels, as the file has them"),
        Thinning::Every(4) => named("Every fourth", "A sixty-fourth of the voxels, as the file has them"),
        Thinning::Average(2) => named("Means of 2 × 2 × 2", "An eighth of the voxels, each a mean"),
        Thinning::Average(4) => named("Means of 4 × 4 × 4", "A sixty-fourth of the voxels, each a mean"),
        Thinning::Every(2..) => named("Every few", "Of several voxels along each axis one"),
        Thinning::Average(2..) => named("Means of blocks", "Each voxel is the mean of a larger block"),
        Thinning::None | Thinning::Every(_) | Thinning::Average(_) => named("All", "All voxels of the file"),
    }
}

/// Dimensions of the file with the subsampling that was applied; the adapter may have averaged further.
pub(crate) fn shown_of(portion: &Portion, file_dims: [usize; 3]) -> String {
    let all = dimensions(file_dims);
    match portion.thinning {
        Thinning::Every(n @ 2..) => format!("{all}, every {}", ordinal(n)),
        Thinning::None | Thinning::Every(_) | Thinning::Average(_) => format!("{all}, averaged"),
    }
}

/// Ordinal number in English: `second`, `third`, `11th`.
pub(crate) fn ordinal(n: usize) -> String {
    match n {
        2 => "second".to_owned(),
        3 => "third".to_owned(),
        4 => "fourth".to_owned(),
        n => format!("{n}th"),
    }
}

/// Region that was read, within the grid of the file.
pub(crate) fn region(region: &Region, grid: [usize; 3]) -> String {
    format!("{region} of {}", dimensions(grid))
}

pub(crate) const TREAT_AS: Named = named(
    "Treat as",
    "Makes the first look anew, for data of another kind: transfer function, view and lights. It can be undone",
);

/// Name and tooltip of a kind of data that the volume can be treated as; `None` is the automatic choice.
pub(crate) fn treatment(kind: Option<KindName>) -> Named {
    match kind {
        None => named("Automatic", "As what the file says, or else the values"),
        Some(KindName::Scalar) => named("Scalar", "More is more of something: what is bright is shown"),
        Some(KindName::DarkOnBright) => named("Dark on bright", "What is darker than all around it is shown"),
        Some(KindName::HounsfieldCt) => named("CT", "Hounsfield units: bone and contrast agent are shown"),
        Some(KindName::Signed) => {
            named("Signed", "Strong values on both sides of zero are shown, in two colours")
        }
        Some(KindName::Mask) => named("Mask", "Something or nothing: a surface halfway between"),
        Some(KindName::LabelMap) => named("Labels", "Every number is shown, in a colour of its own"),
    }
}

/// Description of the kind of data of a volume.
pub(crate) fn kind(kind: DataKind) -> String {
    match kind {
        DataKind::Mask => "Mask".to_owned(),
        DataKind::LabelMap { count: 1 } => "Label map, 1 label".to_owned(),
        DataKind::LabelMap { count } => format!("Label map, {count} labels"),
        DataKind::Signed => "Signed field".to_owned(),
        DataKind::HounsfieldCt { .. } => "CT, Hounsfield units".to_owned(),
        DataKind::DarkOnBright => "Dark object on bright".to_owned(),
        DataKind::Scalar => "Scalar field".to_owned(),
    }
}

pub(crate) const RANGE: Named = named(
    "Range",
    "The values among which the picture tells differences; what lies outside looks like the nearest of them. Control \
     points beyond it widen it",
);
pub(crate) const ROBUST: Named =
    named("Robust", "The values that matter: without padding and without a few outliers");
pub(crate) const FULL: Named = named("Full", "All values of the file");
pub(crate) const TYPED: Named = named("Typed", "From one value to another");
pub(crate) const LOW: Named = named(
    "Lowest value shown",
    "In the units of the file. It stops below the highest value: raise that first",
);
pub(crate) const HIGH: Named = named(
    "Highest value shown",
    "In the units of the file. It stops above the lowest value: lower that first",
);
pub(crate) const SHOWN: &str = "Shown";

/// Range of values shown within the range of the file, both formatted.
pub(crate) fn shown([low, high]: &[String; 2], [lowest, highest]: &[String; 2]) -> String {
    format!("{low} … {high} of {lowest} … {highest}")
}

pub(crate) const OPACITY_UNIT: Named = named(
    "Opacity unit",
    "The thickness of material to which the opacities of the transfer function refer: larger makes \
     everything more transparent",
);
/// Accessible name of the list of units for the opacity unit.
pub(crate) const UNITS: &str = "Unit of the opacity unit";
pub(crate) const MILLIMETRES: Named = named("mm", "Stays the same for every volume of the same thing");
pub(crate) const VOXELS: Named = named("voxels", "Follows the resolution of the data");
pub(crate) const EXTENT: Named = named("extent", "A share of the longest edge of the volume");

/// Formatted length with its unit.
pub(crate) fn length(digits: &str, unit: Named) -> String {
    format!("{digits} {}", unit.name)
}

/// Number of voxels along x, y and z.
pub(crate) fn dimensions([x, y, z]: [usize; 3]) -> String {
    format!("{x} × {y} × {z}")
}

/// Unit in which voxel spacings are displayed.
pub(crate) fn unit_of_spacing(spacing_mm: [f64; 3], is_unknown: bool) -> LengthUnit {
    if is_unknown {
        return LengthUnit { mm: 1.0, suffix: " (unit unknown)" };
    }
    LengthUnit::of(SpacingUnit::of_spacing(spacing_mm))
}

/// Formatted voxel spacings along x, y and z, with their unit.
pub(crate) fn spacing([x, y, z]: &[String; 3], unit: LengthUnit) -> String {
    format!("{x} × {y} × {z}{}", unit.suffix)
}

/// Formatted smallest and largest value.
pub(crate) fn values(low: &str, high: &str) -> String {
    format!("{low} … {high}")
}

/// Memory of the voxels, in MiB.
pub(crate) fn memory(mebibytes: f64) -> String {
    format!("{mebibytes:.1} MiB")
}

/// Number of voxels that are NaN or infinite.
pub(crate) fn not_finite(voxels: usize) -> String {
    format!("{voxels} voxels, shown as the smallest value")
}
