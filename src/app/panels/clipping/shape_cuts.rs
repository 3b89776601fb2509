//! Cuts by shapes in the section "Clipping": buttons that begin one, and the list of those that there are.

use eframe::egui::Ui;

use super::super::controls::{row, unlabelled_row};
use crate::app::common::commands::AppCommand;
use crate::app::text::{self, ControlText};
use chiaroscuro_scene::{CutAction, CutDepth, CutShape, CutShapeKind, MAX_SHAPE_CUTS, OutlineCut, ShapeCut};

/// Shows the buttons, and a row for each cut in the order in which they are applied.
pub(super) fn show(ui: &mut Ui, cuts: &mut Vec<ShapeCut>, commands: &mut Vec<AppCommand>) {
    row(ui, text::cuts::BY_SHAPE, |ui| {
        ui.add_enabled_ui(cuts.len() < MAX_SHAPE_CUTS, |ui| {
            for kind in CutShapeKind::ALL {
                let tip = text::cuts::cut_by_shape(kind).tooltip;
                if ui.button(text::cuts::shape_name(kind)).on_hover_text(tip).clicked() {
                    commands.push(AppCommand::CutByShape(kind));
                }
            }
        });
    });
    let mut removed = None;
    for (at, cut) in cuts.iter_mut().enumerate() {
        ui.push_id(("shape-cut", at), |ui| {
            if cut_row(ui, cut) {
                removed = Some(at);
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

/// Shows one cut: its switch, its effect, and a button that removes it. Returns true if that was clicked.
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
