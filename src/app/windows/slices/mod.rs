//! Window "Slices": three orthogonal cuts through the volume along its axes, through a cursor shared with the
//! picture.

mod cut;
pub(crate) mod plane;
pub(crate) mod slice_image;
mod slice_overlay;

use std::sync::Arc;

use eframe::egui::{self, DragValue, Painter, Stroke, Ui};
use glam::DVec3;

use self::cut::{CutGeometry, SliceColors, SliceCut};
use self::plane::{SlicePlane, ViewingConvention};
use self::slice_image::GreyWindow;
use self::slice_overlay::SliceOverlay;
use super::{SceneTool, ToolRequest, ToolScene};
use crate::app::common::dock::ToolWindow;
use crate::app::common::theme;
use crate::app::common::volume_facts::{VolumeFacts, range_decimals};
use crate::app::text;
use crate::app::viewport::view_projection::ViewProjection;
use chiaroscuro_files::sanitised;
use chiaroscuro_scene::{Settings, TransferFunction};
use chiaroscuro_volume::{ValueRange, Volume, math::SceneSpace};

/// Longest edge of a slice on screen, in points, before the user resizes the window.
const DEFAULT_EDGE: f32 = 208.0;
/// Smallest edge of a slice, in points, at which something is visible.
const MIN_EDGE: f32 = 96.0;
/// Largest edge of a slice, in points: two of them fill a large screen.
const MAX_EDGE: f32 = 900.0;

/// Quantiles of all voxels that are shown black and white, unless the file or the user sets the window.
const CLIPPED_QUANTILES: [f64; 2] = [0.005, 0.995];

/// Narrowest grey window, as a share of the value range: a slice of two tones.
const MIN_WINDOW_SHARE: f64 = 1e-3;

/// Part of the look that slices share with the picture.
#[derive(Debug, Clone, Copy)]
struct SliceLook<'a> {
    /// Transfer function of the settings as they are drawn.
    transfer: &'a TransferFunction,
    /// Further layers, if colours are shown.
    further: &'a [SliceOverlay],
    /// Settings of the picture.
    settings: &'a Settings,
}

/// State of the window "Slices".
#[derive(Default)]
pub(crate) struct SlicesWindow {
    /// True while the window is open.
    pub open: bool,
    /// Side of the screen on which a body's right is shown.
    pub convention: ViewingConvention,
    /// Index of the voxel through which all cuts go.
    cursor: [usize; 3],
    /// Content id of the volume of the cursor, and its grey window.
    window_of_volume: Option<(u64, GreyWindow)>,
    /// True to show the colours of the transfer function, blended by its opacity.
    uses_colors: bool,
    /// Fraction of a slice that the wheel has turned: it reports many small steps.
    wheel_fraction: f64,
    /// Cuts seen from above, from the front and from the side.
    cuts: [SliceCut; 3],
    /// Longest edge of a slice on screen, in points.
    slice_edge: f32,
}

impl std::fmt::Debug for SlicesWindow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Slices")
            .field("open", &self.open)
            .field("cursor", &self.cursor)
            .finish_non_exhaustive()
    }
}

impl SceneTool for SlicesWindow {
    fn show(&mut self, ctx: &egui::Context, scene: &ToolScene<'_>) -> Option<ToolRequest> {
        if self.open
            && let (Some(dataset), Some(facts)) = (&scene.dataset, scene.volume)
        {
            let as_drawn = scene.settings.resolved_for(dataset.volume());
            let further = if self.uses_colors {
                SliceOverlay::from_dataset(dataset, scene.settings)
            } else {
                Vec::new()
            };
            let look = SliceLook {
                transfer: &as_drawn.layer().transfer,
                further: &further,
                settings: scene.settings,
            };
            self.show_volume(ctx, dataset.volume(), facts, look);
        }
        None
    }
}

impl SlicesWindow {
    /// Moves the cursor to the voxel nearest to a point of index space.
    pub(crate) fn move_cursor_to(&mut self, index: DVec3, dims: [usize; 3]) {
        for axis in 0..3 {
            self.cursor[axis] = (index[axis].round().max(0.0) as usize).min(dims[axis] - 1);
        }
    }

