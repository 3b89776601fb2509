//! Texts of opening volumes and looks, and of the window's title.

use std::fmt::Display;
use std::path::Path;

use chiaroscuro_files::sanitised;
use chiaroscuro_volume::VolumeAlternatives;

/// Title of the window while no volume is open.
pub(crate) const PROGRAM: &str = "Chiaroscuro";

/// Phases of opening a volume, in this order.
pub(crate) const READING: &str = "Reading";
pub(crate) const MEASURING_ADAPTER: &str = "Testing the capacity of the graphics adapter";
pub(crate) const COUNTING: &str = "Counting values";
pub(crate) const UPLOADING: &str = "Uploading";
pub(crate) const FIRST_LOOK: &str = "Finding a first look";

/// Headlines of errors; the reason is in the details.
pub(crate) const NOT_OPENED: &str = "Cannot open";
pub(crate) const HEADER_NOT_WRITTEN: &str = "The header was not written";
pub(crate) const SETTINGS_NOT_LOADED: &str = "The settings were not loaded";
pub(crate) const SETTINGS_NOT_SAVED: &str = "The session was not saved";
pub(crate) const SESSION_NOT_LOADED: &str = "The session was not loaded";

/// Warnings about settings that were loaded nevertheless.
pub(crate) const OTHER_VOLUME: &str =
    "The settings were made for another volume; File › Open… with the same file opens that volume";
pub(crate) const OTHER_VALUES: &str = "The settings were made for other values than the file has now";

/// Desktop message when no window opens: the failure, then in a second paragraph the reason and the remedy.
pub(crate) fn no_window(why: &str) -> String {
    let mut letters = why.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("The window of Chiaroscuro could not be opened.\n\n{first}{}.", letters.as_str())
}

/// Title of the window with the name of the open volume.
pub(crate) fn title(volume: &str) -> String {
    format!("{volume} – {PROGRAM}")
}

/// Message after a session was written to a file.
pub(crate) fn session_saved(file: &Path) -> String {
    format!("Saved {}", file.display())
}

/// Headline when the loader of a volume panicked.
pub(crate) fn loader_panicked(source: &Path) -> String {
    format!("Opening {} failed", source.display())
}

/// Details of the error when a loader panicked.
pub(crate) fn panic_details(panic: &str) -> String {
    format!("the loader stopped unexpectedly: {panic}")
}

/// Error for a file of zero bytes.
pub(crate) fn empty_file(source: &Path) -> String {
    format!("{} is empty: copy it again", source.display())
}

/// Headline for a volume that was read but does not fit the graphics adapter.
pub(crate) fn not_shown(source: &Path) -> String {
    format!("Cannot show {}", source.display())
}

/// Message that voxels were averaged because the graphics adapter cannot hold all of them.
pub(crate) fn downsampled(before: [usize; 3], after: [usize; 3]) -> String {
    let [before, after] = [before, after].map(crate::app::text::panels::data::dimensions);
    format!("{before} voxels are shown as {after}: the graphics adapter cannot hold more")
}

/// Message that the first of several volumes in a file is shown: none was selected, or the selected one does not
/// exist.
pub(crate) fn first_of_several(several: &VolumeAlternatives) -> String {
    let (count, plural) = (several.offers.len(), several.dimension.plural());
    let first = several.offers.first().map_or("", |first| first.name.as_str());
    let first = if first.is_empty() { String::new() } else { format!(" ({first})") };
    match &several.unmatched_selection {
        None => format!("The first of {count} {plural} is shown{first}: the section Data offers the others"),
        Some(said) => {
            let said = sanitised(said, 60);
            format!("{said} is none of the {count} {plural} in the file: the first is shown{first}")
        }
    }
}

/// Message that slices were dropped and their whole folder is opened.
pub(crate) fn folder_of_dropped(count: usize, folder: &Path) -> String {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    format!("{count} files were dropped: all slices of their folder {} are opened", sanitised(&name, 60))
}

/// Message that some slices of a folder were dropped, and only these are opened.
pub(crate) fn part_of_folder(count: usize, folder: &Path) -> String {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    format!("Only the {count} dropped slices of the folder {} are opened", sanitised(&name, 60))
}

/// Message that unrelated files were dropped, and the first is opened.
pub(crate) fn first_of_dropped(count: usize, first: &Path) -> String {
    let name = first.file_name().unwrap_or_default().to_string_lossy();
    format!("{count} files were dropped: the first, {}, is opened", sanitised(&name, 60))
}

/// Title of the question about a dropped volume.
pub(crate) const SECOND_VOLUME: &str = "Two volumes";
pub(crate) const SHOW_BOTH: &str = "Show both";
pub(crate) const OPEN_ALONE: &str = "Open it alone";

/// Question about a dropped volume that lies where the open one does.
pub(crate) fn lies_over(name: &str, open: &str) -> String {
    let (name, open) = (sanitised(name, 60), sanitised(open, 60));
    format!(
        "{name} lies in the same place as {open}. Both can be shown in one picture, each with its own curve."
    )
}

/// Note that a volume is shown below those that were open before it.
pub(crate) fn shown_below(name: &str) -> String {
    let name = sanitised(name, 60);
    format!("{name} is the first layer: the others are shown over it, on its grid")
}

/// Message when the open volume does not lie in a folder.
pub(crate) const NO_FOLDER: &str = "The open volume is not in a folder";

/// Message when the folder has no further file in this direction.
pub(crate) fn no_neighbour(is_forward: bool) -> &'static str {
    if is_forward {
        "This is the last volume of its folder"
    } else {
        "This is the first volume of its folder"
    }
}

/// Error when the loader thread cannot be spawned.
pub(crate) fn no_thread(err: impl Display) -> String {
    format!("could not start the loader thread: {err}")
}
