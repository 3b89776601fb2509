//! Texts of the floor section.

use crate::app::text::{ControlText, control_text};

pub(crate) const ON: ControlText = control_text(
    "Floor under the volume",
    "A floor under the volume that shows its shadows; seen from above",
);
pub(crate) const HEIGHT: ControlText = control_text(
    "Height",
    "Above the middle of the volume; at first under what was shown when it was opened",
);
pub(crate) const RADIUS: ControlText =
    control_text("Radius", "Where the floor has faded out, from the middle");
pub(crate) const OPACITY: ControlText =
    control_text("Floor opacity", "How much of the background the floor covers");
pub(crate) const COLOR: ControlText = control_text("Floor colour", "Its own colour, in white light");
pub(crate) const SHADOW_ALONE: ControlText = control_text(
    "Shadow alone",
    "Only what darkens the floor is seen: for light backgrounds and transparent pictures",
);