    /// Shows the window of a volume.
    fn show_volume(
        &mut self,
        ctx: &egui::Context,
        volume: &Arc<Volume>,
        facts: &VolumeFacts,
        look: SliceLook<'_>,
    ) {
        let mut grey = match self.window_of_volume {
            Some((of, grey)) if of == volume.content_id() => grey,
            _ => {
                self.cursor = volume.dims().map(|n| n / 2);
                initial_grey_window(volume, facts)
            }
        };
        let mut open = true;
        let tool = ToolWindow {
            title: text::slices::TITLE,
            default_pos: [24.0, 60.0],
            default_width: 2.0 * DEFAULT_EDGE + 8.0,
        };
        tool.show(ctx, &mut open, |ui| {
            // Two slices side by side.
            self.slice_edge = ((ui.available_width() - 8.0) / 2.0).clamp(MIN_EDGE, MAX_EDGE);
            let [above, front, side] = SlicePlane::for_volume(volume, self.convention);
            ui.horizontal_top(|ui| {
                self.show_cut(ui, 0, above, volume, &mut grey, look);
                self.show_cut(ui, 1, front, volume, &mut grey, look);
            });
            ui.horizontal_top(|ui| {
                self.show_cut(ui, 2, side, volume, &mut grey, look);
                ui.vertical(|ui| self.show_cursor_facts(ui, volume, facts, &mut grey, look));
            });
        });
        self.open = open;
        self.window_of_volume = Some((volume.content_id(), grey.clamped(facts.range)));
    }

    /// Shows one of the cuts and handles its mouse gestures.
    fn show_cut(
        &mut self,
        ui: &mut Ui,
        at: usize,
        plane: SlicePlane,
        volume: &Arc<Volume>,
        grey: &mut GreyWindow,
        look: SliceLook<'_>,
    ) {
        let SliceLook { transfer, further, .. } = look;
        let colors = self.uses_colors.then_some(SliceColors { transfer, further });
        let shape = CutGeometry { plane, edge: self.slice_edge };
        self.cuts[at].show(ui, shape, volume, (&mut self.cursor, &mut self.wheel_fraction), grey, colors);
    }

    /// Shows position and value at the cursor, and the fields of the grey window.
    fn show_cursor_facts(
        &mut self,
        ui: &mut Ui,
        volume: &Volume,
        facts: &VolumeFacts,
        grey: &mut GreyWindow,
        SliceLook { transfer, settings, .. }: SliceLook<'_>,
    ) {
        let [x, y, z] = self.cursor;
        let value = volume.value(x, y, z);
        let unit = facts.length_unit();
        let world = volume.world_from_index().transform_point3(DVec3::from(self.cursor.map(|at| at as f64)));
        egui::Grid::new("cursor").num_columns(2).spacing([10.0, 3.0]).show(ui, |ui| {
            let line = |ui: &mut Ui, what: &str, found: &str| {
                let name = ui.weak(what);
                ui.label(found);
                ui.end_row();
                name
            };
            line(ui, text::slices::VOXEL, &format!("{x}, {y}, {z}"));
            let [x, y, z] = (world / unit.mm).to_array();
            let name = text::slices::unit(unit.symbol(), facts.is_anatomical);
            let name = line(ui, &name, &format!("{x:.1}, {y:.1}, {z:.1}"));
            if facts.is_anatomical {
                name.on_hover_text(text::slices::RAS_TIP);
            }
            if let Some(label) = facts.label_of(value) {
                line(
                    ui,
                    text::slices::LABEL,
                    &text::slices::label(label.number, &label.name(&settings.layer().labels)),
                );
            } else {
                let digits = if facts.levels.is_some() { format!("{value}") } else { format!("{value:.5}") };
                line(ui, text::slices::VALUE, &digits);
            }
            let place = volume.table_range().value_at(volume.density_of(value));
            line(ui, text::slices::OPACITY, &format!("{:.2}", transfer.opacity_at(place)));
            let count = settings.layers.count().min(facts.further.len() + 1);
            for layer in (1..count).map(|index| facts.of_layer(index)) {
                if let Some(value) = layer.value_at(settings, self.cursor) {
                    line(ui, &sanitised(&layer.part_name(), 24), &value.words);
                }
            }
            grey_window_fields(ui, grey, facts);
        });
        if facts.is_anatomical {
            ui.horizontal_wrapped(|ui| {
                for (convention, words) in [
                    (ViewingConvention::Radiological, text::slices::RADIOLOGICAL),
                    (ViewingConvention::Neurological, text::slices::NEUROLOGICAL),
                ] {
                    let choice = ui.selectable_value(&mut self.convention, convention, words.name);
                    choice.on_hover_text(words.tooltip);
                }
            });
        }
        let colored = text::slices::COLORED;
        ui.checkbox(&mut self.uses_colors, colored.name).on_hover_text(colored.tooltip);
        ui.weak(text::slices::HINT);
    }

