//! Opening volumes and looks, and the window's title.

use crate::data::load::{Dimension, Offer};
use std::fmt::Display;
use std::path::Path;

/// What the window is called while no volume is open.
pub(crate) const PROGRAM: &str = "Chiaroscuro";

/// What is being done with a volume, in this order.
pub(crate) const READING: &str = "reading";
pub(crate) const FITTING: &str = "trying what the graphics adapter can hold";
pub(crate) const COUNTING: &str = "counting values";
pub(crate) const UPLOADING: &str = "uploading";
pub(crate) const FIRST_LOOK: &str = "finding a first look";

/// What did not work; why is said with the details.
pub(crate) const NOT_OPENED: &str = "cannot open";
pub(crate) const HEADER_NOT_WRITTEN: &str = "the header was not written";
pub(crate) const SETTINGS_NOT_LOADED: &str = "the settings were not loaded";
pub(crate) const SETTINGS_NOT_SAVED: &str = "the settings were not saved";
pub(crate) const SESSION_NOT_LOADED: &str = "the session was not loaded";

/// Settings that were loaded all the same.
pub(crate) const OF_ANOTHER_VOLUME: &str = "The settings were made for another volume: Open… opens that one";
pub(crate) const OF_OTHER_VALUES: &str = "The settings were made for other values than the file has now";

/// On the desktop, where no window opens: that it does not, and in a paragraph of its own why, and what helps.
pub(crate) fn no_window(why: &str) -> String {
    let mut letters = why.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("The window of Chiaroscuro could not be opened.\n\n{first}{}.", letters.as_str())
}

/// The window's title, with what the open volume is called.
pub(crate) fn title(volume: &str) -> String {
    format!("{volume} – {PROGRAM}")
}

/// Settings were written to a file.
pub(crate) fn saved(file: &Path) -> String {
    format!("Saved {}", file.display())
}

/// Which volume could not be opened, after its loader panicked.
pub(crate) fn failed(source: &Path) -> String {
    format!("Opening {} failed", source.display())
}

/// What a loader said that panicked.
pub(crate) fn stopped(panic: &str) -> String {
    format!("the loader stopped unexpectedly: {panic}")
}

/// A file without content.
pub(crate) fn empty(source: &Path) -> String {
    format!("{} is empty: copy it again", source.display())
}

/// A volume that was read and is beyond the graphics card.
pub(crate) fn not_shown(source: &Path) -> String {
    format!("cannot show {}", source.display())
}

/// The graphics adapter cannot hold all voxels of a volume.
pub(crate) fn averaged(before: [usize; 3], after: [usize; 3]) -> String {
    let [before, after] = [before, after].map(crate::app::text::panels::data::dimensions);
    format!("{before} voxels are shown as {after}: the graphics adapter cannot hold more")
}

/// A file holds several volumes, of which the first is shown.
pub(crate) fn one_of_several(first: &Offer, count: usize, dimension: Dimension) -> String {
    let (plural, option) = (dimension.plural(), dimension.option());
    format!("The first of {count} {plural} is shown: {first}. Start with {option} for another one")
}

/// The system is out of threads.
pub(crate) fn no_thread(err: impl Display) -> String {
    format!("no thread for the loader: {err}")
}
