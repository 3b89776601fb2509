//! Window "Slices": three orthogonal cuts through the volume along its axes, through a cursor shared with the
//! picture.

mod cut;
pub(in crate::app::windows) mod image;
pub(crate) mod plane;

use std::sync::Arc;

use eframe::egui::{self, DragValue, Painter, Stroke, Ui};
use glam::DVec3;

use self::cut::{Cut, Shape};
use self::image::Grey;
use self::plane::{Convention, SlicePlane};
use crate::app::common::dock::Tool;
use crate::app::common::theme;
use crate::app::common::volume_facts::{VolumeFacts, decimals};
use crate::app::text;
use crate::app::viewport::view_projection::ViewProjection;
use crate::data::{ValueRange, Volume};
use crate::math::SceneSpace;
use crate::model::{LabelTable, TransferFunction};

/// Longest edge of a slice on screen, in points, before the user resizes the window.
const EDGE: f32 = 208.0;
/// Smallest edge of a slice, in points, at which something is visible.
const LEAST_EDGE: f32 = 96.0;
/// Largest edge of a slice, in points: two of them fill a large screen.
const MOST_EDGE: f32 = 900.0;

/// Quantiles of all voxels that are shown black and white, unless the file or the user sets the window.
const CLIPPED: [f64; 2] = [0.005, 0.995];

/// Narrowest grey window, as a share of the value range: a slice of two tones.
const LEAST_WINDOW: f64 = 1e-3;

/// Part of the look that slices share with the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SliceLook<'a> {
    /// Transfer function of the settings as they are drawn.
    pub transfer: &'a TransferFunction,
    /// Names and looks of labels.
    pub labels: &'a LabelTable,
}

/// State of the window "Slices".
#[derive(Default)]
pub(crate) struct Slices {
    /// True while the window is open.
    pub open: bool,
    /// Side of the screen on which a body's right is shown.
    pub convention: Convention,
    /// Index of the voxel through which all cuts go.
    cursor: [usize; 3],
    /// Content id of the volume of the cursor, and its grey window.
    of: Option<(u64, Grey)>,
    /// True to show the colours of the transfer function, blended by its opacity.
    colored: bool,
    /// Fraction of a slice that the wheel has turned: it reports many small steps.
    turned: f64,
    /// Cuts seen from above, from the front and from the side.
    cuts: [Cut; 3],
    /// Longest edge of a slice on screen, in points.
    edge: f32,
}

impl std::fmt::Debug for Slices {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Slices")
            .field("open", &self.open)
            .field("cursor", &self.cursor)
            .finish_non_exhaustive()
    }
}

impl Slices {
    /// Moves the cursor to the voxel nearest to a point of index space.
    pub(crate) fn point_at(&mut self, index: DVec3, dims: [usize; 3]) {
        for axis in 0..3 {
            self.cursor[axis] = (index[axis].round().max(0.0) as usize).min(dims[axis] - 1);
        }
    }

    /// Shows the window if it is open.
    pub(crate) fn ui(
        &mut self,
        ctx: &egui::Context,
        volume: Option<&Arc<Volume>>,
        facts: Option<&VolumeFacts>,
        look: SliceLook<'_>,
    ) {
        let (Some(volume), Some(facts), true) = (volume, facts, self.open) else { return };
        let mut grey = match self.of {
            Some((of, grey)) if of == volume.content_id() => grey,
            _ => {
                self.cursor = volume.dims().map(|n| n / 2);
                first_grey(volume, facts)
            }
        };
        let mut open = true;
        let tool =
            Tool { title: text::slices::TITLE, default_pos: [24.0, 60.0], default_width: 2.0 * EDGE + 8.0 };
        tool.show(ctx, &mut open, |ui| {
            // Two slices side by side.
            self.edge = ((ui.available_width() - 8.0) / 2.0).clamp(LEAST_EDGE, MOST_EDGE);
            let [above, front, side] = SlicePlane::all(volume, self.convention);
            ui.horizontal_top(|ui| {
                self.cut(ui, 0, above, volume, &mut grey, look);
                self.cut(ui, 1, front, volume, &mut grey, look);
            });
            ui.horizontal_top(|ui| {
                self.cut(ui, 2, side, volume, &mut grey, look);
                ui.vertical(|ui| self.facts(ui, volume, facts, &mut grey, look));
            });
        });
        self.open = open;
        self.of = Some((volume.content_id(), grey.within(facts.range)));
    }

    /// Shows one of the cuts and handles its mouse gestures.
    fn cut(
        &mut self,
        ui: &mut Ui,
        at: usize,
        plane: SlicePlane,
        volume: &Arc<Volume>,
        grey: &mut Grey,
        look: SliceLook<'_>,
    ) {
        let colors = self.colored.then_some(look.transfer);
        let shape = Shape { plane, edge: self.edge };
        self.cuts[at].show(ui, shape, volume, (&mut self.cursor, &mut self.turned), grey, colors);
    }

