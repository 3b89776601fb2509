//! Menu of transfer function presets: a thumbnail of each, by domain. Presets for another kind of data are dimmed,
//! and those in use are framed.

use eframe::egui::{
    self, Align2, Color32, Rect, Response, Role, ScrollArea, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};

use super::super::text;
use super::preset_thumbnails::PresetThumbnails;
use crate::app::common::commands::AppCommand;
use crate::app::common::preset_match::PresetMatchCache;
use crate::app::common::theme;
use crate::app::common::volume_facts::VolumeFacts;
use chiaroscuro_scene::{PRESETS, Preset, Settings};

/// Size of a thumbnail in points: half of its pixels.
const THUMBNAIL_SIZE: Vec2 = vec2(88.0, 58.0);
/// Margin around a thumbnail, in points.
const THUMBNAIL_MARGIN: f32 = 4.0;
/// Height of the title below a thumbnail, in points.
const TITLE_HEIGHT: f32 = 17.0;
/// Number of thumbnails side by side: the largest domain, of seven, takes two rows.
const COLUMNS: f32 = 4.0;
/// Height above the menu's button that the list leaves free, in points: the command at its top, and the menu bar.
const SPACE_ABOVE: f32 = 90.0;
/// Smallest height of the list, in points, at which two rows are visible.
const MIN_LIST_HEIGHT: f32 = 200.0;
/// Opacity of the thumbnails of presets for another kind of data, 0 to 255.
const DIMMED_OPACITY: u8 = 90;

/// State of the preset menu between frames.
#[derive(Debug, Default)]
pub(super) struct PresetMenu {
    pictures: PresetThumbnails,
    in_use: PresetMatchCache,
}

impl PresetMenu {
    /// Shows the button of the menu, and the menu while it is open.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        settings: &Settings,
        volume: &VolumeFacts,
        commands: &mut Vec<AppCommand>,
    ) {
        // The menu opens upwards, because the plot is below.
        let height = (ui.cursor().top() - SPACE_ABOVE).max(MIN_LIST_HEIGHT);
        ui.menu_button(text::transfer::PRESETS, |ui| {
            let all =
                ui.button(&*AppCommand::TryPresets.label()).on_hover_text(text::transfer::TRY_PRESETS_TIP);
            if all.clicked() {
                commands.push(AppCommand::TryPresets);
            }
            ui.separator();
            // A preset has one layer, which is for the first field.
            let selected_first = settings.clone().with_first_exchanged(volume.layer);
            self.in_use.update(ui, &selected_first, &volume.ranges);
            let list = ScrollArea::vertical().id_salt("presets").max_height(height);
            list.min_scrolled_height(height).show(ui, |ui| {
                ui.spacing_mut().item_spacing = Vec2::splat(2.0);
                ui.set_width(COLUMNS * (THUMBNAIL_SIZE.x + 2.0 * THUMBNAIL_MARGIN + 2.0));
                // Those of the benchmarks and of scenes are for one volume each.
                let listed: Vec<Preset> = PRESETS.into_iter().filter(Preset::is_offered).collect();
                for domain in listed.chunk_by(|a, b| a.domain() == b.domain()) {
                    ui.add_space(6.0);
                    ui.weak(domain.first().map_or("", Preset::domain_title));
                    ui.horizontal_wrapped(|ui| {
                        for preset in domain {
                            if self.preset_card(ui, preset, preset.suits_data(&volume.kind)).clicked() {
                                commands.push(AppCommand::UsePreset(*preset));
                            }
                        }
                    });
                }
            });
        });
    }

    /// Shows a preset: its thumbnail, and its title below.
    fn preset_card(&mut self, ui: &mut Ui, preset: &Preset, suits: bool) -> Response {
        let size = THUMBNAIL_SIZE + vec2(2.0 * THUMBNAIL_MARGIN, 2.0 * THUMBNAIL_MARGIN + TITLE_HEIGHT);
        let (area, response) = ui.allocate_exact_size(size, Sense::click());
        let is_used = self.in_use.is_in_use(preset);
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_used, preset.title));
        let visuals = ui.style().interact_selectable(&response, is_used);
        let painter = ui.painter();
        if response.hovered() || response.has_focus() {
            painter.rect_filled(area, 4.0, visuals.weak_bg_fill);
        }
        let picture = Rect::from_min_size(area.min + Vec2::splat(THUMBNAIL_MARGIN), THUMBNAIL_SIZE);
        match self.pictures.get(ui.ctx(), preset) {
            Some(texture) => {
                let tint = if suits { Color32::WHITE } else { Color32::from_white_alpha(DIMMED_OPACITY) };
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(texture.id(), picture, whole, tint);
            }
            None => {
                painter.rect_filled(picture, 0.0, theme::EMPTY_CANVAS);
            }
        }
        let ink = if is_used {
            let frame = Stroke::new(2.0, theme::ACCENT);
            painter.rect_stroke(picture, 2.0, frame, StrokeKind::Outside);
            theme::accent(ui.visuals())
        } else if suits {
            ui.visuals().text_color()
        } else {
            ui.visuals().weak_text_color()
        };
        let font = TextStyle::Small.resolve(ui.style());
        let mut title = egui::text::LayoutJob::simple_singleline(preset.title.to_owned(), font, ink);
        title.wrap = egui::text::TextWrapping::truncate_at_width(THUMBNAIL_SIZE.x + THUMBNAIL_MARGIN);
        let title = painter.layout_job(title);
        let middle = pos2(
            picture.center().x,
            picture.bottom() + THUMBNAIL_MARGIN + 0.5 * (TITLE_HEIGHT - THUMBNAIL_MARGIN),
        );
        let place = Align2::CENTER_CENTER.anchor_size(middle, title.size());
        painter.galley(place.min, title, ink);
        let mut about = preset.description();
        if is_used {
            about = text::transfer::in_use_tooltip(&about);
        }
        if !suits {
            about = text::transfer::other_data_tooltip(&about);
        }
        response.on_hover_text(about)
    }
}
