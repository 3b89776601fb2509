//! Texts of the camera section.

use crate::app::text::{Named, named};
use crate::model::SceneAxis;

pub(crate) const PROJECTION: Named = named("Projection", "How the picture is projected");
pub(crate) const PERSPECTIVE: Named = named("Perspective", "Near things are larger: natural");
pub(crate) const ORTHOGRAPHIC: Named =
    named("Orthographic", "Lengths compare across the picture: for measuring by eye");

pub(crate) const UP: Named =
    named("Up", "Which axis of the data points up: the object stands up, lies down or stands on its head");

/// Name and tooltip of an axis that can point up.
pub(crate) const fn axis(axis: SceneAxis) -> Named {
    match axis {
        SceneAxis::PlusX => named("+x", "What is at high x is at the top"),
        SceneAxis::MinusX => named("−x", "What is at low x is at the top"),
        SceneAxis::PlusY => named("+y", "What is at high y is at the top"),
        SceneAxis::MinusY => named("−y", "What is at low y is at the top"),
        SceneAxis::PlusZ => named("+z", "What is at high z is at the top"),
        SceneAxis::MinusZ => named("−z", "What is at low z is at the top"),
    }
}

pub(crate) const AZIMUTH: Named = named("Azimuth", "Around the vertical axis; drag the picture sideways");
pub(crate) const ELEVATION: Named =
    named("Elevation", "Above the horizontal plane; drag the picture up or down");
pub(crate) const ROLL: Named = named("Roll", "Turns the picture");
pub(crate) const DISTANCE: Named =
    named("Distance", "From the eye to the middle of the view. The wheel does the same");
pub(crate) const FIELD_OF_VIEW: Named =
    named("Field of view", "Vertical angle of view, of what it is fitted to: wide exaggerates depth");
pub(crate) const FIT: Named =
    named("Fit to", "What the field of view belongs to: it matters in pictures narrower than 4:3");
pub(crate) const FRAME: Named = named(
    "4:3 frame",
    "A frame in the middle that is always seen whole: narrow pictures show more above and below",
);
pub(crate) const HEIGHT: Named =
    named("Height", "The picture's height: narrow pictures show less at the sides");

pub(crate) const RESET_VIEW: Named = named("Reset view", "The view with which the volume was opened");
