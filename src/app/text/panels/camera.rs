//! Texts of the camera section.

use crate::app::text::{ControlText, control_text};
use chiaroscuro_scene::SceneAxis;

pub(crate) const PROJECTION: ControlText = control_text("Projection", "Perspective or parallel projection");
pub(crate) const PERSPECTIVE: ControlText =
    control_text("Perspective", "Near objects look larger, as in a photograph");
pub(crate) const ORTHOGRAPHIC: ControlText =
    control_text("Orthographic", "The same scale at every depth, so that lengths can be compared by eye");

pub(crate) const UP: ControlText = control_text(
    "Up",
    "The axis of the data that points up: the object stands upright, lies down or is upside down",
);

/// Name and tooltip of an axis that can point up.
pub(crate) const fn axis(axis: SceneAxis) -> ControlText {
    match axis {
        SceneAxis::PlusX => control_text("+x", "High x is at the top"),
        SceneAxis::MinusX => control_text("−x", "Low x is at the top"),
        SceneAxis::PlusY => control_text("+y", "High y is at the top"),
        SceneAxis::MinusY => control_text("−y", "Low y is at the top"),
        SceneAxis::PlusZ => control_text("+z", "High z is at the top"),
        SceneAxis::MinusZ => control_text("−z", "Low z is at the top"),
    }
}

pub(crate) const AZIMUTH: ControlText =
    control_text("Azimuth", "Angle around the vertical axis; drag the picture sideways");
pub(crate) const ELEVATION: ControlText =
    control_text("Elevation", "Angle above the horizontal plane; drag the picture up or down");
pub(crate) const ROLL: ControlText = control_text("Roll", "Rotates the picture about the line of sight");
pub(crate) const DISTANCE: ControlText = control_text(
    "Distance",
    "Distance from the camera to the middle of the view; the mouse wheel changes it, too",
);
pub(crate) const FIELD_OF_VIEW: ControlText = control_text(
    "Field of view",
    "Vertical angle of view of the part chosen under Fit to; a wide angle exaggerates depth",
);
pub(crate) const FIT: ControlText = control_text(
    "Fit to",
    "Part of the picture that the field of view spans: matters in pictures narrower than 4:3",
);
pub(crate) const FRAME: ControlText = control_text(
    "4:3 frame",
    "A frame in the middle that is always fully visible: narrow pictures show more above and below",
);
pub(crate) const HEIGHT: ControlText =
    control_text("Height", "The picture's height: narrow pictures show less at the sides");

pub(crate) const RESET_VIEW: ControlText =
    control_text("Reset view", "The view with which the volume was opened");
