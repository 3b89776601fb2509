//! Window that chooses one of several volumes of a file: names, sizes and a thumbnail of each.

mod thumbnails;

use std::ops::Range;

use eframe::egui::{self, Align2, Key, Modifiers, Rect, Sense, TextStyle, Ui, Vec2, pos2, vec2};

use self::thumbnails::{ThumbnailState, VolumeThumbnails};
use crate::app::common::alternatives::Alternatives;
use crate::app::common::commands::AppCommand;
use crate::app::common::overlay_windows;
use crate::app::common::shortcuts::is_typing;
use crate::app::common::theme;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text;
use chiaroscuro_volume::{ChoiceAspect, FileDimension, human_bytes};
use chiaroscuro_volume_io::LoadOptions;

/// Longer edge of a thumbnail, in points.
const THUMBNAIL_EDGE: f32 = 48.0;
/// Margin around a thumbnail, in points.
const THUMBNAIL_MARGIN: f32 = 4.0;
/// Height of a row, in points.
const ROW_HEIGHT: f32 = THUMBNAIL_EDGE + 2.0 * THUMBNAIL_MARGIN;
/// Width of the list, in points: names of series take two dozen words at most.
const LIST_WIDTH: f32 = 360.0;
/// Number of rows that are visible at once.
const VISIBLE_ROWS: f32 = 7.0;

/// State of the window, with the thumbnails that it has made.
#[derive(Default)]
pub(crate) struct VolumeChooser {
    open: Option<ChoiceAspect>,
    selected: usize,
    /// True if the list is to scroll to the selected row.
    scrolls_to_selected: bool,
    /// User's choice for each aspect whether the look stays; `None` for the default.
    keeps_look: [Option<bool>; ChoiceAspect::ALL.len()],
    /// Memory of a voxel, in bytes, while resolution levels are listed, which differ in what they take.
    voxel_bytes: Option<u64>,
    previews: VolumeThumbnails,
}

impl std::fmt::Debug for VolumeChooser {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Chooser").field("open", &self.open).finish_non_exhaustive()
    }
}

impl VolumeChooser {
    /// Opens the window for the alternatives in one aspect.
    pub(crate) fn open(&mut self, aspect: ChoiceAspect, alternatives: &Alternatives<'_>) {
        (self.open, self.selected, self.scrolls_to_selected) = (Some(aspect), alternatives.current(), true);
    }

    /// Returns true if the look stays when another volume is chosen in this aspect.
    pub(crate) fn keeps_look(&self, aspect: ChoiceAspect) -> bool {
        self.keeps_look[aspect.index()].unwrap_or_else(|| aspect.keeps_look())
    }

    fn close(&mut self) {
        self.open = None;
        self.previews.stop();
    }

    /// Shows the window, and adds the command for the chosen volume. Must run before other widgets take the arrow
    /// keys.
    pub(crate) fn ui(
        &mut self,
        ctx: &egui::Context,
        volume: Option<&VolumeFacts>,
        options: &LoadOptions,
        commands: &mut Vec<AppCommand>,
    ) {
        let Some(aspect) = self.open else { return };
        let Some(volume) = volume else { return self.close() };
        let Some(all) = Alternatives::new(&volume.held, aspect) else { return self.close() };
        let is_by_level = aspect == ChoiceAspect::Dimension(FileDimension::Level);
        let voxels = volume.dims.iter().product::<usize>().max(1) as u64;
        self.voxel_bytes = is_by_level.then_some(volume.bytes / voxels);
        let (enter, escape) = self.handle_keys(ctx, all.count());
        let mut chosen = enter.then_some(self.selected);
        let mut open = !escape;
        let window = egui::Window::new(text::chooser::title(aspect)).id(egui::Id::unique("chooser"));
        let mut visible = 0..0;
        let window = window.constrain_to(overlay_windows::window_area(ctx)).default_pos([60.0, 60.0]);
        window.open(&mut open).resizable(false).collapsible(false).show(ctx, |ui| {
            ui.set_width(LIST_WIDTH);
            if all.has_colors() {
                ui.label(text::chooser::COLORS_NOTE);
            }
            visible = self.show_list(ui, &all, &mut chosen);
            ui.separator();
            let mut keeps = self.keeps_look(aspect);
            let tick = ui.checkbox(&mut keeps, text::chooser::KEEP_LOOK.name);
            if tick.on_hover_text(text::chooser::KEEP_LOOK.tooltip).changed() {
                self.keeps_look[aspect.index()] = Some(keeps);
            }
            ui.weak(text::chooser::KEYS);
        });
        let wanted: Vec<_> = visible.map(|at| (all.choice(at), all.grid(at))).collect();
        self.previews.set_source(&volume.source, volume.reading.subset.as_ref());
        self.previews.update(&wanted, options, ctx);
        if let Some(at) = chosen {
            self.selected = at;
            commands.push(AppCommand::OpenChoice(Box::new(all.choice(at)), self.keeps_look(aspect)));
        }
        if !open {
            self.close();
        }
    }