    /// Paints the cursor in the 3-D picture: a line along each axis of the grid.
    pub(crate) fn paint_cursor(
        &self,
        painter: &Painter,
        view_projection: &ViewProjection,
        scene: &SceneSpace,
    ) {
        if !self.open || self.window_of_volume.is_none() {
            return;
        }
        let cursor = DVec3::from(self.cursor.map(|at| at as f64));
        for axis in 0..3 {
            let end = |at: f64| {
                let mut index = cursor;
                index[axis] = at;
                view_projection.project(scene.scene_from_index.transform_point3(index))
            };
            if let (Some(a), Some(b)) = (end(-0.5), end(scene.dims[axis] as f64 - 0.5)) {
                painter.line_segment([a, b], Stroke::new(1.0, theme::AXES[axis].gamma_multiply(0.8)));
            }
        }
    }
}

/// Initial grey window: the one that the file suggests, or quantiles of the histogram.
fn initial_grey_window(volume: &Volume, facts: &VolumeFacts) -> GreyWindow {
    let found = volume.metadata().window;
    let [black, white] = found
        .unwrap_or_else(|| CLIPPED_QUANTILES.map(|share| volume.value_of(facts.histogram.percentile(share))));
    // Integer data get an integer window.
    if facts.levels.is_some() && range_decimals(facts.range) == 0 {
        GreyWindow { black: black.floor(), white: white.ceil() }
    } else {
        GreyWindow { black, white }
    }
}

/// Fields for level and width of the grey window, a row each, with as many digits as the values need.
fn grey_window_fields(ui: &mut Ui, grey: &mut GreyWindow, facts: &VolumeFacts) {
    let ValueRange { low, high } = facts.range;
    let span = (high - low).max(f64::MIN_POSITIVE);
    let (mut level, mut width) = (grey.level(), grey.width());
    for (words, value, range) in [
        (text::slices::LEVEL, &mut level, low - span..=high + 3.0 * span),
        (text::slices::WIDTH, &mut width, MIN_WINDOW_SHARE * span..=4.0 * span),
    ] {
        let label = ui.weak(words.name);
        let field = DragValue::new(value)
            .speed(span / 500.0)
            .range(range)
            .clamp_existing_to_range(false)
            .max_decimals(range_decimals(facts.range));
        ui.add(field).labelled_by(label.id).on_hover_text(words.tooltip);
        ui.end_row();
    }
    if (level, width) != (grey.level(), grey.width()) {
        *grey = GreyWindow::from_level_and_width(level, width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::worker::loader::ReadChoices;
    use chiaroscuro_volume::{Dataset, Samples};

    #[test]
    fn greys_are_those_of_the_values_that_matter() {
        // A ramp with one outlier far beyond it.
        let mut values: Vec<f32> = (0..24 * 24 * 24).map(|at| (at % 1000) as f32).collect();
        values[7] = 1e20;
        let volume = Volume::with_spacing("ramp", [24; 3], DVec3::ONE, Samples::F32(values)).unwrap();
        let dataset = Dataset::new(volume);
        let facts = VolumeFacts::new("ramp".into(), ReadChoices::default(), &dataset);
        let mut slices = SlicesWindow { open: true, ..SlicesWindow::default() };
        let ctx = egui::Context::default();
        let settings = Settings::default();
        let look = SliceLook { transfer: &settings.layer().transfer, further: &[], settings: &settings };
        for _ in 0..2 {
            let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
                slices.show_volume(ui.ctx(), dataset.volume(), &facts, look);
            });
            output.textures_delta.clear();
        }
        let (_, grey) = slices.window_of_volume.expect("grey levels");
        assert!(grey.black < 20.0 && (900.0..1100.0).contains(&grey.white), "{grey:?}");
    }
}
