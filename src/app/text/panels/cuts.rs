//! Texts of the clipping section: crop box, clip plane, and cuts by shapes.

use crate::app::text::common::LengthUnit;
use crate::app::text::{ControlText, control_text};
use chiaroscuro_scene::{CutAction, CutShapeKind};

/// Text in place of the section while no volume is open.
pub(crate) const NOTHING_OPEN: &str = "Nothing is open";

/// Names of the axes of the volume.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

const EFFECT_TIP: &str = "Whether the part that is cut away is visible, and whether it casts shadows";

pub(crate) const CROP: ControlText =
    control_text("Crop box", "Cuts away everything outside a box; drag its sides in the picture");
pub(crate) const EXTENT_TIP: &str = "First and last voxel that remain";
/// Separator between the first and the last voxel.
pub(crate) const RANGE_SEPARATOR: &str = "–";
/// Effect on the part outside the crop box.
pub(crate) const OUTSIDE: ControlText = control_text("Outside", EFFECT_TIP);

pub(crate) const PLANE: ControlText = control_text(
    "Clip plane",
    "Cuts away everything in front of a plane; drag its square to move it and the arrow to turn it",
);
pub(crate) const OFFSET: ControlText =
    control_text("Offset", "Distance from the middle of the volume, in the direction that the plane faces");
pub(crate) const FACING: ControlText =
    control_text("Facing", "Direction that the plane faces; everything in front of it is cut away");
pub(crate) const FLIP: ControlText = control_text("Flip", "Cuts the other side away");
pub(crate) const TOWARDS_EYE: ControlText =
    control_text("Towards the eye", "Turns the plane perpendicular to the line of sight");
/// Effect on the part in front of the clip plane.
pub(crate) const IN_FRONT: ControlText = control_text("In front", EFFECT_TIP);

/// Effect of a cut by a shape on the part inside it, or on all else if that part is kept.
pub(crate) const INSIDE_SHAPE: ControlText = control_text("Inside", EFFECT_TIP);
pub(crate) const OUTSIDE_SHAPE: ControlText = control_text("All else", EFFECT_TIP);

pub(crate) const REMOVED: &str = "Hidden, no shadow";
pub(crate) const HIDDEN: &str = "Hidden, shadow stays";
pub(crate) const SHADOWLESS: &str = "Visible, no shadow";

/// Buttons that begin a cut by a shape.
pub(crate) const BY_SHAPE: ControlText = control_text(
    "By shape",
    "Cuts parts away in the picture; hold Q to draw around a part, or to click one, at any time",
);
/// Tooltip of a cut in the list of cuts by shapes.
pub(crate) const SHAPE_TIP: &str = "Cut by a shape; without the tick, what it hides is visible again";
pub(crate) const REMOVE_SHAPE: ControlText = control_text("×", "Removes the cut");
pub(crate) const REMOVE_SHAPES: ControlText =
    control_text("Show cut parts again", "Removes all cuts by shapes");
/// Tooltip of the button that changes the action of a cut.
pub(crate) const ACTION_TIP: &str =
    "Whether the part inside is cut away, is kept alone, or is shown again; a click takes the next";
/// Depths of an outline, and the tooltip of the button that changes between them.
pub(crate) const THROUGH: &str = "through";
pub(crate) const FRONT: &str = "front";
pub(crate) const DEPTH_TIP: &str =
    "Whether the outline cuts through everything, or only the surface that was seen first";
/// Hint on the end of cutting.
pub(crate) const ESCAPE_ENDS: &str = "Esc ends cutting";

/// Name and effect of the command that begins cutting by a kind of shape.
pub(crate) fn cut_by_shape(kind: CutShapeKind) -> ControlText {
    match kind {
        CutShapeKind::Outline => control_text(
            "Cut by outline",
            "Hides what lies behind a line that you draw around it in the picture",
        ),
        CutShapeKind::Sphere => {
            control_text("Cut by ball", "Hides a ball around the place that you click in the picture")
        }
        CutShapeKind::Box => control_text(
            "Cut the near corner",
            "Hides the eighth of the volume that faces you, so that three faces of its inside are seen",
        ),
        CutShapeKind::HalfSpace => control_text(
            "Cut the near half",
            "Hides everything in front of a plane through the middle that faces you",
        ),
        CutShapeKind::Component => {
            control_text("Cut a part", "Hides the part that you click, with all that is connected with it")
        }
    }
}