    /// Moves the selection by the keyboard; returns whether Enter and Escape were pressed.
    fn handle_keys(&mut self, ctx: &egui::Context, count: usize) -> (bool, bool) {
        let last = count.saturating_sub(1);
        self.selected = self.selected.min(last);
        // A focused button handles Enter itself.
        if is_typing(ctx) || ctx.memory(egui::Memory::focused).is_some() {
            return (false, false);
        }
        let pressed = |key| ctx.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key));
        let (down, up) = (pressed(Key::ArrowDown), pressed(Key::ArrowUp));
        let (home, end) = (pressed(Key::Home), pressed(Key::End));
        let before = self.selected;
        self.selected = (self.selected + down).saturating_sub(up).min(last);
        if home + end > 0 {
            self.selected = if end > 0 { last } else { 0 };
        }
        self.scrolls_to_selected |= self.selected != before;
        (pressed(Key::Enter) > 0, pressed(Key::Escape) > 0)
    }

    /// Shows the list; returns the range of visible rows.
    fn show_list(&mut self, ui: &mut Ui, all: &Alternatives<'_>, chosen: &mut Option<usize>) -> Range<usize> {
        ui.spacing_mut().item_spacing.y = 0.0;
        let height = (all.count() as f32).min(VISIBLE_ROWS) * ROW_HEIGHT;
        let mut area = egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]);
        if std::mem::take(&mut self.scrolls_to_selected) {
            let middle = self.selected as f32 * ROW_HEIGHT - (height - ROW_HEIGHT) / 2.0;
            area = area.vertical_scroll_offset(
                middle.clamp(0.0, (all.count() as f32 * ROW_HEIGHT - height).max(0.0)),
            );
        }
        let mut seen = 0..0;
        area.show_rows(ui, ROW_HEIGHT, all.count(), |ui, rows| {
            seen = rows.clone();
            for at in rows {
                if self.show_row(ui, all, at) {
                    *chosen = Some(at);
                }
            }
        });
        seen
    }

    /// Shows a row; returns true if it was clicked.
    fn show_row(&self, ui: &mut Ui, all: &Alternatives<'_>, at: usize) -> bool {
        let (rect, row) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::click());
        let (name, is_shown) = (all.name(at), at == all.current());
        row.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_shown, &name));
        let visuals = ui.style().interact_selectable(&row, at == self.selected);
        let painter = ui.painter();
        if at == self.selected || row.hovered() {
            painter.rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
        }
        let frame =
            Rect::from_min_size(rect.min + Vec2::splat(THUMBNAIL_MARGIN), Vec2::splat(THUMBNAIL_EDGE));
        painter.rect_filled(frame, 0.0, theme::EMPTY_CANVAS);
        match self.previews.get(&all.choice(at)) {
            ThumbnailState::Ready(picture) => {
                let size = picture.size_vec2();
                let fitted =
                    Rect::from_center_size(frame.center(), size * (THUMBNAIL_EDGE / size.max_elem()));
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(picture.id(), fitted, whole, egui::Color32::WHITE);
            }
            ThumbnailState::Failed => {}
            ThumbnailState::Pending => egui::Spinner::new().paint_at(ui, frame.shrink(THUMBNAIL_EDGE / 3.0)),
        }
        let left = frame.right() + 2.0 * THUMBNAIL_MARGIN;
        let right = if is_shown {
            let is_marked = at == self.selected;
            let color = if is_marked { visuals.text_color() } else { theme::accent(ui.visuals()) };
            let place = pos2(rect.right() - 2.0 * THUMBNAIL_MARGIN, rect.center().y);
            let font = TextStyle::Small.resolve(ui.style());
            painter.text(place, Align2::RIGHT_CENTER, text::chooser::SHOWN_MARK, font, color).left()
        } else {
            rect.right()
        };
        let mut facts = vec![text::chooser::position(at, all.count())];
        let dims = all.dims(at);
        facts.extend(dims.map(text::chooser::size));
        let voxels = dims.map(|dims| dims.iter().fold(1, |product: u64, &n| product.saturating_mul(n)));
        let bytes = voxels.zip(self.voxel_bytes).map(|(voxels, each)| voxels.saturating_mul(each));
        facts.extend(bytes.map(|bytes| human_bytes(bytes.into())));
        let lines = [
            (name.as_str(), TextStyle::Body, visuals.text_color(), Align2::LEFT_BOTTOM),
            (&facts.join(" · "), TextStyle::Small, ui.visuals().weak_text_color(), Align2::LEFT_TOP),
        ];
        for (line, style, color, align) in lines {
            let font = style.resolve(ui.style());
            let mut job = egui::text::LayoutJob::simple_singleline(line.to_owned(), font, color);
            job.wrap = egui::text::TextWrapping::truncate_at_width(right - left - 2.0 * THUMBNAIL_MARGIN);
            let laid = painter.layout_job(job);
            let place = align.anchor_size(pos2(left, rect.center().y), laid.size());
            painter.galley(place.min, laid, color);
        }
        row.on_hover_text(&name).clicked()
    }
}
