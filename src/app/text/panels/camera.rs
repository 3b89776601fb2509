//! The section of the camera.

use crate::app::text::{Named, named};

pub(crate) const PROJECTION: Named = named("Projection", "How the picture is projected");
pub(crate) const PERSPECTIVE: Named = named("Perspective", "Near things are larger: natural");
pub(crate) const ORTHOGRAPHIC: Named =
    named("Orthographic", "Lengths compare across the picture: for measuring by eye");

pub(crate) const AZIMUTH: Named = named("Azimuth", "Around the vertical axis; drag the picture sideways");
pub(crate) const ELEVATION: Named =
    named("Elevation", "Above the horizontal plane; drag the picture up or down");
pub(crate) const ROLL: Named = named("Roll", "Turns the picture");
pub(crate) const DISTANCE: Named = named(
    "Distance",
    "From the eye to the middle of the view; the volume's longest edge is 2 long. The wheel does the same",
);
pub(crate) const FIELD_OF_VIEW: Named =
    named("Field of view", "Vertical angle of view: wide exaggerates depth");

pub(crate) const RESET_VIEW: Named = named("Reset view", "The view with which the volume was opened");
