//! Preview of the raw import dialog: the middle slices of the file with the current numbers, updated while they
//! change.

use std::io;

use eframe::egui::{
    self, Color32, ColorImage, Rect, Role, Sense, TextureHandle, TextureOptions, Ui, Vec2, WidgetInfo, pos2,
    vec2,
};

use super::analysis::RawAnalysis;
use crate::app::text;
use crate::app::worker::jobs::{JobControl, JobKind, JobSlot};
use chiaroscuro_volume_io::{
    RawLayout,
    raw::{MiddleSlices, PreviewSlice, read_middle_slices},
};

/// Longest edge of a slice, in points.
const SLICE_EDGE: f32 = 184.0;

/// Colour of voxels that lie beyond the end of the file.
const MISSING_COLOR: Color32 = Color32::from_rgb(0x70, 0x2c, 0x28);

/// Slice on screen, as a texture.
struct RawSliceTexture {
    texture: TextureHandle,
    /// Size of the whole slice, in voxels.
    size: Vec2,
}

/// State of the preview between frames.
#[derive(Default)]
pub(super) struct RawPreview {
    /// Slices of a layout that are being read.
    task: JobSlot<io::Result<Option<MiddleSlices>>, RawLayout>,
    /// Layout of the shown slices, and their textures.
    shown_slices: Option<(RawLayout, [RawSliceTexture; 3])>,
    failure: Option<String>,
}

impl std::fmt::Debug for RawPreview {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Pictures").field("failure", &self.failure).finish_non_exhaustive()
    }
}

/// Returns true if two layouts show the same bytes; spacing only stretches them.
fn has_same_voxels(a: &RawLayout, b: &RawLayout) -> bool {
    RawLayout { spacing_mm: None, ..*a } == RawLayout { spacing_mm: None, ..*b }
}

impl RawPreview {
    /// Shows the slices of a layout, or the previous ones until they are read.
    pub(super) fn ui(&mut self, ui: &mut Ui, looking: &RawAnalysis, layout: &RawLayout) {
        self.collect(ui.ctx());
        self.request(ui.ctx(), looking, layout);
        egui::Grid::new("raw slices").num_columns(2).spacing([8.0, 8.0]).show(ui, |ui| {
            self.slice(ui, 0, layout);
            self.slice(ui, 1, layout);
            ui.end_row();
            self.slice(ui, 2, layout);
            ui.vertical(|ui| {
                ui.set_max_width(SLICE_EDGE);
                match &self.failure {
                    Some(why) => ui.colored_label(ui.visuals().error_fg_color, why),
                    None => ui.weak(text::raw::READING_SLICES),
                };
            });
            ui.end_row();
        });
    }

    fn slice(&self, ui: &mut Ui, slice_index: usize, layout: &RawLayout) {
        ui.vertical(|ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            ui.weak(text::raw::SLICES[slice_index]);
            let (frame, response) = ui.allocate_exact_size(Vec2::splat(SLICE_EDGE), Sense::hover());
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, text::raw::SLICES[slice_index]));
            let painter = ui.painter_at(frame);
            painter.rect_filled(frame, 2.0, Color32::BLACK);
            if let Some((shown, pictures)) = &self.shown_slices {
                let (u, v) = [(0, 1), (0, 2), (1, 2)][slice_index];
                let spacing =
                    if has_same_voxels(shown, layout) { layout.spacing_mm } else { shown.spacing_mm };
                let spacing = spacing.unwrap_or([1.0; 3]);
                let stretch = vec2(spacing[u] as f32, spacing[v] as f32);
                let size = pictures[slice_index].size * stretch;
                let size = (size * (SLICE_EDGE / size.max_elem())).max(Vec2::splat(1.0));
                let area = Rect::from_center_size(frame.center(), size);
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(pictures[slice_index].texture.id(), area, whole, Color32::WHITE);
            }
        });
    }

    /// Takes slices that have been read.
    fn collect(&mut self, ctx: &egui::Context) {
        let Some((layout, result)) = self.task.take_ended() else { return };
        match result {
            Ok(Ok(Some(found))) => {
                self.failure = None;
                let picture = |which: usize| {
                    let (u, v) = [(0, 1), (0, 2), (1, 2)][which];
                    let texture =
                        ctx.load_texture("raw slice", render_slice(&found, which), TextureOptions::LINEAR);
                    RawSliceTexture { texture, size: vec2(layout.dims[u] as f32, layout.dims[v] as f32) }
                };
                self.shown_slices = Some((layout, [picture(0), picture(1), picture(2)]));
            }
            // The numbers have changed meanwhile.
            Ok(Ok(None)) => {}
            Ok(Err(error)) => self.failure = Some(text::raw::not_read(&error)),
            Err(panic) => self.failure = Some(panic),
        }
    }

    /// Starts to read slices that are not shown yet; a read for other numbers is cancelled.
    fn request(&mut self, ctx: &egui::Context, looking: &RawAnalysis, layout: &RawLayout) {
        if self.shown_slices.as_ref().is_some_and(|(shown, _)| has_same_voxels(shown, layout)) {
            self.task.discard();
            return;
        }
        // A read that failed is not retried.
        if self.failure.is_some()
            || self.task.inputs().is_some_and(|reading| has_same_voxels(reading, layout))
        {
            return;
        }
        let (bytes, layout) = (looking.bytes().clone(), *layout);
        let read =
            move |job: &JobControl| bytes.with_bytes(|bytes| read_middle_slices(bytes, &layout, job.token()));
        if let Err(error) = self.task.start(JobKind::RawSlices, ctx, layout, read) {
            self.failure = Some(text::raw::not_read(&error));
        }
    }
}

/// Renders a slice in greys, its second axis upwards.
fn render_slice(found: &MiddleSlices, which: usize) -> ColorImage {
    let PreviewSlice { size: [width, height], values } = &found.slices[which];
    let (low, span) = (found.range.low as f32, found.range.span().max(f64::MIN_POSITIVE) as f32);
    let color = |value: &Option<f32>| match value {
        Some(value) => Color32::from_gray((((value - low) / span).clamp(0.0, 1.0) * 255.0).round() as u8),
        None => MISSING_COLOR,
    };
    let rows = values.chunks(*width).rev().take(*height);
    ColorImage::new([*width, *height], rows.flatten().map(color).collect())
}
