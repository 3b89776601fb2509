//! Button of a recent file with its thumbnail, for the menu and the start screen.

use eframe::egui::{self, Button, Response};

use crate::app::common::elide::elide_middle;
use crate::app::persistence::{RecentFile, RecentThumbnails};
use chiaroscuro_files::sanitised;
use chiaroscuro_scene::MAX_NAME_CHARS;

/// Maximum number of characters of a path in a tooltip: the longest path that systems allow.
const MAX_PATH_CHARS: usize = 4096;

/// Longer edge of a thumbnail, in points: its subject is recognisable, and the list fits on low screens.
const THUMBNAIL_EDGE: f32 = 48.0;

/// Shows the button of a recent file, whose name is at most `name_width` points wide; its tooltip is the path.
pub(super) fn recent_file_button(
    ui: &mut egui::Ui,
    recent: &RecentFile,
    thumbnails: &mut RecentThumbnails,
    name_width: f32,
) -> Response {
    let path = &recent.path;
    let whole = path.to_string_lossy();
    let name = path.file_name().map(|name| name.to_string_lossy());
    let name = sanitised(name.as_ref().unwrap_or(&whole), MAX_NAME_CHARS);
    let name = elide_middle(ui, &name, &egui::TextStyle::Button, name_width);
    let button = match thumbnails.get(path, ui.ctx()) {
        Some(picture) => {
            let size = picture.size_vec2();
            let size = size * (THUMBNAIL_EDGE / size.max_elem());
            Button::image_and_text((picture.id(), size), &name)
        }
        None => Button::new(&name),
    };
    let button = ui.add(button.image_tint_follows_text_color(false));
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
    button.on_hover_text(sanitised(&whole, MAX_PATH_CHARS))
}