    /// Shows position and value at the cursor, and the fields of the grey window.
    fn facts(
        &mut self,
        ui: &mut Ui,
        volume: &Volume,
        facts: &VolumeFacts,
        grey: &mut Grey,
        SliceLook { transfer, labels }: SliceLook<'_>,
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
                line(ui, text::slices::LABEL, &text::slices::label(label.number, &label.name(labels)));
            } else {
                let digits = if facts.levels.is_some() { format!("{value}") } else { format!("{value:.5}") };
                line(ui, text::slices::VALUE, &digits);
            }
            let place = volume.table_range().at(volume.density_of(value));
            line(ui, text::slices::OPACITY, &format!("{:.2}", transfer.opacity_at(place)));
            window_and_level(ui, grey, facts);
        });
        if facts.is_anatomical {
            ui.horizontal_wrapped(|ui| {
                for (convention, words) in [
                    (Convention::Radiological, text::slices::RADIOLOGICAL),
                    (Convention::Neurological, text::slices::NEUROLOGICAL),
                ] {
                    let choice = ui.selectable_value(&mut self.convention, convention, words.name);
                    choice.on_hover_text(words.tip);
                }
            });
        }
        let colored = text::slices::COLORED;
        ui.checkbox(&mut self.colored, colored.name).on_hover_text(colored.tip);
        ui.weak(text::slices::HINT);
    }

    /// Paints the cursor in the 3-D picture: a line along each axis of the grid.
    pub(crate) fn mark(&self, painter: &Painter, view_projection: &ViewProjection, scene: &SceneSpace) {
        if !self.open || self.of.is_none() {
            return;
        }
        let cursor = DVec3::from(self.cursor.map(|at| at as f64));
        for axis in 0..3 {
            let end = |at: f64| {
                let mut index = cursor;
                index[axis] = at;
                view_projection.point(scene.scene_from_index.transform_point3(index))
            };
            if let (Some(a), Some(b)) = (end(-0.5), end(scene.dims[axis] as f64 - 0.5)) {
                painter.line_segment([a, b], Stroke::new(1.0, theme::AXES[axis].gamma_multiply(0.8)));
            }
        }
    }
}

/// Initial grey window: the one that the file suggests, or quantiles of the histogram.
fn first_grey(volume: &Volume, facts: &VolumeFacts) -> Grey {
    let found = volume.hints().window;
    let [black, white] =
        found.unwrap_or_else(|| CLIPPED.map(|share| volume.value_of(facts.histogram.percentile(share))));
    // Integer data get an integer window.
    if facts.levels.is_some() && decimals(facts.range) == 0 {
        Grey { black: black.floor(), white: white.ceil() }
    } else {
        Grey { black, white }
    }
}

/// Fields for level and width of the grey window, a row each, with as many digits as the values need.
fn window_and_level(ui: &mut Ui, grey: &mut Grey, facts: &VolumeFacts) {
    let ValueRange { low, high } = facts.range;
    let span = (high - low).max(f64::MIN_POSITIVE);
    let (mut level, mut width) = (grey.level(), grey.width());
    for (words, value, range) in [
        (text::slices::LEVEL, &mut level, low - span..=high + 3.0 * span),
        (text::slices::WIDTH, &mut width, LEAST_WINDOW * span..=4.0 * span),
    ] {
        let label = ui.weak(words.name);
        let field = DragValue::new(value)
            .speed(span / 500.0)
            .range(range)
            .clamp_existing_to_range(false)
            .max_decimals(decimals(facts.range));
        ui.add(field).labelled_by(label.id).on_hover_text(words.tip);
        ui.end_row();
    }
    if (level, width) != (grey.level(), grey.width()) {
        *grey = Grey::from_level_and_width(level, width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::worker::loader::Reading;
    use crate::data::{Dataset, Samples};

    #[test]
    fn greys_are_those_of_the_values_that_matter() {
        // A ramp with one outlier far beyond it.
        let mut values: Vec<f32> = (0..24 * 24 * 24).map(|at| (at % 1000) as f32).collect();
        values[7] = 1e20;
        let volume = Volume::with_spacing("ramp", [24; 3], DVec3::ONE, Samples::F32(values)).unwrap();
        let dataset = Dataset::new(volume);
        let facts = VolumeFacts::of("ramp".into(), Reading::default(), &dataset);
        let mut slices = Slices { open: true, ..Slices::default() };
        let ctx = egui::Context::default();
        let (transfer, labels) = (TransferFunction::default(), LabelTable::default());
        let look = SliceLook { transfer: &transfer, labels: &labels };
        for _ in 0..2 {
            let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
                slices.ui(ui.ctx(), Some(dataset.volume()), Some(&facts), look);
            });
            output.textures_delta.clear();
        }
        let (_, grey) = slices.of.expect("grey levels");
        assert!(grey.black < 20.0 && (900.0..1100.0).contains(&grey.white), "{grey:?}");
    }
}
