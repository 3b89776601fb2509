//! State of the window that only its tests inspect, with the feature `testing`.

use std::path::Path;

use eframe::egui;

use super::App;

impl App {
    /// Rectangle of the picture in points, and its size in physical pixels.
    pub fn viewport_rect(&self) -> Option<(egui::Rect, [u32; 2])> {
        self.picture.canvas.map(|canvas| (canvas.rect, canvas.size))
    }

    /// Positions of the handles of the enabled lights, in points.
    pub fn light_handle_positions(&self) -> &[egui::Pos2] {
        self.picture.handles.positions()
    }

    /// Number of previews of this volume that were followed by a full-quality picture.
    pub fn full_quality_pictures(&self) -> u64 {
        self.viewport.refinement_count()
    }

    /// Name of the open volume, or `None` if there is none.
    pub fn volume_name(&self) -> Option<&str> {
        self.document.volume.as_ref().map(|volume| volume.name.as_str())
    }

    /// Error messages since the volume was opened.
    pub fn errors(&self) -> &[String] {
        self.messages.errors()
    }

    /// Latest note in the status bar since the volume was opened, even if it has disappeared.
    pub fn latest_note(&self) -> Option<&str> {
        self.messages.latest_note()
    }

    /// Returns true while a note lies over the picture; notes disappear after some seconds.
    pub fn shows_note(&self) -> bool {
        self.messages.shows_note()
    }

    /// Exports the picture as the export window does, replacing an existing file.
    pub fn export(&mut self, path: &Path, size: [u32; 2], ctx: &egui::Context) {
        self.windows.export.set_size(size);
        self.windows.export.allow_replacing(path);
        self.start_export(ctx);
    }

    /// Returns true while an export is being rendered or written.
    pub fn is_exporting(&self) -> bool {
        self.windows.export.is_busy()
    }
}
