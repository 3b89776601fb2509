//! Texts of the floor section.

use crate::app::text::{ControlText, control_text};

pub(crate) const ON: ControlText = control_text(
    "Floor under the volume",
    "A floor under the volume that receives its shadows; visible from above",
);
pub(crate) const HEIGHT: ControlText = control_text(
    "Height",
    "Height above the middle of the volume; initially under the part that was visible when it was opened",
);
pub(crate) const RADIUS: ControlText =
    control_text("Radius", "Distance from the middle at which the floor has faded out");
pub(crate) const OPACITY: ControlText =
    control_text("Floor opacity", "How much of the background the floor covers");
pub(crate) const COLOR: ControlText = control_text("Floor colour", "Colour of the floor in white light");
pub(crate) const SHADOW_ALONE: ControlText = control_text(
    "Shadow alone",
    "Shows only the shadows on the floor: for light backgrounds and transparent pictures",
);
