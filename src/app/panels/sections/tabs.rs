//! Icon bar above the sections of the side panel: each icon opens its section and scrolls to it.

use eframe::egui::{Role, Sense, Ui, Vec2, WidgetInfo};

use super::icons;
use crate::app::common::reveal;
use crate::app::common::theme;
use crate::app::text;
use crate::app::text::sections::ALL;

/// Height of an icon's button, in points.
const HEIGHT: f32 = 24.0;

/// Shows one icon for each section, with a dot where `is_active`.
pub(crate) fn show(ui: &mut Ui, is_active: impl Fn(&str) -> bool) {
    let size = Vec2::new(ui.available_width() / ALL.len() as f32, HEIGHT);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        for title in ALL {
            let (area, response) = ui.allocate_exact_size(size, Sense::click());
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, text::sections::tab_name(title)));
            reveal::report_area(ui.ctx(), area, || text::sections::tab_name(title));
            let visuals = *ui.style().interact(&response);
            if response.hovered() || response.has_focus() {
                ui.painter().rect(
                    area.shrink(1.0),
                    visuals.corner_radius,
                    visuals.weak_bg_fill,
                    visuals.bg_stroke,
                    eframe::egui::StrokeKind::Inside,
                );
            }
            icons::paint(ui.painter(), title, area.center(), visuals.fg_stroke.color);
            if is_active(title) {
                ui.painter().circle_filled(area.right_top() + Vec2::new(-5.0, 5.0), 2.5, theme::ACCENT);
            }
            if response.on_hover_text(title).clicked() {
                reveal::show_section(ui.ctx(), title, true);
            }
        }
    });
}
