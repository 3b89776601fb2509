//! Texts of the camera section.

use crate::app::text::{ControlText, control_text};
use crate::model::SceneAxis;

pub(crate) const PROJECTION: ControlText = control_text("Projection", "How the picture is projected");
pub(crate) const PERSPECTIVE: ControlText = control_text("Perspective", "Near things are larger: natural");
pub(crate) const ORTHOGRAPHIC: ControlText =
    control_text("Orthographic", "Lengths compare across the picture: for measuring by eye");

pub(crate) const UP: ControlText = control_text(
    "Up",
    "Which axis of the data points up: the object stands up, lies down or stands on its head",
);

/// Name and tooltip of an axis that can point up.
pub(crate) const fn axis(axis: SceneAxis) -> ControlText {
    match axis {
        SceneAxis::PlusX => control_text("+x", "What is at high x is at the top"),
        SceneAxis::MinusX => control_text("−x", "What is at low x is at the top"),
        SceneAxis::PlusY => control_text("+y", "What is at high y is at the top"),
        SceneAxis::MinusY => control_text("−y", "What is at low y is at the top"),
        SceneAxis::PlusZ => control_text("+z", "What is at high z is at the top"),
        SceneAxis::MinusZ => control_text("−z", "What is at low z is at the top"),
    }
}

pub(crate) const AZIMUTH: ControlText =
    control_text("Azimuth", "Around the vertical axis; drag the picture sideways");
pub(crate) const ELEVATION: ControlText =
    control_text("Elevation", "Above the horizontal plane; drag the picture up or down");
pub(crate) const ROLL: ControlText = control_text("Roll", "Turns the picture");
pub(crate) const DISTANCE: ControlText =
    control_text("Distance", "From the eye to the middle of the view. The wheel does the same");
pub(crate) const FIELD_OF_VIEW: ControlText =
    control_text("Field of view", "Vertical angle of view, of what it is fitted to: wide exaggerates depth");
pub(crate) const FIT: ControlText =
    control_text("Fit to", "What the field of view belongs to: it matters in pictures narrower than 4:3");
pub(crate) const FRAME: ControlText = control_text(
    "4:3 frame",
    "A frame in the middle that is always seen whole: narrow pictures show more above and below",
);
pub(crate) const HEIGHT: ControlText =
    control_text("Height", "The picture's height: narrow pictures show less at the sides");

pub(crate) const RESET_VIEW: ControlText =
    control_text("Reset view", "The view with which the volume was opened");
