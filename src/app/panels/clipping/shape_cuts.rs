//! Cuts by shapes in the section "Clipping": buttons that begin one, and the list of those that there are.

use std::ops::RangeInclusive;

use eframe::egui::{DragValue, Ui};

use super::super::controls::{NumberRow, SceneUnit, row, unlabelled_row};
use super::cut_effect_row;
use crate::app::common::commands::AppCommand;
use crate::app::common::volume_facts::VolumeFacts;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::{
    BoxCut, CutAction, CutDepth, CutShape, CutShapeKind, MAX_SHAPE_CUTS, MIN_CROP_EXTENT, OutlineCut,
    ShapeCut,
};

/// Number of buttons that fit beside a label, with wide letters, too.
const BUTTONS_IN_ROW: usize = 2;

/// Shows the buttons, and a row for each cut in the order in which they are applied.
pub(super) fn show(
    ui: &mut Ui,
    cuts: &mut Vec<ShapeCut>,
    (volume, unit): (&VolumeFacts, SceneUnit),
    commands: &mut Vec<AppCommand>,
) {
    let mut buttons = |ui: &mut Ui, kinds: &[CutShapeKind]| {
        ui.add_enabled_ui(cuts.len() < MAX_SHAPE_CUTS, |ui| {
            for &kind in kinds {
                let tip = text::cuts::cut_by_shape(kind).tooltip;
                if ui.button(text::cuts::shape_name(kind)).on_hover_text(tip).clicked() {
                    commands.push(AppCommand::CutByShape(kind));
                }
            }
        });
    };
    for (line, kinds) in CutShapeKind::ALL.chunks(BUTTONS_IN_ROW).enumerate() {
        if line == 0 {
            row(ui, text::cuts::BY_SHAPE, |ui| buttons(ui, kinds));
        } else {
            unlabelled_row(ui, |ui| buttons(ui, kinds));
        }
    }
    let mut removed = None;
    for (at, cut) in cuts.iter_mut().enumerate() {
        ui.push_id(("shape-cut", at), |ui| {
            if cut_row(ui, cut) {
                removed = Some(at);
            }
            match cut.action {
                CutAction::Hide => cut_effect_row(ui, text::cuts::INSIDE_SHAPE, &mut cut.effect),
                CutAction::Keep => cut_effect_row(ui, text::cuts::OUTSIDE_SHAPE, &mut cut.effect),
                CutAction::Restore => {}
            }
            match &mut cut.shape {
                CutShape::Box(bounds) => corner_rows(ui, bounds, volume.dims),
                CutShape::HalfSpace(plane) => {
                    let reach = volume.scene.support_radius();
                    let offset = NumberRow::new(text::cuts::HALF_OFFSET, -reach..=reach);
                    offset.show_length(ui, &mut plane.offset, 0.0, unit);
                }
                CutShape::Outline(_) | CutShape::Sphere(_) | CutShape::Component(_) => {}
            }
        });
    }
    if let Some(at) = removed {
        cuts.remove(at);
    }
    if cuts.len() > 1 {
        unlabelled_row(ui, |ui| {
            let named = text::cuts::REMOVE_SHAPES;
            if ui.button(named.name).on_hover_text(named.tooltip).clicked() {
                cuts.clear();
            }
        });
    }
}

/// Shows one cut: its switch, its action, and a button that removes it. Returns true if that was clicked.
fn cut_row(ui: &mut Ui, cut: &mut ShapeCut) -> bool {
    let name = text::cuts::shape_name(cut.shape.kind());
    row(ui, ControlText { name, tooltip: text::cuts::SHAPE_TIP }, |ui| {
        let switch = ui.name_inputs(name, |ui| ui.checkbox(&mut cut.on, ""));
        switch.on_hover_text(text::cuts::SHAPE_TIP);
        if ui.button(text::cuts::action_name(cut.action)).on_hover_text(text::cuts::ACTION_TIP).clicked() {
            let at = CutAction::ALL.iter().position(|action| *action == cut.action).unwrap_or_default();
            cut.action = CutAction::ALL[(at + 1) % CutAction::ALL.len()];
        }
        if let CutShape::Outline(OutlineCut { depth, surface: Some(_), .. }) = &mut cut.shape {
            let (words, other) = match *depth {
                CutDepth::Through => (text::cuts::THROUGH, CutDepth::Front),
                CutDepth::Front => (text::cuts::FRONT, CutDepth::Through),
            };
            if ui.button(words).on_hover_text(text::cuts::DEPTH_TIP).clicked() {
                *depth = other;
            }
        }
        let removes = text::cuts::REMOVE_SHAPE;
        ui.button(removes.name).on_hover_text(removes.tooltip).clicked()
    })
}

/// Shows the extent of a box along each axis, in voxels.
fn corner_rows(ui: &mut Ui, bounds: &mut BoxCut, dims: [usize; 3]) {
    for (axis, name) in text::cuts::AXES.into_iter().enumerate() {
        let voxels = dims[axis] as f64;
        row(ui, ControlText { name, tooltip: text::cuts::CORNER_EXTENT_TIP }, |ui| {
            let [mut from, mut to] = [bounds.low[axis], bounds.high[axis]].map(|share| share * voxels);
            let min_extent = MIN_CROP_EXTENT * voxels;
            let first = corner_field(&mut from, 0.0..=to - min_extent, voxels);
            if ui.name_inputs(text::cuts::corner_from(name), |ui| ui.add(first)).changed() {
                bounds.low[axis] = from / voxels;
            }
            ui.label(text::cuts::RANGE_SEPARATOR);
            let last = corner_field(&mut to, from + min_extent..=voxels, voxels);
            if ui.name_inputs(text::cuts::corner_to(name), |ui| ui.add(last)).changed() {
                bounds.high[axis] = to / voxels;
            }
        });
    }
}

/// Field for a bound of a box in voxels; dragging over 300 points covers an axis of so many.
fn corner_field(bound: &mut f64, range: RangeInclusive<f64>, voxels: f64) -> DragValue<'_> {
    DragValue::new(bound).range(range).speed(voxels / 300.0).max_decimals(0)
}
