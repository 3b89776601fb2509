//! Texts of the floor section.

use crate::app::text::{Named, named};

pub(crate) const ON: Named =
    named("Floor under the volume", "A floor under the volume that shows its shadows; seen from above");
pub(crate) const HEIGHT: Named =
    named("Height", "Above the middle of the volume; at first under what was shown when it was opened");
pub(crate) const RADIUS: Named = named("Radius", "Where the floor has faded out, from the middle");
pub(crate) const OPACITY: Named = named("Floor opacity", "How much of the background the floor covers");
pub(crate) const COLOR: Named = named("Floor colour", "Its own colour, in white light");
pub(crate) const SHADOW_ALONE: Named = named(
    "Shadow alone",
    "Only what darkens the floor is seen: for light backgrounds and transparent pictures",
);
