//! The question before a look from outside opens a volume.

pub(crate) const TITLE: &str = "Open the volume of this look?";

/// Why it is asked.
pub(crate) const OUTSIDE: &str =
    "The look names a file outside its own folder that you have not opened here before";

pub(crate) const OPEN: &str = "Open it";
pub(crate) const CHOOSE: &str = "Choose another file…";
pub(crate) const NOT_NOW: &str = "Only the look";
