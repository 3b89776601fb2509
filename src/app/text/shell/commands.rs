//! Names of commands for menus, buttons and the list of shortcuts, and texts of the command palette.

use crate::app::text::data;
use chiaroscuro_volume::{Downsampling, KindName};

pub(crate) const OPEN_DIALOG: &str = "Open…";
/// Shows the start screen with the built-in scenes and recent files.
pub(crate) const SHOW_START: &str = "Start";

/// Opens a built-in scene.
pub(crate) fn open_scene(title: &str) -> String {
    format!("Open scene: {title}")
}

pub(crate) const OPEN_FOLDER: &str = "Open folder…";
pub(crate) const ADD_LAYER: &str = "Add volume as layer…";
pub(crate) const REMOVE_LAYER: &str = "Remove layer";
pub(crate) const NEXT_FILE: &str = "Next file of the folder";
pub(crate) const PREVIOUS_FILE: &str = "Previous file of the folder";
pub(crate) const TOGGLE_PLAYBACK: &str = "Play or pause time steps";
pub(crate) const USE_NUMBERED_FILES: &str = "Show numbered files as time steps";
pub(crate) const MEASURE_SERIES_RANGE: &str = "Use the range of all time steps";
pub(crate) const OPEN_DROPPED: &str = "Open dropped files";
pub(crate) const OPEN_PATH: &str = "Open path…";
/// Name of the command, and title of the submenu of built-in volumes.
pub(crate) const OPEN_BUILT_IN: &str = "Open built-in";
pub(crate) const SHOW_CHOICE: &str = "Show this one";
pub(crate) const CANCEL_OPENING: &str = "Cancel";
pub(crate) const REOPEN_LAST: &str = "Reopen last session";
pub(crate) const SAVE_SETTINGS: &str = "Save session…";
pub(crate) const LOAD_SETTINGS: &str = "Load session or settings…";
pub(crate) const EXPORT: &str = "Export picture or turntable…";
pub(crate) const COPY_PICTURE: &str = "Copy picture";
pub(crate) const KEEP_LOOK_FOR_NEXT: &str = "Keep look for next file";
pub(crate) const QUIT: &str = "Quit";

pub(crate) const UNDO: &str = "Undo";
pub(crate) const REDO: &str = "Redo";
pub(crate) const TOGGLE_HISTORY: &str = "History of steps…";
pub(crate) const TOGGLE_MESSAGES: &str = "All messages…";
pub(crate) const SHOW_PALETTE: &str = "Find a command…";

pub(crate) const RESET_VIEW: &str = "Reset view";
pub(crate) const FRAME_ALL: &str = "Frame all";
pub(crate) const TILT: &str = "Tilt by 90°";
pub(crate) const ROTATE: &str = "Rotate by 90°";
pub(crate) const TOGGLE_PROJECTION: &str = "Perspective or orthographic";
pub(crate) const NEXT_RENDER_MODE: &str = "Next render mode";
pub(crate) const TOGGLE_FULL_SCREEN: &str = "Full screen";
pub(crate) const TOGGLE_SIDE: &str = "Side panel";
pub(crate) const TOGGLE_STRIP: &str = "Saved views and looks";
pub(crate) const SAVE_VIEW: &str = "Save view";
pub(crate) const SAVE_LOOK: &str = "Save look";
pub(crate) const GO_TO_SAVED: &str = "Go to saved view or look";
pub(crate) const EXPORT_CONTACT_SHEET: &str = "Contact sheet of saved views…";
pub(crate) const TOGGLE_TRANSFER: &str = "Transfer function editor";
pub(crate) const PICTURE_ONLY: &str = "Picture only";
pub(crate) const LARGER: &str = "Larger interface";
pub(crate) const SMALLER: &str = "Smaller interface";
pub(crate) const DEFAULT_SIZE: &str = "Default interface size";
pub(crate) const TOGGLE_HANDLES: &str = "Handles";
pub(crate) const TOGGLE_OVERLAY: &str = "Overlays";
pub(crate) const TOGGLE_PROBE: &str = "Why is this dark? (probe)";
pub(crate) const TOGGLE_COMPARE: &str = "Compare two looks";
pub(crate) const COMPARE_WITH_FILE: &str = "Compare with settings…";
pub(crate) const SHOW_SLICES: &str = "Slices of the data";

