//! Texts of the data section: metadata and range of the open volume.

use crate::app::text::common::LengthUnit;
use crate::app::text::{ControlText, control_text};
use chiaroscuro_scene::{LayerBlend, LayerVisibility};
use chiaroscuro_volume::{DataKind, Downsampling, KindName, Portion, SpacingUnit, VoxelRegion};

/// Text in place of the section while no volume is open.
pub(crate) const NOTHING_OPEN: &str = "No volume is open";

pub(crate) const NAME: &str = "Name";
pub(crate) const SOURCE: &str = "Source";
pub(crate) const DIMENSIONS: &str = "Voxels";
/// Labels for a volume of which a part was read: the dimensions of the file, and the region.
pub(crate) const READ_OF: &str = "In file";
pub(crate) const REGION: &str = "Region";
pub(crate) const VOXEL_TYPE: &str = "Type";
pub(crate) const KIND: &str = "Kind";
pub(crate) const SPACING: &str = "Spacing";
pub(crate) const VALUES: &str = "Values";
pub(crate) const MEMORY: &str = "Memory";
pub(crate) const NOT_FINITE: &str = "Not finite";

/// Labels of the layers, in the order in which they are composed.
pub(crate) const LAYERS: [&str; 4] = ["Layer 1", "Layer 2", "Layer 3", "Layer 4"];
pub(crate) const ALL_LAYERS: ControlText =
    control_text("Layers", "Volumes that are shown together, such as a scan and its segmentation");
pub(crate) const ADD_LAYER: &str = "Add…";
pub(crate) const REMOVE_LAYER: &str = "Remove";
pub(crate) const REMOVE_LAYER_TIP: &str =
    "Shows the volume of the selected layer no longer; no file is changed";
/// Reason why the first layer is not removed.
pub(crate) const FIRST_LAYER_STAYS: &str =
    "The first layer stays, since the others lie on its grid: hide it, or open another volume";
pub(crate) const LAYER_COLOR: &str = "Colour of the layer";
pub(crate) const LAYER_VISIBILITY: ControlText =
    control_text("Layer is", "Presence of the layer in the picture and in its light");
/// Tooltip of the row of a layer.
pub(crate) const LAYER_TIP: &str =
    "A click on the name selects the layer: its curve, range and light are then edited";
pub(crate) const LAYER_ALONE: ControlText =
    control_text("Only this layer", "Hides the other layers, with their shadows; off shows all");
pub(crate) const LAYER_EDGES: ControlText = control_text(
    "Edges only",
    "Change of density per voxel at which material has the opacity of the curve. Where density changes less, it fades, \
     which leaves borders between materials; 0 shows everything",
);
pub(crate) const LAYER_OUTLINES: ControlText = control_text(
    "Outlines only",
    "Leaves the borders of labels, and the scan shows its own colours inside of them",
);
pub(crate) const LAYER_IGNORES_CUTS: ControlText = control_text(
    "Never cut",
    "Leaves the layer whole where the crop box, the clip plane and shapes cut others, such as vessels in a cut head",
);
pub(crate) const LAYER_BLEND: ControlText =
    control_text("Layer does", "Effect of the layer on those before it");
pub(crate) const LAYER_STRENGTH: ControlText =
    control_text("Layer density", "Factor of the layer's opacities, relative to the length of its data");

/// Name and tooltip of the visibility of a layer.
pub(crate) fn layer_visibility(visibility: LayerVisibility) -> ControlText {
    match visibility {
        LayerVisibility::Shown => control_text("Shown", "Seen, and casts shadows"),
        LayerVisibility::CastsShadows => control_text("Casts", "Not seen, but casts shadows"),
        LayerVisibility::Hidden => control_text("Hidden", "Neither seen nor casting shadows"),
    }
}

/// Name and tooltip of the blend of a layer.
pub(crate) fn layer_blend(blend: LayerBlend) -> ControlText {
    match blend {
        LayerBlend::Add => control_text("Add", "Adds its own material"),
        LayerBlend::Tint => control_text("Tint", "Colours the layers before it where it is opaque"),
        LayerBlend::Gate => control_text("Gate", "Keeps the layers before it only where it is opaque"),
        LayerBlend::Red => control_text("Red", "Replaces red of the layers before it by its density"),
        LayerBlend::Green => control_text("Green", "Replaces green of the layers before it by its density"),
        LayerBlend::Blue => control_text("Blue", "Replaces blue of the layers before it by its density"),
    }
}

pub(crate) const SUBSAMPLE: ControlText = control_text(
    "Subsample",
    "Shows fewer voxels, each one of several or the mean of a block: faster pictures and less memory, \
     without the finest details. The volume is read again; the look stays",
);

