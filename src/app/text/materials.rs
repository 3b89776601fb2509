//! Texts of the editor of materials by value and change.

use super::{ControlText, control_text};

/// Accessible name of the plane.
pub(crate) const PLANE: &str = "Materials by value and change";

/// Entry of the menu of shapes that turns the curve into materials.
pub(crate) const USE_MATERIALS: ControlText = control_text(
    "Materials by value and change",
    "Boxes over a histogram of values and of their changes between voxels take the place of the curve: \
     inner parts are spots at the bottom, borders are arcs above",
);
pub(crate) const USE_CURVE: ControlText =
    control_text("Curve", "Removes all materials and shows the curve again, as it was");
pub(crate) const PICK: ControlText = control_text(
    "Pick materials",
    "Makes materials of the parts that are clicked in the picture, separated by value and change",
);
pub(crate) const ESCAPE_ENDS: &str = "Esc ends picking";

/// Hint while parts are clicked, after a number of clicks.
pub(crate) fn pick_hint(clicks: usize) -> &'static str {
    match clicks {
        0 => "Click a part; cuts show what lies inside",
        1 => "Click another part, which gets a colour of its own",
        _ => "Click a further part, or change the boxes below",
    }
}

pub(crate) const ADD: ControlText =
    control_text("+ Material", "Adds a material; a drag over an empty part of the plane draws one");
pub(crate) const REMOVE: ControlText =
    control_text("Remove", "Removes the selected material; without any, the curve is shown again");
pub(crate) const COLOR: &str = "Colour of the material";
pub(crate) const OPACITY: ControlText =
    control_text("Opacity", "Opacity of the selected material, for light as well");
pub(crate) const SOFTNESS: ControlText =
    control_text("Softness", "Share of the box over which the material fades at its borders");
pub(crate) const VALUES: ControlText = control_text("Values", "Lowest and highest value of the material");
pub(crate) const CHANGES: ControlText = control_text(
    "Changes",
    "Smallest and largest change of the value from voxel to voxel: small inside of parts, large at borders",
);

/// Returns the number of a material, counted from 1.
pub(crate) fn number(index: usize) -> String {
    (index + 1).to_string()
}

/// Returns the name of a material, counted from 1.
pub(crate) fn name(index: usize) -> String {
    format!("Material {}", index + 1)
}

/// Label of the upper end of the axis of changes, after its number.
pub(crate) fn largest_change(change: &str) -> String {
    format!("change {change}")
}

/// Value and change at the pointer.
pub(crate) fn readout(value: &str, change: &str) -> String {
    format!("{value}, change {change}")
}