pub(crate) const TOGGLE_CROP: &str = "Crop box";
pub(crate) const TOGGLE_PLANE: &str = "Clip plane";
pub(crate) const FACE_PLANE: &str = "Clip plane towards the eye";
pub(crate) const TOGGLE_FLOOR: &str = "Floor with shadows";
pub(crate) const TOGGLE_TABLE: &str = "Hide the table under a body";

pub(crate) const ADD_LIGHT: &str = "Add light";
pub(crate) const USE_LIGHTS: &str = "Use lights";
pub(crate) const USE_LOOK: &str = "Use look";
pub(crate) const TRY_LOOKS: &str = "Try looks…";

/// Command that goes to a setting: its section, and its row if there is one.
pub(crate) fn reveal(section: &str, row: Option<&str>) -> String {
    match row {
        Some(row) => format!("{section} › {row}"),
        None => section.to_owned(),
    }
}

pub(crate) const CANCEL_EXPORT: &str = "Stop exporting";
pub(crate) const SUGGEST_LIGHT: &str = "Suggest a light…";
pub(crate) const USE_ENVIRONMENT_MAP: &str = "Light from environment map…";
pub(crate) const TRY_LIGHTS: &str = "Try lights…";
pub(crate) const NEXT_LIGHT: &str = "Next light";
pub(crate) const PREVIOUS_LIGHT: &str = "Previous light";
pub(crate) const SOLO: &str = "Solo selected light";
pub(crate) const MUTE: &str = "Mute selected light";
pub(crate) const BRIGHTER: &str = "Brighter light";
pub(crate) const DIMMER: &str = "Dimmer light";
pub(crate) const BALANCE: &str = "Balance brightness";
pub(crate) const SHOW_LIGHT_VOLUME: &str = "Light volume…";

pub(crate) const TRY_PRESETS: &str = "Try presets…";
pub(crate) const AUTOMATIC_TRANSFER: &str = "Automatic transfer function";
pub(crate) const INVERT_TRANSFER: &str = "Invert opacities";
pub(crate) const IMPORT_TRANSFER: &str = "Import transfer function…";
pub(crate) const EXPORT_TRANSFER: &str = "Export transfer function…";

/// Title and hint of the command palette.
pub(crate) const FIND: &str = "Find a command";
pub(crate) const FIND_HINT: &str = "What do you want to do?";
pub(crate) const NOTHING_FOUND: &str = "No matches";

/// Command that rereads the volume with a subsampling.
pub(crate) fn subsample(thinning: Downsampling) -> String {
    match thinning.stride() {
        1 => "Voxels: all of the file".to_owned(),
        _ => format!("Voxels: {}", data::subsampling(thinning).name.to_lowercase()),
    }
}

/// Command that treats the volume as a kind of data; `None` is the automatic choice.
pub(crate) fn treat_as(kind: Option<KindName>) -> String {
    format!("Treat as: {}", data::kind_choice(kind).name)
}

/// Command that looks from a standard view.
pub(crate) fn look_from(view: &str) -> String {
    format!("Look: {view}")
}

/// Command that turns the object so that an axis points up.
pub(crate) fn upright(axis: &str) -> String {
    format!("Stand up: {axis} up")
}

/// Command that applies a light rig.
pub(crate) fn use_rig(rig: &str) -> String {
    format!("Lights: {rig}")
}

/// Command that shows the volume in a render mode.
pub(crate) fn use_render_mode(mode: &str) -> String {
    format!("Render mode: {mode}")
}

/// Command that applies a preset of the transfer function.
pub(crate) fn use_preset(title: &str) -> String {
    format!("Preset: {title}")
}

/// Command that applies a colour map, possibly reversed.
pub(crate) fn use_colors(map: &str, reversed: bool) -> String {
    format!("Colours: {map}{}", if reversed { ", reversed" } else { "" })
}

/// Command that saves a view under a digit.
pub(crate) fn store_view(slot: u8) -> String {
    format!("Save view as {slot}")
}

/// Command that goes to the view saved under a digit.
pub(crate) fn recall_view(slot: u8) -> String {
    format!("Go to saved {slot}")
}

/// Shortcut that saves a view under a digit.
pub(crate) fn store_view_keys(slot: u8) -> String {
    format!("Ctrl+Shift+{slot}")
}

/// Shortcut that goes to the view saved under a digit.
pub(crate) fn recall_view_keys(slot: u8) -> String {
    format!("Ctrl+{slot}")
}