/// Name of a kind of shape.
pub(crate) fn shape_name(kind: CutShapeKind) -> &'static str {
    match kind {
        CutShapeKind::Outline => "Outline",
        CutShapeKind::Sphere => "Ball",
        CutShapeKind::Box => "Corner",
        CutShapeKind::HalfSpace => "Near half",
        CutShapeKind::Component => "Part",
    }
}

/// Effect of a cut on what is inside its shape.
pub(crate) fn action_name(action: CutAction) -> &'static str {
    match action {
        CutAction::Hide => "hidden",
        CutAction::Keep => "kept",
        CutAction::Restore => "shown",
    }
}

/// Hint on the gestures while cutting by a kind of shape, with Shift or without.
pub(crate) fn shape_hint(kind: CutShapeKind, is_reversed: bool) -> &'static str {
    match (kind, is_reversed) {
        (CutShapeKind::Outline, false) => {
            "Draw around what to hide, or click a part · with Shift, it is kept alone"
        }
        (CutShapeKind::Outline, true) => "Draw around what to keep, or click it: all else is hidden",
        (CutShapeKind::Sphere, false) => "Click to hide a ball · wheel: size · with Shift, it is shown again",
        (CutShapeKind::Sphere, true) => "Click to show what was hidden in the ball · wheel: size",
        (CutShapeKind::Box | CutShapeKind::HalfSpace, _) => {
            "The sides of a corner or a half are set in the section Clipping"
        }
        (CutShapeKind::Component, false) => "Click the part to hide · with Shift, it is kept alone",
        (CutShapeKind::Component, true) => "Click the part to keep: all else is hidden",
    }
}

/// Tooltip of the first and last voxel that a corner hides.
pub(crate) const CORNER_EXTENT_TIP: &str = "First and last voxel of the corner";

/// Place of the plane of a half-space.
pub(crate) const HALF_OFFSET: ControlText =
    control_text("Plane at", "Distance from the middle of the volume, in the direction that the plane faces");

/// Accessible name of the first voxel of a corner along an axis.
pub(crate) fn corner_from(axis: &str) -> String {
    format!("Corner {axis} from")
}

/// Accessible name of the last voxel of a corner along an axis.
pub(crate) fn corner_to(axis: &str) -> String {
    format!("Corner {axis} to")
}

/// Extent of the crop box along an axis, as the tooltip of its reset button names it.
pub(crate) fn crop(axis: &str) -> String {
    format!("crop {axis}")
}

/// Range of voxels inside the crop box along an axis.
pub(crate) fn voxels(from: f64, to: f64) -> String {
    format!("{from:.0} … {to:.0}")
}

/// Accessible name of the first voxel inside the box along an axis.
pub(crate) fn crop_from(axis: &str) -> String {
    format!("Crop {axis} from")
}

/// Accessible name of the last voxel inside the box along an axis.
pub(crate) fn crop_to(axis: &str) -> String {
    format!("Crop {axis} to")
}

/// Length of the crop box along an axis.
pub(crate) fn length(length_mm: f64, unit: LengthUnit) -> String {
    let length = length_mm / unit.mm;
    if length < 100.0 { format!("{length:.1}{}", unit.suffix) } else { format!("{length:.0}{}", unit.suffix) }
}

/// Tooltip of the button that turns the clip plane across an axis.
pub(crate) fn across_tooltip(axis: &str) -> String {
    format!("Perpendicular to the {axis} axis")
}

/// Accessible name of the list of effects on a part: outside the box or in front of the plane.
pub(crate) fn effect_name(part: &str) -> String {
    format!("{part}: effect")
}
