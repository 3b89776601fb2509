//! Texts of the confirmation before a look opens a volume outside its own folder.

pub(crate) const TITLE: &str = "Open the volume of this look?";

/// Reason why the confirmation is needed.
pub(crate) const OUTSIDE: &str =
    "The look names a file outside its own folder that you have not opened here before";

pub(crate) const OPEN: &str = "Open it";
pub(crate) const CHOOSE: &str = "Choose another file…";
pub(crate) const NOT_NOW: &str = "Only the look";
