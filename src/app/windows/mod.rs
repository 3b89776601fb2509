//! Windows over the main window: export, files, slices, contact sheet, help; and the trait of tools that read the
//! scene.

pub(super) mod contact_sheet;
pub(super) mod device_loss;
pub(super) mod export;
pub(super) mod file_dialogs;
pub(super) mod help;
pub(super) mod large_volume;
pub(super) mod light_slice;
pub(super) mod palette;
pub(super) mod quit_dialog;
pub(super) mod raw_dialog;
pub(super) mod recovery;
pub(super) mod slices;
pub(super) mod untrusted_path;
pub(super) mod volume_chooser;

use eframe::egui;

use self::file_dialogs::FileDialogPurpose;
use super::common::volume_facts::VolumeFacts;
use chiaroscuro_render::GpuContext;
use chiaroscuro_scene::Settings;
use chiaroscuro_volume::Dataset;

/// Facts about the scene that the tools read.
pub(crate) struct ToolScene<'a> {
    /// Settings of the current look.
    pub settings: &'a Settings,
    /// Facts about the open volume, if there is one.
    pub volume: Option<&'a VolumeFacts>,
    /// Volume that is shown, if there is one.
    pub dataset: Option<Dataset>,
    /// Device that renders the pictures; workers open a sibling of it.
    pub context: &'a GpuContext,
    /// Size in physical pixels of a picture that fills its area.
    pub picture_size: [u32; 2],
    /// True when the scene is idle, so that a light volume filled now will be used.
    pub is_idle: bool,
    /// Number of time steps of which the open volume is one; 0 if it is alone.
    pub step_count: u32,
}

/// Request of a tool to the window.
#[derive(Debug)]
pub(crate) enum ToolRequest {
    /// Ask the user for a file.
    AskFile(FileDialogPurpose),
    /// Render the picture and write it, as the export window says.
    Export,
    /// Report an error: headline and details.
    Report(&'static str, String),
}

/// Tool that reads the scene, in a window over the picture or docked beside it.
pub(crate) trait SceneTool {
    /// Shows the tool if it is open, and returns the request of the user or an error, if any.
    fn show(&mut self, ctx: &egui::Context, scene: &ToolScene<'_>) -> Option<ToolRequest>;
}
