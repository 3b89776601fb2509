//! Rows of the section "Data" that say which values the picture shows, and choose them.

use eframe::egui::{self, Ui};

use super::super::text::{self, Named};
use super::controls::{choice, row, short, unlabelled};
use crate::app::common::volume_facts::VolumeFacts;
use crate::data::ValueRange;
use crate::model::{DensityRange, Settings};

/// Shares of the span by which a pixel of a drag moves an end.
const SPEED: f64 = 1.0 / 500.0;

/// Shows them.
pub(super) fn show(ui: &mut Ui, settings: &mut Settings, volume: &VolumeFacts) {
    let typed = match settings.range {
        DensityRange::Typed(range) => range,
        DensityRange::Robust | DensityRange::Full => settings.range.of(&volume.ranges),
    };
    let options = [
        (DensityRange::Robust, text::data::ROBUST),
        (DensityRange::Full, text::data::FULL),
        (DensityRange::Typed(typed), text::data::TYPED),
    ];
    choice(ui, text::data::RANGE, &mut settings.range, &options);
    if let DensityRange::Typed(range) = &mut settings.range {
        unlabelled(ui, |ui| ends(ui, range, volume));
    }
    let ValueRange { low, high } = settings.shown_range(&volume.ranges);
    let all = volume.ranges.all;
    let shown = text::data::shown(&[low, high].map(short), &[all.low, all.high].map(short));
    row(ui, Named { name: text::data::SHOWN, tip: "" }, |ui| ui.add(egui::Label::new(shown).truncate()));
}

/// The two ends of a typed range, which stay apart.
fn ends(ui: &mut Ui, range: &mut ValueRange, volume: &VolumeFacts) {
    let speed = volume.ranges.robust.span().max(range.span()).max(f64::MIN_POSITIVE) * SPEED;
    for (end, named) in [(&mut range.low, text::data::LOW), (&mut range.high, text::data::HIGH)] {
        let field = egui::DragValue::new(end).speed(speed).max_decimals(6);
        ui.name_inputs(named.name, |ui| ui.add(field)).on_hover_text(named.tip);
    }
}