/// Name and tooltip of a subsampling.
pub(crate) fn subsampling(thinning: Downsampling) -> ControlText {
    match thinning {
        Downsampling::Every(2) => {
            control_text("Every second", "An eighth of the voxels, with unchanged values")
        }
        Downsampling::Every(4) => {
            control_text("Every fourth", "A sixty-fourth of the voxels, with unchanged values")
        }
        Downsampling::Average(2) => {
            control_text("Means of 2 × 2 × 2", "An eighth of the voxels, each the mean of a block")
        }
        Downsampling::Average(4) => {
            control_text("Means of 4 × 4 × 4", "A sixty-fourth of the voxels, each the mean of a block")
        }
        Downsampling::Every(2..) => control_text("Every few", "One of several voxels along each axis"),
        Downsampling::Average(2..) => {
            control_text("Means of blocks", "Each voxel is the mean of a larger block")
        }
        Downsampling::None | Downsampling::Every(_) | Downsampling::Average(_) => {
            control_text("All", "All voxels of the file")
        }
    }
}

/// Dimensions of the file with the subsampling that was applied; the adapter may have averaged further.
pub(crate) fn file_dimensions(portion: &Portion, file_dims: [usize; 3]) -> String {
    let all = dimensions(file_dims);
    match portion.thinning {
        Downsampling::Every(n @ 2..) => format!("{all}, every {}", ordinal(n)),
        Downsampling::None | Downsampling::Every(_) | Downsampling::Average(_) => format!("{all}, averaged"),
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
pub(crate) fn region(region: &VoxelRegion, grid: [usize; 3]) -> String {
    format!("{region} of {}", dimensions(grid))
}

pub(crate) const TREAT_AS: ControlText = control_text(
    "Treat as",
    "Makes a new first look for another kind of data: transfer function, view and lights. It can be undone",
);

/// Name and tooltip of a kind of data that the volume can be treated as; `None` is the automatic choice.
pub(crate) fn kind_choice(kind: Option<KindName>) -> ControlText {
    match kind {
        None => control_text("Automatic", "As the metadata of the file say, or else the values"),
        Some(KindName::Scalar) => {
            control_text("Scalar", "A quantity: bright objects on a dark background are shown")
        }
        Some(KindName::DarkOnBright) => {
            control_text("Dark on bright", "Objects darker than their background are shown")
        }
        Some(KindName::HounsfieldCt) => {
            control_text("CT", "Hounsfield units: bone and contrast agent are shown")
        }
        Some(KindName::Signed) => {
            control_text("Signed", "Large positive and negative values are shown, in two colours")
        }
        Some(KindName::Mask) => {
            control_text("Mask", "Object and background: a surface halfway between them is shown")
        }
        Some(KindName::LabelMap) => control_text("Labels", "Every label is shown in its own colour"),
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

pub(crate) const RANGE: ControlText = control_text(
    "Range",
    "The values that the picture distinguishes; values outside look like the nearest end of the range. \
     Control points outside widen it",
);
pub(crate) const ROBUST: ControlText =
    control_text("Robust", "The range of most values: without padding and without a few outliers");
pub(crate) const FULL: ControlText = control_text("Full", "All values of the file");
pub(crate) const TYPED_RANGE: ControlText = control_text("Typed", "Between two values that you enter");
pub(crate) const LOW: ControlText = control_text(
    "Lowest value shown",
    "In the units of the file. It stops below the highest value: raise that first",
);
pub(crate) const HIGH: ControlText = control_text(
    "Highest value shown",
    "In the units of the file. It stops above the lowest value: lower that first",
);
pub(crate) const SHOWN: &str = "Shown";

/// Range of values shown within the range of the file, both formatted.
pub(crate) fn range_shown([low, high]: &[String; 2], [lowest, highest]: &[String; 2]) -> String {
    format!("{low} … {high} of {lowest} … {highest}")
}

pub(crate) const OPACITY_UNIT: ControlText = control_text(
    "Opacity unit",
    "The thickness of material to which the opacities of the transfer function refer: larger makes \
     everything more transparent",
);
/// Accessible name of the list of units for the opacity unit.
pub(crate) const UNITS: &str = "Unit of the opacity unit";
pub(crate) const MILLIMETRES: ControlText =
    control_text("mm", "The same for every volume of the same object, whatever its resolution");
pub(crate) const VOXELS: ControlText = control_text("voxels", "Follows the resolution of the data");
pub(crate) const EXTENT: ControlText = control_text("extent", "A share of the longest edge of the volume");

/// Formatted length with its unit.
pub(crate) fn length(digits: &str, unit: ControlText) -> String {
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
    LengthUnit::from_spacing_unit(SpacingUnit::suiting_spacing(spacing_mm))
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
pub(crate) fn memory_size(mebibytes: f64) -> String {
    format!("{mebibytes:.1} MiB")
}

/// Number of voxels that are NaN or infinite.
pub(crate) fn non_finite_voxels(voxels: usize) -> String {
    format!("{voxels} voxels, treated as missing")
}
